"""The actions that episodes have tried, state by state."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from rtg import _core
from rtg.learn.exploration import revisit_tolerance

Array = npt.NDArray[Any]

_WINDOW = 500  # largest number of states that are remembered


class TriedActions:
    """The states of each of N episodes, and the actions taken in them.

    A deterministic policy that returns to an earlier state repeats the loop until the episode ends.
    Most failures of trained policies are such loops, usually of two pushes. best_untried() leaves
    them: it returns the action of the largest value among those not yet tried in a state.
    """

    def __init__(self, episodes: int, task: _core.Task) -> None:
        self._tolerance = revisit_tolerance(task)
        # [states, N, observation] and [states, N]
        self._observations: Array = np.zeros((0, episodes, task.observation_size), np.float32)
        self._actions: Array = np.zeros((0, episodes), np.int64)

    def best_untried(self, observation: Array, values: Array) -> Array:
        """Returns the best actions that were not tried in these states; 0 where all were.

        observation [N, observation], values [N, actions] -> [N]
        """
        same = (np.abs(self._observations - observation) < self._tolerance).all(axis=2)
        step, episode = np.nonzero(same)
        untried = values.copy()
        untried[episode, self._actions[step, episode]] = -np.inf
        return untried.argmax(axis=1)

    def add(self, observation: Array, actions: Array) -> None:
        """Stores that `actions` [N] are taken in states `observation` [N, observation]."""
        self._observations = np.concatenate((self._observations[-_WINDOW:], observation[None]))
        self._actions = np.concatenate((self._actions[-_WINDOW:], actions[None]))

    def keep(self, episodes: Array) -> None:
        """Forgets the other episodes. `episodes` [N] bool"""
        self._observations = self._observations[:, episodes]
        self._actions = self._actions[:, episodes]
