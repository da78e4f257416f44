"""Reverse curriculum generation [Florensa et al. 2017]: starts that grow back from goal states.

A round trains from a pool of starts. Those that the learner solves now and then, but not always,
are good: short walks of random pushes from them give most of the next pool, good ones of earlier
rounds the rest. The first walks begin at states in which the goal holds.

Its bounds of a good start and its ratio of new and old ones are kept. Its pools, 200 and 100, would
leave six rounds of whole episodes in Table 2's interactions; ours leave 30, and more of shorter.

Choices that give the method its best chance:
- Its walks of 50 small steps are PUSHES whole pushes, of which half seek contact: of uniform pushes
  one in ten moves anything, so the starts would differ in where the robot stands.
- Where a round has fewer than FEWEST good starts, since it was too easy or too hard, the next walks
  begin at mastered ones, too: else a learner that solves all starts so far would stay among them.
  They are those of the starts it added, as the old ones lie further in, and of these the half that
  took the learner most pushes, as walks lead inwards as often as outwards. Where it has neither
  they begin again where the last ones began.
- Starts with an object beyond the arena are left out: the robot cannot push it back.
- A share of the episodes begins at the task's own starts, which is what the learner is judged by.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.errors import UserError

Floats = NDArray[np.float64]

LEAST, MOST = 0.1, 0.9  # success from a good start
NEW, OLD = 40, 20  # starts of a pool
FEWEST = 10  # good starts that a round needs to go on from them alone
EPISODES = 3  # per start and round, in the mean
GOALS = 100  # states that the first walks begin at
WALKS, PUSHES = 100, 3  # from which the new starts are drawn
SEEKING = 0.5  # share of their pushes that seek contact
OF_GOALS = 1 << 62  # seeds of goal states, beyond those of runs

ELSEWHERE = -1  # number of a start that is not of the curriculum


def goal_states(task: _core.Task, seed: int, count: int = GOALS) -> Floats:
    """`count` draws but for those in vain. [goals, bodies, 3]; UserError if none is left."""
    draws = [task.goal_state(seed, k) for k in range(count)]
    found = [state for state in draws if state is not None]
    if not found:
        raise UserError(f"goal: none of {count} draws found a state in which it holds")
    return np.stack(found)


class Curriculum:
    """Where a share of the training episodes begin; how they end decides where the next ones do."""

    def __init__(self, config: _core.Config, share: float, seed: int) -> None:
        self._task, self._simulator = config.task, _core.Simulator(config)
        self._share = share
        self._rng = np.random.default_rng([seed, 2])
        self._seeds: Floats = goal_states(self._task, OF_GOALS + seed)  # where walks begin
        self._good = self._seeds[:0]  # of all rounds
        self._first = 0  # number of the pool's first start
        self._drawn = 0  # starts of this pool
        self.pushes = 0  # of the simulator on walks, beside the learner's interactions
        self._set_pool(self._nearby(), self._good)

    @property
    def pool(self) -> Floats:
        """The starts of this round. [starts, bodies, 3]"""
        return self._pool

    def draw(self) -> tuple[int, Floats | None]:
        """The next episode's start with its number; ELSEWHERE if it shall begin as without."""
        if self._rng.random() >= self._share:
            return ELSEWHERE, None
        k = self._drawn % len(self._pool)
        self._drawn += 1
        return self._first + k, self._pool[k]

    def note(self, number: int, success: bool, length: int) -> None:
        """How an episode from that start ended, after `length` pushes. Those of earlier rounds no
        longer count."""
        k = number - self._first
        if k < 0:  # ELSEWHERE, too
            return
        self._tries[k] += 1
        self._wins[k] += success
        self._lengths[k] += length
        if self._tries.sum() >= EPISODES * len(self._pool):
            self._next_round()

    def _next_round(self) -> None:
        rate = self._wins / np.maximum(self._tries, 1)
        good = self._pool[(rate >= LEAST) & (rate <= MOST)]
        seeds = good if len(good) >= FEWEST else np.concatenate((good, self._frontier(rate)))
        if len(seeds):
            self._seeds = seeds
        old = self._some(self._good, OLD)
        self._good = np.concatenate((self._good, good))
        self._first += len(self._pool)
        self._set_pool(self._nearby(), old)

    def _frontier(self, rate: Floats) -> Floats:
        """The half of the mastered new starts with the longest episodes."""
        mastered = np.flatnonzero(rate[: self._new] > MOST)
        lengths = self._lengths[mastered] / self._tries[mastered]
        longest = np.argsort(-lengths, kind="stable")[: (len(mastered) + 1) // 2]
        return self._pool[mastered[longest]]

    def _set_pool(self, new: Floats, old: Floats) -> None:
        pool = np.concatenate((new, old))
        self._pool, self._new = pool, len(new)
        self._drawn = 0
        self._tries = np.zeros(len(pool), np.int64)
        self._wins = np.zeros(len(pool), np.int64)
        self._lengths = np.zeros(len(pool), np.int64)  # pushes in all tries

    def _some(self, states: Floats, count: int) -> Floats:
        """`count` of them, or all, in random order."""
        return states[self._rng.permutation(len(states))[:count]]

    def _nearby(self) -> Floats:
        """New starts: states on random walks from the seeds; the start of the task without any."""
        states = self._seeds[self._rng.integers(len(self._seeds), size=WALKS)]
        met = []
        for _ in range(PUSHES):
            after, ok = self._simulator.push(states, self._headings(states))
            self.pushes += WALKS
            states = np.where(ok[:, None, None], after, states)
            met.append(states[ok])
        found = np.concatenate(met)
        within = (np.abs(found[:, 1:, :2]) <= self._task.arena).all(axis=(1, 2))
        found = self._some(found[within & ~self._task.succeeded(found)], NEW)
        return found if len(found) else self._task.start[None]

    def _headings(self, states: Floats) -> NDArray[np.int64]:
        """The heading of the next push of each walk. [walks]"""
        contact = self._task.contact_headings(states, int(self._rng.integers(1 << 62)))
        anywhere = self._rng.integers(self._task.headings, size=len(states))
        return np.where(self._rng.random(len(states)) < SEEKING, contact, anywhere)

    def state(self) -> dict[str, Any]:
        """Everything that the next starts depend on."""
        return {
            "rng": self._rng.bit_generator.state,
            "seeds": self._seeds,
            "good": self._good,
            "pool": self._pool,
            "new": self._new,
            "tries": self._tries,
            "wins": self._wins,
            "lengths": self._lengths,
            "first": self._first,
            "drawn": self._drawn,
            "pushes": self.pushes,
        }

    def restore(self, state: dict[str, Any]) -> None:
        self._rng.bit_generator.state = state["rng"]
        self._seeds, self._good = np.asarray(state["seeds"]), np.asarray(state["good"])
        pool, new = np.asarray(state["pool"]), state["new"]
        self._set_pool(pool[:new], pool[new:])
        self._tries = np.asarray(state["tries"]).copy()
        self._wins = np.asarray(state["wins"]).copy()
        self._lengths = np.asarray(state["lengths"]).copy()
        self._first, self._drawn = state["first"], state["drawn"]
        self.pushes = state["pushes"]
