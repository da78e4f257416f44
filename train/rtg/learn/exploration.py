"""Exploration in training episodes: deviations from the greedy policy."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from rtg import _core

Array = npt.NDArray[Any]

REVISIT_WINDOW = 8  # number of previous states with which a state is compared
# States are equal if each entry of the observation differs less, see revisit_tolerance(): by
# default 0.16 m in positions, 0.04 m in relative ones. With 0.15 ArtManip is not learned.
REVISIT_TOLERANCE = 0.04

# Maps a seed to a heading towards a random object for each environment. [N]
ContactHeadings = Callable[[int], Array]


def revisit_tolerance(task: _core.Task) -> float:
    """Returns the difference of entries of an observation below which two states are equal.

    It is at most a quarter of the shortest push, or steady pushing would look like standing still.
    """
    shortest = min(task.strides) * 2.0 * task.relative_unit  # [m]
    return min(REVISIT_TOLERANCE, shortest / 4.0 / task.position_unit)


class Exploration:
    """ε-greedy exploration that prefers some headings and leaves loops.

    An exploring action is drawn in this order (names in backquotes are settings):
    - with probability `contact_share`: towards an object, because only one in ten uniform pushes
      moves an object;
    - else with probability `nearby_share`: near the greedy heading;
    - else: uniform.

    A greedy policy that returns to an earlier state repeats this loop until the episode ends. The
    repetitions teach it little. With `leave_loops`, the policy explores in every revisited state.
    The last states of an episode are also compared with the first ones of the next episode, with
    negligible effect.
    """

    def __init__(
        self,
        settings: _core.TrainConfig,
        headings: int,
        seed: int,
        contact: ContactHeadings | None = None,
        strides: int = 1,
        tolerance: float = REVISIT_TOLERANCE,
    ) -> None:
        """`contact` draws actions towards objects; needed if contact_share is above 0.

        `headings`, `strides`: their numbers. Action a has the heading a % headings. `tolerance`:
        revisit_tolerance() of the task.
        """
        self.settings = settings
        self.headings, self.action_count = headings, headings * strides
        self.contact = contact
        self.tolerance = tolerance
        self.rng = np.random.default_rng([seed, 1])
        # [states, N, observation], oldest first; None before the first one
        self.recent_observations: Array | None = None

    def epsilon(self, interactions: int) -> float:
        """Returns ε after `interactions` interactions.

        It changes linearly from epsilon_start to epsilon_end over the first share epsilon_share of
        all interactions.
        """
        s = self.settings
        done = min(1.0, interactions / max(1.0, s.epsilon_share * s.interactions))
        return s.epsilon_start + done * (s.epsilon_end - s.epsilon_start)

    def actions(self, greedy: Array, observation: Array, epsilon: float) -> Array:
        """Returns the actions to take: `greedy`, some of them replaced by exploring actions.

        greedy [N], observation [N, observation] -> [N]
        """
        n = len(greedy)
        explores = self.rng.random(n) < epsilon
        if self.settings.leave_loops:
            explores |= self._is_revisited(observation)
        nearby = self.rng.random(n) < self.settings.nearby_share
        offset = self.rng.integers(1, self.settings.nearby_headings + 1, n)
        side = 2 * self.rng.integers(2, size=n) - 1
        heading = greedy % self.headings
        beside = greedy - heading + (heading + offset * side) % self.headings
        anywhere = self.rng.integers(self.action_count, size=n)
        noise = self._towards_objects(np.where(nearby, beside, anywhere))
        return np.where(explores, noise, greedy)

    def _towards_objects(self, noise: Array) -> Array:
        """Replaces a share contact_share of the headings `noise` by ones towards objects. [N]"""
        if self.settings.contact_share == 0.0:
            return noise
        assert self.contact is not None
        seeks = self.rng.random(len(noise)) < self.settings.contact_share
        return np.where(seeks, self.contact(int(self.rng.integers(1 << 62))), noise)

    def _is_revisited(self, observation: Array) -> Array:
        """Returns which environments have returned to a recent state. [N] bool

        Stores `observation` for later calls.
        """
        now, known = observation[None], self.recent_observations
        earlier = now[:0] if known is None else known
        found: Array = (np.abs(earlier - now) < self.tolerance).all(axis=2).any(axis=0)
        self.recent_observations = np.concatenate((earlier[-REVISIT_WINDOW + 1 :], now))
        return found

    def state(self) -> dict[str, Any]:
        return {
            "rng": self.rng.bit_generator.state,
            "last": self.recent_observations,
        }

    def restore(self, state: dict[str, Any]) -> None:
        self.rng.bit_generator.state = state["rng"]
        last = state["last"]
        self.recent_observations = None if last is None else np.asarray(last)
