"""Plays episodes and plans on the time line, one after another."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from rtg.pictures.draw import TaskLike
from rtg.pictures.episode_pictures import interpolate

Floats = NDArray[np.float64]

_FRAMES = 4  # per push
_REST = 2  # pushes that would fit into the rest after an episode


def frames(task: TaskLike, states: Floats) -> Floats:
    """Interpolates the states of an episode. [T + 1, bodies, 3] -> [4 T + 1, bodies, 3]"""
    shares = np.arange(1, _FRAMES + 1) / _FRAMES
    shown = [states[0]]
    for before, after in itertools.pairwise(states):
        shown += [interpolate(task, before, after, float(share)) for share in shares]
    return np.stack(shown)


class Player:
    """Shows one episode at a time. Of those offered meanwhile, it plays the last one next.

    `show(times, states)` moves the bodies, times [F] in s, states [F, bodies, 3].
    `say(time, words)` writes the caption. `push`: duration of a push [s].
    """

    def __init__(
        self,
        task: TaskLike,
        push: float,
        show: Callable[[Floats, Floats], None],
        say: Callable[[float, str], None],
    ) -> None:
        self._task, self._push = task, push
        self._show, self._say = show, say
        self._waiting: tuple[Floats, str] | None = None
        self._times: Floats = np.zeros(0)  # [s], of the frames that are left
        self._frames: Floats = np.zeros((0, len(task.names), 3))
        self.free_at = 0.0  # [s], when the last episode has ended

    def offer(self, states: Floats, words: str) -> None:
        """Offers the states of an episode, [T + 1, bodies, 3], and its caption."""
        self._waiting = states, words

    def advance(self, now: float) -> None:
        """Shows the frames up to time `now` [s]; infinity: all of the episodes offered."""
        while self._show_until(now) and self._waiting is not None:
            (states, words), self._waiting = self._waiting, None
            self._begin(max(self.free_at, now) if np.isfinite(now) else self.free_at, states, words)

    def _begin(self, at: float, states: Floats, words: str) -> None:
        self._frames = frames(self._task, states)
        passed = np.arange(len(self._frames)) * (self._push / _FRAMES)
        self._times = np.asarray(at + passed, np.float64)
        self.free_at = float(self._times[-1]) + _REST * self._push
        self._say(at, words)

    def _show_until(self, now: float) -> bool:
        """Shows the frames that are due; returns whether the next episode may begin."""
        due = int(np.searchsorted(self._times, now, side="right"))
        if due:
            self._show(self._times[:due], self._frames[:due])
        self._times, self._frames = self._times[due:], self._frames[due:]
        return not len(self._times) and self.free_at <= now
