"""The time spent on learning, summed over all processes of a resumed run."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping


class Clock:
    """Measures wall time while the clock runs, and processor time since its construction.

    Processor time is that of the whole process, so it includes the preparation before learning. If
    several runs share the process, it is that of the calling thread while the clock runs; work that
    a run leaves to other threads (the gradients on a GPU) is then not counted.
    """

    def __init__(self) -> None:
        # [s], processor time at construction; None after the first start.
        self._made: float | None = time.process_time()
        self._before = (0.0, 0.0)  # [s], wall and processor time of the finished periods
        self._since: tuple[float, float] | None = None
        self._cpu: Callable[[], float] = time.process_time

    def start(self, alone: bool = True) -> None:
        """Starts the clock. `alone`: no other run shares the process."""
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
        """Returns the times so far [s], by their column names in progress.csv."""
        wall, cpu = self._total()
        return {"wall_s": wall, "cpu_s": cpu}

    def restore(self, seconds: Mapping[str, float]) -> None:
        """Continues from `seconds`, which holds at least the values of an earlier seconds()."""
        self._before = (seconds["wall_s"], seconds["cpu_s"])

    def _now(self) -> tuple[float, float]:
        return time.monotonic(), self._cpu()

    def _total(self) -> tuple[float, float]:
        if self._since is None:
            return self._before
        now = self._now()
        wall, cpu = (b + n - s for b, n, s in zip(self._before, now, self._since, strict=True))
        return wall, cpu
