"""Symmetries of a task: states that differ only by them have the same values of all actions.

Objects that look the same may be swapped, and an object of a symmetric shape may be turned by the
period of that. With n equal square boxes one layout has n! 4^n such states. A network that is told
which of them it is in has to learn the same thing for each.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from rtg import _core
from rtg.envs.layouts import BODY_ENTRIES, Layouts, object_columns

Array = npt.NDArray[Any]


class Symmetry:
    """Maps network inputs of states that are equal up to the task's symmetries to one input.

    - Of interchangeable objects the one that is nearest to the robot comes first.
    - The angle θ of an object whose shape has the period 2π / k becomes k θ; that of a disc 0.
    """

    def __init__(self, task: _core.Task, layouts: Layouts | None = None) -> None:
        """`layouts`: those of the input, if there are any. Their columns are swapped, too."""
        at = object_columns(task)
        self._cos = np.array([column + 2 for column in at.values()], np.int64)
        periods = np.array([task.turn_periods[body] for body in at])
        # k of each object; 0 of a disc
        self._folds = np.rint(2.0 * np.pi / np.where(periods > 0.0, periods, np.inf))
        self._turned = bool((self._folds != 1.0).any())
        # Of each group: the columns of its members [members, entries], offsets to the robot last.
        self._groups: list[Array] = []
        for group in task.interchangeable:
            more = [layouts.columns_of(body) if layouts else [] for body in group]
            if len(group) == 1 or len({len(columns) for columns in more}) > 1:
                continue
            own = [[*range(at[body], at[body] + BODY_ENTRIES)] for body in group]
            members = [[*extra, *entries] for extra, entries in zip(more, own, strict=True)]
            self._groups.append(np.array(members, np.int64))

    def __call__(self, seen: Array) -> Array:
        """Returns the inputs in whose place those of equal states stand. [N, inputs] float32"""
        if not self._turned and not self._groups:
            return seen
        out = seen.copy()
        if self._turned:
            angles = np.arctan2(seen[:, self._cos + 1], seen[:, self._cos]) * self._folds
            out[:, self._cos], out[:, self._cos + 1] = np.cos(angles), np.sin(angles)
        for columns in self._groups:
            members = out[:, columns]  # [N, members, entries]
            order = np.square(members[:, :, -2:]).sum(axis=2).argsort(axis=1, kind="stable")
            out[:, columns] = np.take_along_axis(members, order[:, :, None], axis=1)
        return out
