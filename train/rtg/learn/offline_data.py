"""Receives the offline transitions of a run and adds them to the replay buffer."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

import numpy as np

from rtg import _core
from rtg.errors import RunError
from rtg.files import dataset
from rtg.files.dataset import Rows, Transitions
from rtg.files.recorder import Recorder
from rtg.learn.replay import MixedReplayBuffer

# numpy parses array headers with `ast`. In Python 3.11 this fails if two threads do it at once.
_READ_LOCK = threading.Lock()
REFRESH_GROWTH = 1.25  # value bounds are recomputed when the data has grown by this factor


class Source(Protocol):
    """A source of transitions (rows), such as rtg.bus.transition_stream.TransitionStream.

    It passes the rows to a receiver, usually OfflineData.add().
    """

    def poll(self, timeout: float) -> int:
        """Waits at most `timeout` s for rows, passes them on and returns their number."""

    def close(self) -> None:
        """Ends the reception of rows."""

    @property
    def complete(self) -> bool:
        """True if all rows have been passed on."""


def read_rows(path: Path, task: _core.Task) -> Rows:
    """Reads the rows of a transition file. Raises dataset.DatasetError."""
    with _READ_LOCK:
        transitions = dataset.read(path, task)
    return Rows(*(getattr(transitions, name) for name in Rows._fields))


class OfflineData:
    """Records all received transitions, and adds those that `select` returns to `buffer`."""

    def __init__(
        self,
        config: _core.Config,
        buffer: MixedReplayBuffer,
        select: Callable[[Transitions], Transitions] = lambda all_rows: all_rows,
    ) -> None:
        self._buffer, self._select = buffer, select
        self.record = Recorder(config)
        # Rows known from the checkpoint. A restarted source repeats them; None once it has done so.
        self._checkpoint_rows: Rows | None = None
        self._repeated_count = 0  # rows that the source has sent again so far
        self._count_at_refresh = 0  # number of rows when the bounds were last computed

    @property
    def count(self) -> int:
        return self.record.count

    def add(self, rows: Rows) -> None:
        """Adds the next rows of the source. Skips rows that a restarted source repeats.

        Raises RunError if repeated rows differ from those of the checkpoint.
        """
        if self._checkpoint_rows is not None:
            rows = rows.slice(self._check_repeated(rows, self._checkpoint_rows))
        if len(rows.action):
            self._buffer.add_offline(self._select(self.record.add(rows)))

    def _check_repeated(self, rows: Rows, known: Rows) -> int:
        begin = self._repeated_count
        again = min(len(rows.action), len(known.action) - begin)
        same = (
            np.array_equal(getattr(rows, name)[:again], getattr(known, name)[begin : begin + again])
            for name in ("poses", "action", "next_poses", "source")
        )
        if not all(same):
            raise RunError("the transitions differ from those that the checkpoint was made with")
        self._repeated_count += again
        if self._repeated_count == len(known.action):
            self._checkpoint_rows = None
        return again

    def refresh_bounds_if_grown(self, complete: bool) -> None:
        """Recomputes the value bounds if the data has grown by the factor REFRESH_GROWTH.

        If `complete`, the data is complete, and any new row is reason enough.
        """
        grown = self.count >= REFRESH_GROWTH * self._count_at_refresh
        if self.count > self._count_at_refresh and (grown or complete):
            self._count_at_refresh = self.count
            self._buffer.refresh_bounds()

    def state(self) -> dict[str, int]:
        """Returns the counts; the rows themselves are in a transition file."""
        return {"count": self.count, "refreshed": self._count_at_refresh}

    def restore(self, state: dict[str, int], rows: Rows) -> None:
        """Restores the counts and adds the rows of the checkpoint to the replay buffer.

        `rows`: all rows of the transition file. It may hold more rows than the checkpoint. Raises
        RunError if it holds fewer.
        """
        count, refreshed = state["count"], state["refreshed"]
        if len(rows.action) < count:
            found = len(rows.action)
            raise RunError(
                f"the transition file has {found} rows, fewer than the {count} of the checkpoint"
            )
        if refreshed:
            self.add(rows.slice(0, refreshed))
            self.refresh_bounds_if_grown(complete=True)
        if count > refreshed:
            self.add(rows.slice(refreshed, count))
        self._checkpoint_rows = rows.slice(0, count)


class NoSource:
    """An empty source, for a learner without offline data."""

    complete = True

    def poll(self, timeout: float) -> int:
        del timeout
        return 0

    def close(self) -> None:
        pass


class FileSource:
    """A source that passes all transitions of a file to `data` at the first poll."""

    def __init__(self, path: Path, task: _core.Task, data: OfflineData) -> None:
        self._rows: Rows | None = read_rows(path, task)
        self._data = data

    @property
    def complete(self) -> bool:
        return self._rows is None

    def poll(self, timeout: float) -> int:
        del timeout
        rows, self._rows = self._rows, None
        if rows is None:
            return 0
        self._data.add(rows)
        return len(rows.action)

    def close(self) -> None:
        pass
