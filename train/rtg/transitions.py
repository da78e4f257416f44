"""Transitions as arrays, and their generation in this process."""

from __future__ import annotations

import contextlib
import queue
import reprlib
import threading
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, fields
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.arguments import checked
from rtg.engines import replay_function
from rtg.errors import StoppedError
from rtg.files import archives, own_data
from rtg.task import Task

Floats = NDArray[np.float64]

SOURCES = _core.SOURCES  # names of the sources of transitions

_AHEAD = 64  # batches that the search may be ahead of who takes them


@dataclass(frozen=True)
class Transitions:
    """N pushes and where they lead.

    - `states`, `next_states`: before and after each push. [N, bodies, 3] x [m], y [m], θ [rad]
    - `actions`: [N]
    - `success`: whether the goal holds afterwards. [N]
    - `source`: index into rtg.SOURCES. [N]
    """

    states: Floats
    actions: NDArray[np.int64]
    next_states: Floats
    success: NDArray[np.bool_]
    source: NDArray[np.int8]

    def __len__(self) -> int:
        return len(self.actions)

    @classmethod
    def joined(cls, parts: Iterable[Transitions]) -> Transitions:
        """Returns all transitions of `parts`, in their order. Raises ValueError for none."""
        all_parts = list(parts)
        if not all_parts or not all(isinstance(part, cls) for part in all_parts):
            raise ValueError(
                f"parts {reprlib.repr(parts)}; legal: objects of rtg.Transitions, at least one"
            )
        columns = {
            field.name: np.concatenate([getattr(part, field.name) for part in all_parts])
            for field in fields(cls)
        }
        return cls(**columns)

    @checked
    def save(self, path: str | PathLike[str]) -> None:
        """Writes the file that load() and `rtg TASK --data FILE` read: a .npz."""
        with archives.written(Path(path)) as file:
            np.savez(
                file,
                states=self.states,
                actions=self.actions,
                next_states=self.next_states,
                source=self.source,
            )

    @classmethod
    @checked
    def load(cls, path: str | PathLike[str], task: Task) -> Transitions:
        """Reads transitions of the task, which judges their success. docs/data.md has the arrays.

        `path`: a file that save() wrote, or a run: its folder or transitions.npz. Raises UserError
        if the file is not legal, of another task, or changed since the run wrote it.
        """
        rows = own_data.read(Path(path), task.core).rows
        states, after = task.outer(rows.poses), task.outer(rows.next_poses)
        return cls(states, rows.action.astype(np.int64), after, rows.terminated, rows.source)


@checked
def generate(
    task: Task,
    count: int | None = None,
    *,
    seed: int = 1,
    workers: int = 1,
    settings: Sequence[str] = (),
) -> Iterator[Transitions]:
    """Generates transitions by reverse search, and yields them in batches as they are found.

    Equal arguments give equal transitions, whatever `workers`, the number of threads. `count`: how
    many; `search.transitions` of the task if None. `settings`: each "section.key=value", such as
    "search.generator=naive". Fewer than `count` come if the search finds no more. Raises ValueError
    for settings that are not legal.
    """
    own = [f"run.seed={seed}", f"run.workers={workers}"]
    if count is not None:
        own.append(f"search.transitions={count}")
    return _batches(task, task.config_with(own, settings))


class _Search:
    """A generation on a thread of its own, which waits where it is _AHEAD of who takes from it."""

    def __init__(self, task: Task, config: _core.Config) -> None:
        self._task, self._config = task, config
        self._engine = replay_function(config)
        self._found: queue.Queue[Transitions | BaseException | None] = queue.Queue(_AHEAD)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def take(self) -> Transitions | None:
        """Returns the next batch; None after the last. Raises the error of the search."""
        item = self._found.get()
        if isinstance(item, BaseException):
            raise item
        return item

    def stop(self) -> None:
        """Ends the search, at the latest after the current layer."""
        self._stop.set()
        self._thread.join()

    def _run(self) -> None:
        try:
            _core.generate(self._config, self._store, self._progress, engine=self._engine)
            self._put(None)
        except StoppedError:
            pass
        except BaseException as error:
            self._put(error)

    def _put(self, item: Transitions | BaseException | None) -> None:
        while not self._stop.is_set():
            with contextlib.suppress(queue.Full):
                return self._found.put(item, timeout=0.1)
        raise StoppedError

    def _store(self, poses: Any, action: Any, next_poses: Any, success: Any, source: Any) -> None:
        states, after = self._task.outer(poses), self._task.outer(next_poses)
        self._put(Transitions(states, action.astype(np.int64), after, success, source))

    def _progress(self, _: dict[str, Any]) -> None:
        if self._stop.is_set():
            raise StoppedError


def _batches(task: Task, config: _core.Config) -> Iterator[Transitions]:
    search = _Search(task, config)
    try:
        while (batch := search.take()) is not None:
            if len(batch):
                yield batch
    finally:
        search.stop()
