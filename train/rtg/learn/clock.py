"""Measures the time spent on learning, over all processes of a resumed run."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping


class Clock:
    """Measures wall time and processor time while it runs.

    Processor time is that of the whole process. It also includes the time from construction to the
    first start, the preparation of learning.

    If several runs share the process, processor time is that of the calling thread. It then leaves
    out preparation, and work on other threads such as gradients on a GPU.
    """

    def __init__(self) -> None:
        # Processor time [s]; None after the first start.
        self._cpu_at_construction: float | None = time.process_time()
        self._elapsed = (0.0, 0.0)  # [s], wall and processor time of the finished periods
        # [s], wall and processor time of the start; None while the clock is stopped.
        self._start_times: tuple[float, float] | None = None
        self._cpu: Callable[[], float] = time.process_time

    def start(self, alone: bool = True) -> None:
        """Starts the clock. `alone`: True if no other run shares the process."""
        self._cpu = time.process_time if alone else time.thread_time
        wall, cpu = self._now()
        if alone and self._cpu_at_construction is not None:
            cpu = self._cpu_at_construction
        self._start_times = (wall, cpu)
        self._cpu_at_construction = None

    def stop(self) -> None:
        self._elapsed, self._start_times = self._total(), None

    @property
    def running(self) -> bool:
        return self._start_times is not None

    def seconds(self) -> dict[str, float]:
        """Returns the times so far [s], by their names in progress.csv."""
        wall, cpu = self._total()
        return {"wall_s": wall, "cpu_s": cpu}

    def restore(self, seconds: Mapping[str, float]) -> None:
        """Continues from the times that seconds() returned earlier."""
        self._elapsed = (float(seconds["wall_s"]), float(seconds["cpu_s"]))

    def _now(self) -> tuple[float, float]:
        return time.monotonic(), self._cpu()

    def _total(self) -> tuple[float, float]:
        if self._start_times is None:
            return self._elapsed
        now = self._now()
        times = zip(self._elapsed, now, self._start_times, strict=True)
        wall, cpu = (elapsed + end - start for elapsed, end, start in times)
        return wall, cpu
