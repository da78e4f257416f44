"""Forward simulators of a task, with one interface."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rtg.arguments import checked, indices, numbers
from rtg.engines import simulator
from rtg.task import Task

Floats = NDArray[np.float64]


def _check_count(states: Floats, name: str, given: NDArray[Any]) -> None:
    if len(states) != len(given):
        raise ValueError(
            f"{len(states)} states but {len(given)} {name}s; legal: one {name} per state"
        )


class Forward:
    """The forward simulator that `forward.engine` of a task names."""

    engine: str | None = None  # a value of forward.engine, in place of the task's

    @checked
    def __init__(self, task: Task) -> None:
        self.task = task
        other = [f"forward.engine={self.engine}"] if self.engine else []
        self._core = simulator(task.config_with(other))

    def push(self, states: ArrayLike, actions: ArrayLike) -> tuple[Floats, NDArray[np.bool_]]:
        """Simulates a push from each state. [N, bodies, 3], [N] -> [N, bodies, 3], [N]

        States are in m and rad. The robot stops at the edge of the arena. Returns the states after
        the pushes, at rest, and whether each push could be finished: not where bodies do not come
        to rest, fly off or stay in each other. Equal arguments give equal bits. Raises ValueError
        as Task.inner() does; bodies that overlap are pushed apart.
        """
        pushes, inner = indices("action", actions, self.task.actions), self.task.inner(states)
        _check_count(inner, "action", pushes)
        after, ok = self._core.push(inner, pushes)
        return self.task.outer(after), ok

    def push_along(self, states: ArrayLike, ways: ArrayLike) -> tuple[Floats, NDArray[np.bool_]]:
        """Like push(), with the way (x, y) [m] of the robot instead of an action. [N, 2]

        A way has any direction and any finite length above 0; the arena cuts it off. Raises
        ValueError for another one.
        """
        metres, inner = numbers("ways", ways, (None, 2)), self.task.inner(states)
        _check_count(inner, "way", metres)
        lengths = np.hypot(*metres.T)
        for length in lengths[~(np.isfinite(lengths) & (lengths > 0.0))]:
            raise ValueError(f"a way of length {length}; legal: finite lengths above 0")
        after, ok = self._core.push_along(inner, metres * self.task.core.metre)
        return self.task.outer(after), ok


class Newton(Forward):
    """Each sub-step minimises the step energy [eq. (5)]: the model that the reverse one inverts."""

    engine = "newton"


class Box2D(Forward):
    """The rigid-body engine Box2D."""

    engine = "box2d"


class MuJoCo(Forward):
    """The physics engine MuJoCo, of the extra `mujoco`."""

    engine = "mujoco"
