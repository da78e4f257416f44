"""The trees that the steps of a data set make: how many steps lead from each one to success."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rtg.files.dataset import Rows
from rtg.files.episodes import positions

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_MAX_GAP = 0.5  # [task units], largest jump of a body from the end of a step to the next one
_TRIES = 3  # calls of add() in which the next step of a step may come
_PART = 500  # number of states that are compared with all others at once


class StepTree:
    """Steps in the order in which a search stores them, each with its depth.

    The depth of a step is the number of steps from it to success, itself included. The next step
    after one that does not succeed is that whose start is nearest to its end, at most 0.5 task
    units off. Steps that lead to no known one have depth 0.
    """

    def __init__(self, bodies: int) -> None:
        self.starts: Floats = np.zeros((0, bodies, 3))
        self.ends: Floats = np.zeros((0, bodies, 3))
        self.depths: Ints = np.zeros(0, np.int64)
        self._following: Ints = np.zeros(0, np.int64)  # index of the next step; -1: none
        self._known: NDArray[np.float32] = np.zeros((0, 2 * bodies), np.float32)  # of starts
        self._open: Ints = np.zeros(0, np.int64)  # steps without depth, to be tried again
        self._tries: Ints = np.zeros(0, np.int64)  # that each of them has had

    def add(self, steps: Rows) -> Ints:
        """Appends steps. Returns the indices of the steps whose depth is settled by that.

        The next step of one may come later. One that has no depth after three calls keeps depth 0.
        """
        count = len(steps.action)
        new = np.arange(len(self.depths), len(self.depths) + count)
        self.starts = np.concatenate([self.starts, steps.poses])
        self.ends = np.concatenate([self.ends, steps.next_poses])
        self.depths = np.concatenate([self.depths, steps.terminated.astype(np.int64)])
        self._known = np.concatenate([self._known, positions(steps.poses)])
        self._following = np.concatenate([self._following, np.full(count, -1)])
        tried = np.concatenate([self._open, new])
        tries = np.concatenate([self._tries, np.zeros(count, np.int64)]) + 1
        self._link(tried)
        is_open = (self.depths[tried] == 0) & (tries < _TRIES)
        self._open, self._tries = tried[is_open], tries[is_open]
        return tried[~is_open]

    def rest(self) -> Ints:
        """Settles all steps. Returns the indices of those that keep depth 0 by that."""
        rest, self._open, self._tries = self._open, self._open[:0], self._tries[:0]
        return rest

    def plan(self, step: int) -> Floats:
        """Returns the states of the plan that begins with `step`. [T + 1, bodies, 3]

        They are the starts of its steps, then the end of the last one.
        """
        chain = [step]
        while self.depths[chain[-1]] > 1:
            chain.append(int(self._following[chain[-1]]))
        return np.concatenate([self.starts[chain], self.ends[chain[-1:]]])

    def _link(self, steps: Ints) -> None:
        """Finds the next step of each of `steps`, and the depths that follow from that."""
        alone = steps[self.depths[steps] == 0]
        in_row = alone[alone + 1 < len(self.depths)]  # steps of a plan that is stored whole
        in_row = in_row[(self.ends[in_row] == self.starts[in_row + 1]).all(axis=(1, 2))]
        self._following[in_row] = in_row + 1
        alone = np.setdiff1d(alone, in_row)
        squares = (self._known**2).sum(axis=1)
        for part in np.array_split(alone, 1 + len(alone) // _PART) if len(alone) else ():
            ends = positions(self.ends[part])
            nearest = (squares - 2.0 * ends @ self._known.T).argmin(axis=1)
            jumps = (self._known[nearest] - ends).reshape(len(part), -1, 2)
            near = np.linalg.norm(jumps, axis=2).max(axis=1) <= _MAX_GAP
            self._following[part] = np.where(near, nearest, -1)
        while len(found := self._newly_linked(steps)):
            self.depths[found] = self.depths[self._following[found]] + 1

    def _newly_linked(self, among: Ints) -> Ints:
        """Returns those steps without depth whose next step has one."""
        following = self._following[among]
        has_depth = (following >= 0) & (self.depths[following] > 0)
        return among[(self.depths[among] == 0) & has_depth]
