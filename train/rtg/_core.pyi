"""The C++ core of RTG: configuration, tasks, the true dynamics, generation, planning.

Poses are x [m], y [m], θ [rad]; body 0 is the robot.
"""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

METHODS: tuple[str, ...]
"""The names of the methods to compare, see nodes/config/method.hpp."""
SOURCES: tuple[str, ...]
"""The names of the sources of transitions; an index here is a `source` value. See
core/search/transition.hpp."""

class GoalTerm:
    """A condition on a state: the subject lies in the region."""

    @property
    def subject(self) -> str:
        """The quantity that must lie in the region.

        "every": the centre of each body of class `kind` ("*": of each object); "centroid": the mean
        of these centres; "joint": the angle of the joint whose child is named `kind` ("*": of each
        joint).
        """
    @property
    def kind(self) -> str: ...
    @property
    def region(self) -> str:
        """ "disc": |x - centre| <= radius; "half_plane": normal·x <= offset; "angles": an interval
        of the joint angle."""
    @property
    def centre(self) -> NDArray[np.float64]:
        """[2], m"""
    @property
    def radius(self) -> float: ...
    @property
    def normal(self) -> NDArray[np.float64]:
        """[2], a unit vector"""
    @property
    def offset(self) -> float: ...

class Task:
    """A sparse-reward task: the reward is 1 when the goal holds, which ends the episode, else 0.

    Body 0 is the robot.
    """

    @property
    def name(self) -> str: ...
    @property
    def shapes(self) -> Sequence[NDArray[np.float64]]:
        """Per body [vertices, 2], counter-clockwise, centroid at the origin [m]."""
    @property
    def names(self) -> list[str]:
        """The unique names of the bodies."""
    @property
    def kinds(self) -> list[str]:
        """The class of each body."""
    @property
    def fixed(self) -> list[bool]:
        """Per body, True if it never moves."""
    @property
    def joints(self) -> list[tuple[int, int, NDArray[np.float64]]]:
        """Per joint (parent, child, pin in the frame of the parent [2], m)."""
    @property
    def goal(self) -> list[GoalTerm]:
        """The terms of the goal; all must hold."""
    @property
    def arena(self) -> float:
        """Half width of the square that the robot stays in [m]."""
    @property
    def headings(self) -> int:
        """Number of actions: action a pushes along 2πa/headings."""
    @property
    def start(self) -> NDArray[np.float64]:
        """The nominal start. [bodies, 3]"""
    @property
    def horizon(self) -> int:
        """Number of actions after which an episode is truncated."""
    @property
    def discount(self) -> float: ...
    @property
    def start_jitter(self) -> float:
        """Evaluation starts: object positions ± this [m]."""
    @property
    def randomisation(self) -> float:
        """Amplitude of domain randomisation: object positions ± this [m]."""
    @property
    def bodies(self) -> int: ...
    @property
    def observation_size(self) -> int: ...
    def observation(self, states: NDArray[np.float64]) -> NDArray[np.float32]:
        """Returns the observations of the states. [N, bodies, 3] -> [N, observation_size]"""
    def joints_reached(self, states: NDArray[np.float64]) -> list[bool]:
        """Returns per joint whether goal terms concern its angle and all of them hold.

        [1, bodies, 3]
        """
    def centroids(self, states: NDArray[np.float64]) -> list[NDArray[np.float64]]:
        """Returns the centroid of each goal term with that subject. [1, bodies, 3] -> each [2]"""
    def contact_headings(self, states: NDArray[np.float64], seed: int) -> NDArray[np.int64]:
        """Returns per state a heading towards a random movable object.

        Row k is a function of the state, `seed` and k. [N, bodies, 3] -> [N]
        """
    def goal_state(self, seed: int, index: int = 0) -> NDArray[np.float64] | None:
        """Returns sample number `index` of random stream `seed` of the goal states. [bodies, 3]

        The bodies are nearly at rest in it. Returns None if 1,000 attempts find none.
        """
    def succeeded(self, states: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Returns whether the goal holds. [N, bodies, 3] -> [N]"""
    def jittered_start(self, amplitude: float, seed: int, index: int = 0) -> NDArray[np.float64]:
        """Returns start number `index` of random stream `seed`. [bodies, 3]

        Its objects are moved by ± amplitude [m].

        Raises ValueError if 1000 consecutive draws overlap, or for an amplitude outside
        [0, 10] m.
        """

class ConfigError(ValueError):
    """A mistake in the configuration; the text gives file:line, the key and the legal values."""

class _Section:
    """A section of the configuration.

    Its fields are those of the C++ struct of the same name, which documents them. Choices are
    strings.
    """

    def __getattr__(self, name: str) -> Any: ...

class PhysicsConfig(_Section): ...
class ReverseConfig(_Section): ...
class SearchConfig(_Section): ...
class TrainConfig(_Section): ...
class RunConfig(_Section): ...

class Config:
    """The checked configuration of a run."""

    @staticmethod
    def from_file(file: str | PathLike[str], overrides: Sequence[str] = ()) -> Config:
        """Loads a file. `overrides`: each "section.key=value". Raises ConfigError."""
    @staticmethod
    def from_text(text: str, name: str = "text", overrides: Sequence[str] = ()) -> Config:
        """Loads a text. Raises ConfigError.

        `name` is used in messages as the name of the file; paths in the text are relative to it.
        """
    @property
    def task(self) -> Task: ...
    @property
    def physics(self) -> PhysicsConfig: ...
    @property
    def reverse(self) -> ReverseConfig: ...
    @property
    def search(self) -> SearchConfig: ...
    @property
    def train(self) -> TrainConfig: ...
    @property
    def run(self) -> RunConfig: ...
    @property
    def description(self) -> str:
        """The configuration in human-readable text."""
    @property
    def yaml(self) -> str:
        """The canonical YAML text; loading it gives an equal configuration."""
    @property
    def json(self) -> str:
        """The values as JSON."""

class Simulator:
    """The true dynamics of a task: Box2D. Holds no state; equal arguments give equal bits."""

    def __init__(self, config: Config) -> None: ...
    def push(
        self, states: NDArray[np.float64], actions: NDArray[np.int64]
    ) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Simulates one action in each state. [N, bodies, 3], [N] -> [N, bodies, 3], [N]

        The second array is False where the bodies did not come to rest: there the row is not a
        legal transition.
        Raises ValueError for arrays that do not fit the task.
        """

def generate(
    config: Config,
    store: Callable[
        [
            NDArray[np.float64],
            NDArray[np.int32],
            NDArray[np.float64],
            NDArray[np.bool_],
            NDArray[np.int8],
        ],
        Any,
    ],
    progress: Callable[[dict[str, Any]], Any],
) -> str:
    """Runs the whole generation in this process, on run.workers threads; returns the report, JSON.

    Calls store(poses, action, next_poses, success, source) with the transitions in sequence order,
    and after each layer progress({"phase", "layer", "depth", "transitions", "target",
    "contact_share", "start_region"}). An exception of either ends the generation and is raised.
    """

def plan(config: Config, start: NDArray[np.float64]) -> tuple[NDArray[np.float64], int]:
    """Searches forwards for a plan from one start, [1, bodies, 3], by beam search.

    Returns the states of the plan, [T + 1, bodies, 3], or only the start if there is none, and the
    number of simulated pushes. Raises ValueError for arrays that do not fit the task.
    """
