"""The transitions of the run: into the replay buffer as they come in, and kept for their file."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

import numpy as np

from rtg import _core, dataset
from rtg.dataset import Transitions
from rtg.errors import RunError
from rtg.replay import MixedReplayBuffer
from rtg.transition_stream import Rows

REFRESH_GROWTH = 1.25  # bounds are proven anew when the data has grown by this factor


class Source(Protocol):
    """Where transitions come from, as rtg.transition_stream.TransitionStream."""

    def poll(self, timeout: float) -> int:
        """Hands over what comes within `timeout` s; returns how many rows."""

    def close(self) -> None:
        """Takes nothing more."""

    @property
    def complete(self) -> bool:
        """Whether all rows have been handed over."""

    @property
    def lost(self) -> int:
        """Rows known to exist that have not been handed over."""


def with_observations(task: _core.Task, rows: Rows) -> Transitions:
    """The rows with what the learner sees."""
    return Transitions(
        poses=rows.poses,
        action=rows.action,
        next_poses=rows.next_poses,
        reward=rows.reward,
        terminated=rows.terminated,
        observation=task.observation(rows.poses),
        next_observation=task.observation(rows.next_poses),
        source=rows.source,
    )


def _nothing(task: _core.Task) -> Transitions:
    poses, none = np.zeros((0, task.bodies, 3)), np.zeros(0)
    reward, terminated = none.astype(np.float32), none.astype(np.bool_)
    rows = Rows(poses, none.astype(np.int32), poses, reward, terminated, none.astype(np.int8))
    return with_observations(task, rows)


class OfflineData:
    """Everything that came in so far, in sequence order."""

    def __init__(self, task: _core.Task, buffer: MixedReplayBuffer) -> None:
        self._task, self._buffer = task, buffer
        self._parts = [_nothing(task)]
        self._count = 0
        self._known: Transitions | None = None  # restored; a source says them again from the first
        self._repeated = 0  # rows said again so far
        self._refreshed = 0  # rows when the bounds were last proven

    @property
    def count(self) -> int:
        return self._count

    def take(self, rows: Rows) -> None:
        """The next rows of the source."""
        if self._known is not None:
            rows = rows.after(self._check_repeated(rows, self._known))
        if len(rows.action):
            self._append(with_observations(self._task, rows))

    def _append(self, transitions: Transitions) -> None:
        self._parts.append(transitions)
        self._count += len(transitions.action)
        self._buffer.add_offline(transitions)

    def _check_repeated(self, rows: Rows, known: Transitions) -> int:
        begin = self._repeated
        again = min(len(rows.action), len(known.action) - begin)
        same = (
            np.array_equal(getattr(rows, name)[:again], getattr(known, name)[begin : begin + again])
            for name in ("poses", "action", "next_poses", "source")
        )
        if not all(same):
            raise RunError("the transitions are not those that the checkpoint was made with")
        self._repeated += again
        if self._repeated == len(known.action):
            self._known = None
        return again

    def prove_bounds(self, complete: bool) -> None:
        """Brings the value bounds up to date when enough came in since, or all."""
        grown = self._count >= REFRESH_GROWTH * self._refreshed
        if self._count > self._refreshed and (grown or complete):
            self._refreshed = self._count
            self._buffer.refresh_bounds()

    def all(self) -> Transitions:
        """In sequence order."""
        if len(self._parts) > 1:
            self._parts = [dataset.concatenate(self._parts)]
        return self._parts[0]

    def state(self) -> dict[str, int]:
        """The rows themselves go to a transition file."""
        return {"count": self._count, "refreshed": self._refreshed}

    def restore(self, state: dict[str, int], transitions: Transitions) -> None:
        """`transitions`: of the file, those that came in later too."""
        count, refreshed = state["count"], state["refreshed"]
        if len(transitions.action) < count:
            found = len(transitions.action)
            raise RunError(f"the transition file has {found} rows, the checkpoint saw {count}")
        self._known = Transitions(*(column[:count] for column in transitions))
        for begin, end in ((0, refreshed), (refreshed, count)):
            if end > begin:
                self._append(Transitions(*(column[begin:end] for column in transitions)))
            if end == refreshed:
                self._buffer.refresh_bounds()
        self._refreshed = refreshed


class FileSource:
    """The transitions of a file, all at the first poll."""

    lost = 0

    def __init__(self, path: Path, task: _core.Task, data: OfflineData) -> None:
        """Raises dataset.DatasetError, FileNotFoundError."""
        transitions = dataset.read(path, bodies=task.bodies, headings=task.headings)
        self._rows: Rows | None = Rows(*(getattr(transitions, name) for name in Rows._fields))
        self._data = data

    @property
    def complete(self) -> bool:
        return self._rows is None

    def poll(self, timeout: float) -> int:
        del timeout
        rows, self._rows = self._rows, None
        if rows is None:
            return 0
        self._data.take(rows)
        return len(rows.action)

    def close(self) -> None:
        pass
