"""Where training episodes leave the greedy policy, to see what its choices miss."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from rtg import _core

Array = npt.NDArray[Any]

LOOP = 8  # a state is taken for one that came back if it was among so many last ones
SAME = 0.02  # ... up to this in every number of the observation (0.16 m)

# Of a seed: per environment a heading towards a random object of its present state, [N]
ContactHeadings = Callable[[int], Array]


class Exploration:
    """ε-greedy, partly near the greedy heading or towards an object, and a way out of loops.

    The share `contact_share` of what explores heads towards an object: of uniform pushes one in ten
    touches any. Of the rest `nearby_share` is near the greedy heading, and the others anywhere.

    A greedy policy in a deterministic simulator that comes back to a state stays in that loop to
    the end of the episode, and learns little from seeing it again. With `leave_loops` it explores
    wherever one of the last states comes back. (What the last ones of an episode make the first of
    the next one do is of no weight.)
    """

    def __init__(
        self,
        settings: _core.TrainConfig,
        headings: int,
        seed: int,
        contact: ContactHeadings | None = None,
    ) -> None:
        """`contact`: of the environments that act; needed where contact_share is above 0."""
        self.settings = settings
        self.headings = headings
        self.contact = contact
        self.rng = np.random.default_rng([seed, 1])
        self.last: list[Array] = []  # of each environment, [N, observation], oldest first

    def epsilon(self, interactions: int) -> float:
        """Linear from start to end over the first `epsilon_share` of the interactions."""
        s = self.settings
        done = min(1.0, interactions / max(1.0, s.epsilon_share * s.interactions))
        return s.epsilon_start + done * (s.epsilon_end - s.epsilon_start)

    def actions(self, greedy: Array, observation: Array, epsilon: float) -> Array:
        """Chooses what to do instead of `greedy`, [N], seeing `observation`, [N, observation].
        [N]"""
        n = len(greedy)
        explores = self.rng.random(n) < epsilon
        if self.settings.leave_loops:
            explores |= self._came_back(observation)
        nearby = self.rng.random(n) < self.settings.nearby_share
        offset = self.rng.integers(1, self.settings.nearby_headings + 1, n)
        beside = (greedy + offset * self.rng.choice((-1, 1), n)) % self.headings
        anywhere = self.rng.integers(self.headings, size=n)
        noise = self._towards_objects(np.where(nearby, beside, anywhere))
        return np.where(explores, noise, greedy)

    def _towards_objects(self, noise: Array) -> Array:
        """The headings with the share `contact_share` of them towards an object. [N]"""
        if self.settings.contact_share == 0.0:
            return noise
        assert self.contact is not None
        seeks = self.rng.random(len(noise)) < self.settings.contact_share
        return np.where(seeks, self.contact(int(self.rng.integers(1 << 62))), noise)

    def _came_back(self, observation: Array) -> Array:
        """Which environments are where they were a few steps ago. Notes where they are. [N] bool"""
        found = np.zeros(len(observation), np.bool_)
        for earlier in self.last:
            found |= (np.abs(observation - earlier) < SAME).all(axis=1)
        self.last = [*self.last[-LOOP + 1 :], observation.copy()]
        return found

    def state(self) -> dict[str, Any]:
        return {"rng": self.rng.bit_generator.state, "last": [seen.copy() for seen in self.last]}

    def restore(self, state: dict[str, Any]) -> None:
        self.rng.bit_generator.state = state["rng"]
        self.last = [np.asarray(seen).copy() for seen in state["last"]]
