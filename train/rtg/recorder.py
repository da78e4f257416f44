"""Collects the transitions of a run, in sequence order, for transitions.npz."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rtg import _core, dataset
from rtg.dataset import Transitions
from rtg.transition_stream import Rows


class Recorder:
    """A sink of rows; the file is a function of the rows alone."""

    def __init__(self, task: _core.Task) -> None:
        self._task = task
        self._parts: list[Rows] = []
        self.count = 0

    def add(self, rows: Rows) -> None:
        """The next rows of the sequence."""
        self._parts.append(rows)
        self.count += len(rows.action)

    def transitions(self) -> Transitions:
        """Everything so far, with observations."""
        task = self._task
        empty = np.zeros((0, task.bodies, 3))
        none = Rows(
            empty,
            np.zeros(0, np.int32),
            empty,
            np.zeros(0, np.float32),
            np.zeros(0, np.bool_),
            np.zeros(0, np.int8),
        )
        rows = Rows(*(np.concatenate(column) for column in zip(none, *self._parts, strict=True)))
        return Transitions(
            **rows._asdict(),
            observation=task.observation(rows.poses),
            next_observation=task.observation(rows.next_poses),
        )

    def write(self, path: Path) -> None:
        """Writes the file, at once or not at all."""
        dataset.write(path, self.transitions())
