"""The state of a run, as displays show it."""

from __future__ import annotations

from dataclasses import dataclass

FINISHED = "finished"  # phase of a generation that has ended


@dataclass(frozen=True)
class RunState:
    """The progress of a run."""

    generates: bool = True  # False if the run generates no transitions
    phase: str = ""  # of the generation, such as "tree 1", "trees 2 to 5", "random walks"
    layer: int = 0  # current layer of the search, of `depth` layers
    depth: int = 0
    transitions: int = 0
    target: int = 0
    contact_share: float = 0.0
    starts_reached: int = 0
    workers: int = 0
    interactions: int = 0
    budget: int = 0  # total number of interactions; 0: no training
    rate: float = 0.0  # interactions per second
    evaluations: int = 0
    success_rate: float | None = None  # of the last evaluation


class RateMeter:
    """The rate of a count [1/s] over the last `window` seconds.

    The time before the count first changes does not count.
    """

    def __init__(self, window: float = 10.0) -> None:
        self._window = window
        self._samples: list[tuple[float, int]] = []

    def rate(self, count: int, now: float) -> float:
        """Adds a count at time `now` [s] and returns the rate. A decrease resets the meter."""
        if self._samples and count < self._samples[-1][1]:
            self._samples.clear()
        if len(self._samples) == 1 and count == self._samples[0][1]:
            self._samples.clear()
        if not self._samples or count != self._samples[-1][1]:
            self._samples.append((now, count))
        while len(self._samples) > 2 and now - self._samples[0][0] > self._window:
            self._samples.pop(0)
        (first_time, first), (_, last) = self._samples[0], self._samples[-1]
        return (last - first) / (now - first_time) if now > first_time else 0.0
