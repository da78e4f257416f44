"""The C++ core of RTG: configuration, tasks, the true dynamics, generation.

Poses are x [m], y [m], θ [rad]; body 0 is the robot.
"""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

METHODS: tuple[str, ...]
"""What is compared, see nodes/config/method.hpp."""
SOURCES: tuple[str, ...]
"""Where a transition comes from, by value, see core/search/transition.hpp."""

class GoalTerm:
    """One condition on a state: what the subject is lies in the region."""

    @property
    def subject(self) -> str:
        """ "every": the centres of the bodies of the kind ("*": all objects); "centroid": their
        mean; "joint": the angle of the joint whose child is named `kind` ("*": of every joint)."""
    @property
    def kind(self) -> str: ...
    @property
    def region(self) -> str:
        """ "disc": |x - centre| <= radius; "half_plane": normal·x <= offset; "angles"."""
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
    """A sparse-reward task: reward 1 and the end when the goal holds. Body 0 is the robot."""

    @property
    def name(self) -> str: ...
    @property
    def shapes(self) -> Sequence[NDArray[np.float64]]:
        """Per body [vertices, 2], counter-clockwise, centroid at the origin [m]."""
    @property
    def names(self) -> list[str]:
        """Of the bodies; they differ."""
    @property
    def kinds(self) -> list[str]:
        """The class of each body."""
    @property
    def fixed(self) -> list[bool]:
        """Whether a body stays where it is."""
    @property
    def joints(self) -> list[tuple[int, int, NDArray[np.float64]]]:
        """(parent, child, pin in the frame of the parent [2])."""
    @property
    def goal(self) -> list[GoalTerm]:
        """All must hold."""
    @property
    def arena(self) -> float:
        """Half width of the square that the robot stays in [m]."""
    @property
    def headings(self) -> int:
        """Number of actions: action a pushes along 2πa/headings."""
    @property
    def start(self) -> NDArray[np.float64]:
        """[bodies, 3]"""
    @property
    def horizon(self) -> int:
        """Actions of an episode; then it is truncated."""
    @property
    def discount(self) -> float: ...
    @property
    def start_jitter(self) -> float:
        """Evaluation starts: object positions ± this [m]."""
    @property
    def randomisation(self) -> float:
        """How far domain randomisation goes: object positions ± this [m]."""
    @property
    def bodies(self) -> int: ...
    @property
    def observation_size(self) -> int: ...
    def observation(self, states: NDArray[np.float64]) -> NDArray[np.float32]:
        """The learner's view. [N, bodies, 3] -> [N, observation_size]"""
    def joints_reached(self, states: NDArray[np.float64]) -> list[bool]:
        """Per joint, whether the goal speaks of its angle and it is as asked. [1, bodies, 3]"""
    def centroids(self, states: NDArray[np.float64]) -> list[NDArray[np.float64]]:
        """The mean centres that the goal speaks of. [1, bodies, 3] -> each [2]"""
    def contact_headings(self, states: NDArray[np.float64], seed: int) -> NDArray[np.int64]:
        """Per state a heading towards a random movable object; that of row k is a function of the
        state, `seed` and k. [N, bodies, 3] -> [N]"""
    def goal_state(self, seed: int, index: int = 0) -> NDArray[np.float64] | None:
        """Sample number `index` of stream `seed` of the states where the goal holds, nearly at
        rest. [bodies, 3]; None if 1,000 attempts found none."""
    def succeeded(self, states: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether the goal holds. [N, bodies, 3] -> [N]"""
    def jittered_start(self, amplitude: float, seed: int, index: int = 0) -> NDArray[np.float64]:
        """Start number `index` of stream `seed`, objects moved by ± amplitude [m]. [bodies, 3]

        Raises ValueError if 1000 draws in a row overlap, or for an amplitude beyond [0, 10] m.
        """

class ConfigError(ValueError):
    """A mistake in the configuration: file:line, the key, what is legal."""

class _Section:
    """A section of the configuration: its fields, with what they mean, are those that the C++
    struct of the same name lists. Choices are texts."""

    def __getattr__(self, name: str) -> Any: ...

class PhysicsConfig(_Section): ...
class ReverseConfig(_Section): ...
class SearchConfig(_Section): ...
class TrainConfig(_Section): ...
class RunConfig(_Section): ...

class Config:
    """Everything that a run is made from, checked."""

    @staticmethod
    def from_file(file: str | PathLike[str], overrides: Sequence[str] = ()) -> Config:
        """`overrides`: "section.key=value". Raises ConfigError."""
    @staticmethod
    def from_text(text: str, name: str = "text", overrides: Sequence[str] = ()) -> Config:
        """`name` stands in messages; paths in the text are relative to it. Raises ConfigError."""
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
        """What it says, for people."""
    @property
    def yaml(self) -> str:
        """The canonical text; reads back to the same."""
    @property
    def json(self) -> str:
        """The same values."""

class Simulator:
    """The true dynamics of a task: Box2D. Holds no state; equal arguments give equal bits."""

    def __init__(self, config: Config) -> None: ...
    def push(
        self, states: NDArray[np.float64], actions: NDArray[np.int64]
    ) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """One action in each state. [N, bodies, 3], [N] -> [N, bodies, 3], [N]

        The second array is False where the bodies did not come to rest: no legal transition.
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
    """The whole generation in this process, on config's run.workers threads; the report as JSON.

    store(poses, action, next_poses, success, source) gets the transitions in sequence order,
    progress({"phase", "layer", "depth", "transitions", "target", "contact_share", "start_region"})
    is called after each layer. What they raise ends the generation.
    """

def plan(config: Config, start: NDArray[np.float64]) -> tuple[NDArray[np.float64], int]:
    """A plan of the forward beam search from one start, [1, bodies, 3].

    Its states, [T + 1, bodies, 3], the start alone if none was found; and the pushes that the
    simulator was asked for. Raises ValueError for arrays that do not fit the task.
    """
