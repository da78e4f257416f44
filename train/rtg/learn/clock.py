"""Seconds of learning, over all processes that took part in it."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping


class Clock:
    """Wall time while it runs, and processor time from when it was made.

    Processor time is that of the whole process: what a run prepares before it learns counts as
    well. Where several runs share the process it is that of the thread that calls, and while the
    clock runs: what a run leaves to other threads (a GPU's share of its gradients) is not seen.
    """

    def __init__(self) -> None:
        self._made: float | None = time.process_time()  # until it starts
        self._before = (0.0, 0.0)  # [s], of the runs so far: wall, processor
        self._since: tuple[float, float] | None = None
        self._cpu: Callable[[], float] = time.process_time

    def start(self, alone: bool = True) -> None:
        """`alone`: no other run shares the process."""
        self._cpu = time.process_time if alone else time.thread_time
        wall, cpu = self._now()
        self._since = (wall, cpu if self._made is None or not alone else self._made)
        self._made = None

    def stop(self) -> None:
        self._before, self._since = self._total(), None

    @property
    def running(self) -> bool:
        return self._since is not None

    def seconds(self) -> dict[str, float]:
        """So far, under the names of progress.csv."""
        wall, cpu = self._total()
        return {"wall_s": wall, "cpu_s": cpu}

    def restore(self, seconds: Mapping[str, float]) -> None:
        """`seconds`: of seconds(), among others."""
        self._before = (seconds["wall_s"], seconds["cpu_s"])

    def _now(self) -> tuple[float, float]:
        return time.monotonic(), self._cpu()

    def _total(self) -> tuple[float, float]:
        if self._since is None:
            return self._before
        now = self._now()
        wall, cpu = (b + n - s for b, n, s in zip(self._before, now, self._since, strict=True))
        return wall, cpu
