"""Collects the transitions of a run, in sequence order, for transitions.npz."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rtg import _core
from rtg.errors import RunError
from rtg.files import dataset, row_digest, run_folder, versions
from rtg.files.dataset import Rows, Transitions


class Recorder:
    """Collects transitions and writes them to a file.

    The file does not depend on how the transitions are divided among calls of add().
    """

    def __init__(self, config: _core.Config) -> None:
        self._task, self._origin = config.task, dataset.origin_of(config)
        self._parts = [self._with_observations(_no_rows(self._task.bodies))]
        self.count = 0

    def add(self, rows: Rows) -> Transitions:
        """Appends the next transitions of the run and returns them with their observations."""
        self._parts.append(self._with_observations(rows))
        self.count += len(rows.action)
        return self._parts[-1]

    def _with_observations(self, rows: Rows) -> Transitions:
        task = self._task
        return Transitions(
            **rows._asdict(),
            observation=task.observation(rows.poses),
            next_observation=task.observation(rows.next_poses),
        )

    def transitions(self) -> Transitions:
        """Returns all transitions so far."""
        self._parts = [dataset.concatenate(self._parts)]
        return self._parts[0]

    def write(self, path: Path) -> None:
        """Writes all transitions so far to `path`, atomically."""
        dataset.write(path, self.transitions(), self._origin)

    def digest(self) -> str:
        """Returns the row_digest() of all transitions so far."""
        return row_digest.row_digest(self.transitions())

    def finish(self, path: Path) -> None:
        """Writes all transitions of the run to `path`, and seals the file (versions.seal()).

        Removes the journal of their generation, which has served its purpose.

        Raises RunError if the generation.json beside it tells of others: those that were generated
        are not those that came.
        """
        report = path.with_name("generation.json")
        told = run_folder.read_json(report).get(row_digest.KEY)
        if told not in (None, self.digest()):
            raise RunError(
                f"{report}: the transitions that were generated are not the {self.count} that "
                "arrived, as their SHA-256 differs; generate them anew with --resume"
            )
        self.write(path)
        versions.seal(path)
        (path.parent / run_folder.JOURNAL_FILE).unlink(missing_ok=True)


def _no_rows(bodies: int) -> Rows:
    return Rows(
        poses=np.zeros((0, bodies, 3)),
        action=np.zeros(0, np.int32),
        next_poses=np.zeros((0, bodies, 3)),
        reward=np.zeros(0, np.float32),
        terminated=np.zeros(0, np.bool_),
        source=np.zeros(0, np.int8),
    )
