"""Reverse curriculum generation [Florensa et al. 2017]: starts that move back from goal states.

Each round trains from a pool of starts. A start is good if the learner solves it sometimes but not
always. Most starts of the next pool are new: they lie on short random walks from good starts. The
rest are old: good starts of earlier rounds. The first walks begin at states in which the goal
holds.

The bounds of a good start and the ratio of new to old starts are those of Florensa et al. Their
pools of 200 new and 100 old starts would allow only six rounds of full-length episodes within the
interactions of Table 2. The smaller pools here allow 30 rounds.

Choices that give the method its best chance:
- A walk has PUSHES_PER_WALK whole pushes, instead of 50 small steps. Half of the pushes seek
  contact. Only one in ten uniform pushes moves an object, so most starts would otherwise differ
  only in the position of the robot.
- If a round has fewer than MIN_GOOD_STARTS good starts, the next walks also begin at starts that
  the learner nearly always solves (mastered starts). A learner that solves all starts would
  otherwise never leave them.
  - Only new starts qualify, because old ones are closer to the goal.
  - Only the half with the longest episodes is used, because walks lead towards the goal as often as
    away from it.
  - Without good and mastered starts, the walks begin where the previous walks began.
- Starts with an object outside the arena are left out, because the robot cannot push it back.
- A share of the episodes begins at the task's own starts, which evaluations use.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.engines import simulator as make_simulator
from rtg.errors import UserError

Floats = NDArray[np.float64]

MIN_SUCCESS, MAX_SUCCESS = 0.1, 0.9  # bounds of the success rate from a good start
NEW_STARTS, OLD_STARTS = 40, 20  # numbers of new and old starts in a pool
MIN_GOOD_STARTS = 10  # number of good starts below which mastered starts are used, too
EPISODES_PER_START = 3  # mean number of episodes per start and round
GOAL_DRAWS = 100  # number of draws of the goal states where the first walks begin
WALKS, PUSHES_PER_WALK = 100, 3  # number of walks for the new starts; pushes per walk
CONTACT_SHARE = 0.5  # share of the walks' pushes that seek contact
GOAL_SEED_OFFSET = 1 << 62  # added to the seed of a run for its goal states; above all such seeds

NOT_FROM_CURRICULUM = -1  # marks an episode that begins at a start of the task


def goal_states(task: _core.Task, seed: int, count: int = GOAL_DRAWS) -> Floats:
    """Samples states in which the goal holds. [goals, bodies, 3]

    Makes `count` draws and leaves out failed ones. Raises UserError if all draws fail.
    """
    draws = [task.goal_state(seed, k) for k in range(count)]
    found = [state for state in draws if state is not None]
    if not found:
        raise UserError(
            f"task.goal: {count} random draws gave no goal state; legal: a goal that can be met"
        )
    return np.stack(found)


class Curriculum:
    """Provides the starts for a `share` of the training episodes and adapts them to success."""

    def __init__(self, config: _core.Config, share: float, seed: int) -> None:
        self._task, self._simulator = config.task, make_simulator(config)
        self._share = share
        self._rng = np.random.default_rng([seed, 2])
        # States where walks begin.
        self._walk_starts: Floats = goal_states(self._task, GOAL_SEED_OFFSET + seed)
        self._good = self._walk_starts[:0]  # good starts of all rounds
        self._first_number = 0  # number of the pool's first start, counted over all rounds
        self._drawn = 0  # number of draws from this pool
        self.pushes = 0  # simulated pushes of the walks; not among the learner's interactions
        self._set_pool(self._new_starts(), self._good)

    def draw(self) -> tuple[int, Floats | None]:
        """Returns the start of the next episode: its number and its state [bodies, 3].

        Returns (NOT_FROM_CURRICULUM, None) if the episode must begin at a start of the task.
        """
        if self._rng.random() >= self._share:
            return NOT_FROM_CURRICULUM, None
        k = self._drawn % len(self.pool)
        self._drawn += 1
        return self._first_number + k, self.pool[k]

    def record_episode(self, number: int, success: bool, length: int) -> None:
        """Records the result of an episode from start `number` with `length` pushes.

        Begins the next round after the last episode of a round. Ignores starts of earlier rounds
        and NOT_FROM_CURRICULUM.
        """
        k = number - self._first_number
        if k < 0:  # includes NOT_FROM_CURRICULUM
            return
        self._tries[k] += 1
        self._wins[k] += success
        self._lengths[k] += length
        if self._tries.sum() >= EPISODES_PER_START * len(self.pool):
            self._next_round()

    def _next_round(self) -> None:
        rate = self._wins / np.maximum(self._tries, 1)
        good = self.pool[(rate >= MIN_SUCCESS) & (rate <= MAX_SUCCESS)]
        few = len(good) < MIN_GOOD_STARTS
        walk_starts = np.concatenate((good, self._longest_mastered(rate))) if few else good
        if len(walk_starts):
            self._walk_starts = walk_starts
        old = self._random_subset(self._good, OLD_STARTS)
        self._good = np.concatenate((self._good, good))
        self._first_number += len(self.pool)
        self._set_pool(self._new_starts(), old)

    def _longest_mastered(self, rate: Floats) -> Floats:
        """Returns the half of the mastered new starts that has the longest episodes.

        `rate`: success rate of each start in the pool.
        """
        mastered = np.flatnonzero(rate[: self._new_count] > MAX_SUCCESS)
        lengths = self._lengths[mastered] / self._tries[mastered]
        longest = np.argsort(-lengths, kind="stable")[: (len(mastered) + 1) // 2]
        return self.pool[mastered[longest]]

    def _set_pool(self, new: Floats, old: Floats) -> None:
        pool = np.concatenate((new, old))
        self.pool = pool  # the starts of this round, [starts, bodies, 3]
        self._new_count = len(new)
        self._drawn = 0
        self._tries = np.zeros(len(pool), np.int64)
        self._wins = np.zeros(len(pool), np.int64)
        self._lengths = np.zeros(len(pool), np.int64)  # pushes in all tries

    def _random_subset(self, states: Floats, count: int) -> Floats:
        """Returns `count` of the states, or all if there are fewer, in random order."""
        return states[self._rng.permutation(len(states))[:count]]

    def _new_starts(self) -> Floats:
        """Returns at most NEW_STARTS states on random walks from `_walk_starts`.

        Returns the task's start if no visited state is usable.
        """
        states = self._walk_starts[self._rng.integers(len(self._walk_starts), size=WALKS)]
        visited = []
        for _ in range(PUSHES_PER_WALK):
            after, ok = self._simulator.push(states, self._headings(states))
            self.pushes += WALKS
            states = np.where(ok[:, None, None], after, states)
            visited.append(states[ok])
        found = np.concatenate(visited)
        within = (np.abs(found[:, 1:, :2]) <= self._task.arena).all(axis=(1, 2))
        found = self._random_subset(found[within & ~self._task.succeeded(found)], NEW_STARTS)
        return found if len(found) else self._task.start[None]

    def _headings(self, states: Floats) -> NDArray[np.int64]:
        """Draws the heading of the next push of each walk. [walks]"""
        contact = self._task.contact_headings(states, int(self._rng.integers(1 << 62)))
        anywhere = self._rng.integers(self._task.actions, size=len(states))
        return np.where(self._rng.random(len(states)) < CONTACT_SHARE, contact, anywhere)

    def state(self) -> dict[str, Any]:
        """Returns the state for a checkpoint: all that later starts depend on."""
        return {
            "rng": self._rng.bit_generator.state,
            "seeds": self._walk_starts,
            "good": self._good,
            "pool": self.pool,
            "new": self._new_count,
            "tries": self._tries,
            "wins": self._wins,
            "lengths": self._lengths,
            "first": self._first_number,
            "drawn": self._drawn,
            "pushes": self.pushes,
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Continues from state(). Raises an error if it is none."""
        self._rng.bit_generator.state = state["rng"]
        seeds, good, pool = (
            np.asarray(state[name], float).reshape(-1, self._task.bodies, 3)
            for name in ("seeds", "good", "pool")
        )
        self._walk_starts, self._good, new = seeds, good, int(state["new"])
        self._set_pool(pool[:new], pool[new:])
        self._tries, self._wins, self._lengths = (
            np.asarray(state[name], np.int64).reshape(len(pool)).copy()
            for name in ("tries", "wins", "lengths")
        )
        self._first_number, self._drawn = int(state["first"]), int(state["drawn"])
        self.pushes = int(state["pushes"])
