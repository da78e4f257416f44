"""The C++ core of RTG: configuration, tasks, the simulator, data generation and planning.

Poses are x [m], y [m], θ [rad]; body 0 is the robot.
"""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

METHODS: tuple[str, ...]
"""The values of run.method: the learning methods, see nodes/config/method.hpp."""
GENERATORS: tuple[str, ...]
SOURCES: tuple[str, ...]
"""The sources of transitions, such as "tree"; see core/search/transition.hpp.

The `source` of a transition is an index into this tuple.
"""

class GoalMark:
    """What a picture shows of a goal term: an area of the plane."""

    @property
    def kind(self) -> str:
        """The kind of the bodies that the term is about; "*": all objects."""
    @property
    def ring(self) -> NDArray[np.float64]:
        """The area's vertices, [V, 2] in m."""
    @property
    def target(self) -> bool:
        """Whether the area is the outline of a body where it is to lie."""
    @property
    def negated(self) -> bool: ...

class Task:
    """A task with sparse reward. Body 0 is the robot.

    The reward is 1 when the goal holds, else 0. Success ends the episode.
    """

    @property
    def name(self) -> str: ...
    @property
    def outlines(self) -> Sequence[Sequence[NDArray[np.float64]]]:
        """The outer ring of each body, then its holes. [vertices, 2] in m, centroid at 0"""
    @property
    def names(self) -> list[str]:
        """The unique names of the bodies."""
    @property
    def kinds(self) -> list[str]:
        """The class of each body."""
    @property
    def fixed(self) -> list[bool]:
        """True for each body that never moves."""
    @property
    def joints(self) -> list[tuple[int, int, list[NDArray[np.float64]]]]:
        """The joints: (parent body, child body, points in the frame of the parent [2], m).

        The pin of a revolute joint, both ends of the axis of a prismatic one, none of a fixed one.
        """
    @property
    def goal_marks(self) -> list[GoalMark]:
        """The regions and target outlines of the goal, for pictures."""
    @property
    def arena(self) -> float:
        """Half width of the square that the robot stays in [m]."""
    @property
    def content(self) -> int:
        """The hash of bodies, joints, goal and pushes: of what a policy of the task is about."""
    @property
    def kilogram(self) -> float:
        """One kilogram, in the unit of masses: that in which the robot's density is 1."""
    @property
    def metre(self) -> float:
        """One metre, in the unit of lengths of poses: that in which the robot's radius is 0.8."""
    @property
    def position_unit(self) -> float:
        """Unit of positions in an observation [m]."""
    @property
    def relative_unit(self) -> float:
        """Unit of relative positions in an observation [m]."""
    @property
    def headings(self) -> int:
        """Number of headings of a push."""
    @property
    def strides(self) -> list[float]:
        """Lengths of a push, the longest one being 1."""
    @property
    def actions(self) -> int:
        """Number of actions: action a has the heading a % headings, the stride a // headings."""
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
        """Largest random offset of an object's x and y in starts of evaluations [m]."""
    @property
    def randomisation(self) -> float:
        """Largest random offset of an object's x and y in domain randomisation [m]."""
    @property
    def bodies(self) -> int: ...
    @property
    def observation_size(self) -> int: ...
    @property
    def robot_entries(self) -> int:
        """Number of the entries of an observation that are about the robot; the first ones."""
    @property
    def interchangeable(self) -> list[list[int]]:
        """The movable objects in groups: to swap two of a group changes nothing but their names.

        Most often each is alone in its group.
        """
    @property
    def turn_periods(self) -> list[float]:
        """The angles by which each body can be turned without any change; 0 of discs [rad]."""
    def observation(self, states: NDArray[np.float64]) -> NDArray[np.float32]:
        """Returns the observations of the states. [N, bodies, 3] -> [N, observation_size]"""
    def joints_reached(self, states: NDArray[np.float64]) -> list[bool]:
        """Returns, for each joint, whether the goal constrains its angle and the angle complies.

        `states`: a single state, [1, bodies, 3].
        """
    def centroids(self, states: NDArray[np.float64]) -> list[NDArray[np.float64]]:
        """Returns the mean centre for each goal term with subject "centroid", each [2].

        `states`: a single state, [1, bodies, 3].
        """
    def contact_headings(self, states: NDArray[np.float64], seed: int) -> NDArray[np.int64]:
        """Draws, for each state, a heading towards a random movable object.

        Entry k depends only on state k, `seed` and k. [N, bodies, 3] -> [N]
        """
    def goal_state(self, seed: int, index: int = 0) -> NDArray[np.float64] | None:
        """Samples a state in which the goal holds and the bodies are nearly at rest. [bodies, 3]

        It is sample `index` of random stream `seed`. Returns None if 1,000 attempts fail.
        """
    def succeeded(self, states: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Returns whether the goal holds in each state. [N, bodies, 3] -> [N]"""
    def is_legal(self, states: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Returns which states an episode can be in. [N, bodies, 3] -> [N]

        They are finite, no bodies overlap by more than 0.03 m, movable ones are within twice the
        arena, and fixed ones in their places.
        """
    def in_start_region(self, states: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Returns whether all objects are in place of a start. [N, bodies, 3] -> [N]

        They are within 0.4 m of the start, or of the region that they start in; the robot may be
        anywhere.
        """
    def jittered_start(self, amplitude: float, seed: int, index: int = 0) -> NDArray[np.float64]:
        """Samples a start: the nominal one, objects moved by up to ± `amplitude` [m] in x and y.

        It is sample `index` of random stream `seed`. [bodies, 3]

        Raises ValueError if 1000 draws in a row are illegal (bodies overlap, an object is outside
        the arena, or the goal holds). Raises ValueError if `amplitude` is outside [0, 10] m.
        """

class ConfigError(ValueError):
    """A mistake in the configuration; the text gives file:line, the key and the legal values."""

class _Section:
    """A section of the configuration.

    The C++ struct of the same name documents the fields. A field with a fixed set of values is a
    string.
    """

    def __getattr__(self, name: str) -> Any: ...

MAX_GRADIENT_NORM: float  # longer gradients are shortened to it

class HeadingNetwork:
    """Values of headings; see core/learn/heading_network.hpp.

    Arrays are float32 and contiguous; `weights` [W] lie in the order of PyTorch's parameters.
    Raises ValueError if shapes do not fit. One thread at a time may use it.
    """

    def __init__(
        self, inputs: int, headings: int, hidden: int, features: int, strides: list[float]
    ) -> None: ...
    def values(
        self, weights: NDArray[np.float32], states: NDArray[np.float32]
    ) -> NDArray[np.float32]:
        """Returns Q of all actions. states [B, inputs] -> [B, actions]"""

class TransitionArrays:
    """The arrays of a gradient step, one row or entry per transition; float32, contiguous."""

    def __init__(
        self,
        states: NDArray[np.float32],
        actions: NDArray[np.int64],
        next_states: NDArray[np.float32],
        rewards: NDArray[np.float32],
        terminated: NDArray[np.float32],
        bounds: NDArray[np.float32],
    ) -> None:
        """`states`, `next_states` [B, inputs], all else [B]."""

class WeightArrays:
    """The weights of a learner and the moments of its optimiser, float32 [W] each.

    The moments are zeros before the first step.
    """

    def __init__(
        self,
        online: NDArray[np.float32],
        target: NDArray[np.float32],
        mean: NDArray[np.float32],
        first_moment: NDArray[np.float32],
        second_moment: NDArray[np.float32],
    ) -> None: ...

class StepRates:
    """How far a gradient step moves the weights; see core/learn/adam.hpp."""

    def __init__(self, *, step: int, learning: float, target: float, mean: float) -> None:
        """`step`: its number, counted from 1; `target`, `mean`: shares of the way, from 0 to 1."""

class DoubleDqn:
    """Gradient steps of Double Q-learning; see core/learn/double_dqn.hpp.

    Arrays and errors as those of HeadingNetwork.
    """

    def __init__(
        self,
        inputs: int,
        headings: int,
        hidden: int,
        features: int,
        strides: list[float],
        *,
        discount: float,
        double_q: bool,
        clipped_double_q: bool,
        clip_targets: bool,
    ) -> None: ...
    def step(
        self, weights: WeightArrays, batch: TransitionArrays, rates: StepRates, *, threads: int
    ) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
        """Performs a gradient step, and moves the other networks towards the online one.

        Changes all of `weights` in place. Returns Q(s, a), the targets, and these before bounds and
        clipping, [B] each.
        """

class PhysicsConfig(_Section): ...
class ForwardConfig(_Section): ...
class ReverseConfig(_Section): ...
class SearchConfig(_Section): ...
class TrainConfig(_Section): ...
class RunConfig(_Section): ...

class Config:
    """The checked configuration of a run."""

    @staticmethod
    def from_file(file: str | PathLike[str], overrides: Sequence[str] = ()) -> Config:
        """Loads a YAML file. `overrides`: each "section.key=value". Raises ConfigError."""
    @staticmethod
    def from_text(text: str, name: str = "text", overrides: Sequence[str] = ()) -> Config:
        """Loads a YAML text. Raises ConfigError.

        Error messages use `name` as the name of the file. Paths in the text are relative to it.
        """
    @property
    def task(self) -> Task: ...
    @property
    def physics(self) -> PhysicsConfig: ...
    @property
    def forward(self) -> ForwardConfig: ...
    @property
    def reverse(self) -> ReverseConfig: ...
    @property
    def search(self) -> SearchConfig: ...
    @property
    def train(self) -> TrainConfig: ...
    @property
    def run(self) -> RunConfig: ...
    @property
    def learner_discount(self) -> float:
        """Discount of the learner: `train.discount`, or that of the task if it is 0."""
    @property
    def evaluation_jitter(self) -> float:
        """Largest displacement of objects in x and y at the start of an evaluation episode [m]."""
    @property
    def training_jitter(self) -> float:
        """The same for episodes of training [m]."""
    @property
    def description(self) -> str:
        """The configuration in human-readable text."""
    @property
    def yaml(self) -> str:
        """The canonical YAML text; loading it gives an equal configuration."""
    @property
    def json(self) -> str:
        """The values as JSON."""

SOLVE_STATUSES: tuple[str, ...]
"""The outcomes of a reverse solve; see core/reverse/problem/solve_status.hpp."""

class ReverseSimulator:
    """Solves the reverse problems of a task, in units of the core; see rtg.reverse."""

    def __init__(self, config: Config) -> None: ...
    def solve(
        self, ends: NDArray[np.float64], actions: NDArray[np.int64], threads: int = 1
    ) -> dict[str, Any]:
        """Solves N problems. [N, bodies, 3], [N]

        Returns the arrays "status" (into SOLVE_STATUSES), "iterations" and "found" (number of
        starts) [N], "starts" [N, 8, bodies, 3], "trajectory" [N, h + 1, bodies, 3], "controls" [N,
        h, 3], "figures" (objective, infeasibility, stationarity) [N, 3], NaN where there is none,
        and "contacts": the arrays "solve", "sub_step", "body", "other", "force" [C], "point" and
        "normal" [C, 2]. Raises ValueError for arrays that do not fit the task.
        """

class StepEnergy:
    """The step energy of a task, in units of the core; see rtg.energy.

    States are [1, bodies, 3], forces [C]. Raises ValueError for arrays that do not fit the task.
    """

    def __init__(self, config: Config) -> None: ...
    @property
    def contacts(self) -> list[tuple[int, int, float]]:
        """Body, other body and coefficient of friction of each contact. [C]"""
    def gaps(self, state: NDArray[np.float64]) -> NDArray[np.float64]: ...
    def forces(self, state: NDArray[np.float64]) -> NDArray[np.float64]: ...
    def value(
        self,
        next: NDArray[np.float64],
        now: NDArray[np.float64],
        previous_forces: NDArray[np.float64] | None,
    ) -> float: ...
    def model(
        self,
        next: NDArray[np.float64],
        now: NDArray[np.float64],
        previous_forces: NDArray[np.float64] | None,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Returns gradient and Hessian, [3 movable] and [3 movable, 3 movable]."""

class BeamSearch:
    """A tree of reverse steps from goal states towards a start; see rtg.beam_search.

    `target`: the start, [1, bodies, 3]. In units of the core.
    """

    def __init__(self, config: Config, target: NDArray[np.float64], seed: int) -> None: ...
    def make_roots(self) -> None: ...
    def grow(
        self,
    ) -> tuple[
        NDArray[np.float64],
        NDArray[np.int32],
        NDArray[np.float64],
        NDArray[np.bool_],
        NDArray[np.int8],
    ]:
        """Grows a layer. Returns poses, action, next poses, success and source of N transitions."""
    @property
    def nodes(
        self,
    ) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Poses [K, bodies, 3], action, parent and depth [K] of all nodes."""
    @property
    def beam(self) -> NDArray[np.int64]:
        """Indices of the nodes that the next layer starts from."""
    @property
    def start_distance(self) -> float: ...

class Simulator:
    """Simulates the pushes of a task: the dynamics of replays, training and evaluation.

    It holds no state; equal arguments give bitwise equal results.
    """

    def __init__(self, config: Config) -> None: ...
    def push(
        self, states: NDArray[np.float64], actions: NDArray[np.int64]
    ) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Simulates one push per state. [N, bodies, 3], [N] -> [N, bodies, 3], [N]

        Returns the states after the pushes, and whether each push is a legal transition. It is
        illegal if the simulator cannot finish it, for instance if the bodies do not come to rest.
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
    """Generates transitions in this process, on run.workers threads. Returns the report as JSON.

    Calls store(poses, action, next_poses, success, source) with the transitions in sequence order.
    Calls progress() after each layer of the search, with a dictionary of "phase", "layer", "depth",
    "transitions", "target", "contact_share" and "start_region". An exception of either function
    ends the generation and is raised.
    """

def plan(config: Config, start: NDArray[np.float64]) -> tuple[NDArray[np.float64], int]:
    """Searches for a plan from `start`, [1, bodies, 3], by forward beam search.

    Returns the states of the plan, [T + 1, bodies, 3], and the number of simulated pushes. Without
    a plan, the states are only the start. Raises ValueError if `start` does not fit the task.
    """
