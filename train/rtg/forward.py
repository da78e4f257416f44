"""Forward simulators of a task, with one interface."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rtg import _core
from rtg.arguments import checked, indices, numbers
from rtg.task import Task

Floats = NDArray[np.float64]


class _Forward:
    engine: str  # a value of forward.engine

    @checked
    def __init__(self, task: Task) -> None:
        self.task = task
        self._core = _core.Simulator(task.config_with([f"forward.engine={self.engine}"]))

    def push(self, states: ArrayLike, actions: ArrayLike) -> tuple[Floats, NDArray[np.bool_]]:
        """Simulates a push from each state. [N, bodies, 3], [N] -> [N, bodies, 3], [N]

        Returns the states after the pushes, at rest, and whether each push could be finished.
        Equal arguments give equal bits. Raises ValueError for wrong shapes.
        """
        pushes = indices("action", actions, self.task.actions)
        after, ok = self._core.push(self.task.inner(states), pushes)
        return self.task.outer(after), ok

    def push_along(self, states: ArrayLike, ways: ArrayLike) -> tuple[Floats, NDArray[np.bool_]]:
        """Like push(), with the way (x, y) [m] of the robot instead of an action. [N, 2]

        A way has any direction and any length above 0.
        """
        metres = numbers("ways", ways, (None, 2))
        after, ok = self._core.push_along(self.task.inner(states), metres * self.task.core.metre)
        return self.task.outer(after), ok


class Newton(_Forward):
    """Each sub-step minimises the step energy [eq. (5)]: the model that the reverse one inverts."""

    engine = "newton"


class Box2D(_Forward):
    """The rigid-body engine Box2D."""

    engine = "box2d"
