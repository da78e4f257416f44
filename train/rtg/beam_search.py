"""The beam search backwards in time, layer by layer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rtg import _core
from rtg.arguments import checked
from rtg.engines import replay_function
from rtg.task import Task
from rtg.transitions import Transitions

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Nodes:
    """The nodes of a tree, K in all: states from which the goal can be reached.

    - `states`: [K, bodies, 3] in m and rad.
    - `actions`: the push that leads to the parent; -1 in goal states. [K]
    - `parents`: index of the node that the push leads to, or -1. [K]
    - `depths`: pushes until the goal. [K]
    """

    states: Floats
    actions: Integers
    parents: Integers
    depths: Integers

    def __len__(self) -> int:
        return len(self.depths)

    @checked
    def plan(self, node: int) -> list[int]:
        """Returns the actions from a node to the goal."""
        actions = []
        while self.parents[node] >= 0:
            actions.append(int(self.actions[node]))
            node = int(self.parents[node])
        return actions


class BeamSearch:
    """A beam search from goal states towards a start [Algorithm 1].

    Each `grow()` solves for the predecessors of all states of the beam under all actions, plays the
    most promising ones forward, and makes the beam of those from which the goal is reached then:

        search = rtg.BeamSearch(rtg.load_task("gathering"))
        while len(search.beam) and search.nodes.depths.max() < 10:
            data = search.grow()
    """

    @checked
    def __init__(
        self,
        task: Task,
        target: ArrayLike | None = None,
        *,
        seed: int = 1,
        workers: int = 1,
        settings: Sequence[str] = (),
    ) -> None:
        """Makes the roots: goal states, at rest.

        `target`: the start to grow towards [bodies, 3]; a random one if None. `settings`: as of
        `rtg.generate`, such as "search.breadth=20". Raises ValueError for what is not legal.
        """
        self.task = task
        config = task.config_with([f"run.workers={workers}"], settings)
        self.target = task.start(seed) if target is None else np.asarray(target, np.float64)
        start = task.inner_state(self.target, "target")[None]
        self._core = _core.BeamSearch(config, start, seed, replay_function(config))
        self._core.make_roots()

    def grow(self) -> Transitions:
        """Grows the tree by a layer, and returns the transitions that are worth storing.

        Returns none if the beam is empty: no plan from it has succeeded.
        """
        poses, action, next_poses, success, source = self._core.grow()
        shape = (-1, len(self.task.bodies), 3)
        return Transitions(
            self.task.outer(poses.reshape(shape)),
            action.astype(np.int64),
            self.task.outer(next_poses.reshape(shape)),
            success,
            source,
        )

    @property
    def nodes(self) -> Nodes:
        """All nodes of the tree, roots first."""
        states, *rest = self._core.nodes
        return Nodes(self.task.outer(states), *rest)

    @property
    def beam(self) -> Integers:
        """The nodes from which the next layer grows, as indices into `nodes`."""
        return self._core.beam

    @property
    def start_distance(self) -> float:
        """An estimate of the pushes between the start and the nearest node of the beam.

        Infinity if the beam is empty. See core/search/start_distance.hpp.
        """
        return self._core.start_distance
