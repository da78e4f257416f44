"""Measures how the time of learning divides over its stages."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

STAGES = (
    "receiving",  # transitions, and writing what displays show
    "acting",  # choosing actions in training episodes
    "environment",  # pushes of training episodes
    "replay",  # storing and sampling transitions
    "gradient_steps",
    "evaluation",
    "saving",  # checkpoints
)


class Stopwatch:
    """Adds up the time spent in `with` blocks: wall time and processor time [s].

    Processor time is that of the whole process, or as set by `cpu`.
    """

    def __init__(self) -> None:
        self.wall_s = self.cpu_s = 0.0
        self.cpu: Callable[[], float] = time.process_time

    def __enter__(self) -> None:
        self._begin = time.monotonic(), self.cpu()

    def __exit__(self, *_: object) -> None:
        self.wall_s += time.monotonic() - self._begin[0]
        self.cpu_s += self.cpu() - self._begin[1]


class Stages:
    """A stopwatch for each stage of learning, over all processes of a resumed run."""

    def __init__(self) -> None:
        self._watches = {name: Stopwatch() for name in STAGES}

    def __getitem__(self, name: str) -> Stopwatch:
        return self._watches[name]

    def share_process(self) -> None:
        """Measures the processor time of the calling thread alone from now on."""
        for one in self._watches.values():
            one.cpu = time.thread_time

    def seconds(self) -> dict[str, dict[str, float]]:
        """Returns the times so far, by stage and by "wall_s", "cpu_s"."""
        return {
            name: {"wall_s": round(one.wall_s, 3), "cpu_s": round(one.cpu_s, 3)}
            for name, one in self._watches.items()
        }

    def restore(self, seconds: Mapping[str, Mapping[str, float]]) -> None:
        """Continues from the times that seconds() returned earlier."""
        for name, one in self._watches.items():
            one.wall_s, one.cpu_s = float(seconds[name]["wall_s"]), float(seconds[name]["cpu_s"])
