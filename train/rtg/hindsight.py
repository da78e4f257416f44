"""Hindsight experience replay [Andrychowicz et al. 2017] on the atoms of the goal.

The goal of a task is a conjunction of atoms (rtg::goal_atoms). The learner is asked for a set of
them, by the task for all, and an online transition is also seen as if it had been asked for what
its episode reached later on: the paper's strategy "future" with k goals drawn per transition; the
share k / (k + 1) of a batch sees one of them. The reward is 1, and the episode over, where all
atoms asked for hold in s'.

Drawn are the sets of atoms that hold in a later state of the episode. Left out are sets that hold
in s already, the empty one among them: an episode that is asked for such a set is over before s,
so it would teach the values of states that no policy acts in. Where none is left the goal of the
task stays.

Departs from the paper: goals are sets of atoms and not positions that were reached, so an episode
in which no atom comes to hold teaches nothing in hindsight; episodes are asked for the one goal of
the task, as in the paper's section 4.3, never for others.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from rtg.replay import Infos, MixedReplayBuffer, Part, Store

Array = npt.NDArray[Any]


def future_goals(
    held: Array,  # [T, atoms] bool, of each s of an episode
    held_next: Array,  # [T, atoms] bool, of each s'
    count: int,
    discount: float,
    rng: np.random.Generator,
) -> tuple[Array, Array]:
    """For each transition `count` sets of atoms, empty where there are none, and the values that
    the episode proves: γ^n with n more actions from s' to the set.

    [T, count, atoms] bool, [T, count] float32
    """
    steps, atoms = held.shape
    goals = np.zeros((steps, count, atoms), np.bool_)
    bounds = np.zeros((steps, count), np.float32)
    for t in range(steps):
        later = held_next[t:]
        teaching = np.flatnonzero((later & ~held[t]).any(axis=1))
        if len(teaching):
            goals[t] = later[rng.choice(teaching, count)]
            reached = (later[None] | ~goals[t][:, None]).all(axis=2)  # [count, T - t]
            bounds[t] = discount ** reached.argmax(axis=1)
    return goals, bounds


class GoalStore(Store):
    """Transitions with what their episode reached."""

    columns = (*Store.columns, "held", "held_next", "goals", "goal_bounds")

    def __init__(self, capacity: int, observation_size: int, atoms: int, goals: int) -> None:
        super().__init__(capacity, observation_size)
        self.held = np.zeros((0, atoms), np.bool_)  # in s
        self.held_next = np.zeros((0, atoms), np.bool_)  # in s'
        self.goals = np.zeros((0, goals, atoms), np.bool_)  # empty until the episode is over
        self.goal_bounds = np.zeros((0, goals), np.float32)


class HindsightReplayBuffer(MixedReplayBuffer):
    """Batches whose observations end with the atoms asked for, 1 or 0 each.

    Offline transitions, and those of running episodes, are asked for the task's goal.
    """

    online: GoalStore

    def __init__(self, *of_buffer: Any, atoms: int, goals: int, **more: Any) -> None:
        super().__init__(*of_buffer, **more)
        self.atoms, self.goals = atoms, goals
        self.online = GoalStore(self.buffer_size, self.obs_shape[0], atoms, goals)

    def _more(self, infos: Infos, kept: Array) -> dict[str, Array]:
        return {
            name: np.array([infos[env][name] for env in kept], np.bool_).reshape(-1, self.atoms)
            for name in ("held", "held_next")
        }

    def _close_episode(self, env: int, success: bool) -> None:
        store, numbers = self.online, np.array(self._episodes[env], np.int64)
        super()._close_episode(env, success)
        rows = numbers[numbers >= store.written - store.capacity] % store.capacity
        store.goals[rows], store.goal_bounds[rows] = future_goals(
            store.held[rows], store.held_next[rows], self.goals, self.discount, self.rng
        )

    def _columns(self, parts: list[Part]) -> dict[str, Array]:
        columns = super()._columns(parts)
        asked = np.ones((len(columns["action"]), self.atoms), np.float32)
        for store, rows in parts:
            if store is self.online:
                self._relabel(columns, asked, rows)
        for name in ("observation", "next_observation"):
            columns[name] = np.concatenate((columns[name], asked), axis=1)
        return columns

    def _relabel(self, columns: dict[str, Array], asked: Array, rows: Array) -> None:
        """`rows`: of the online transitions, which stand last in `columns` and `asked`."""
        store, place = self.online, np.arange(len(asked) - len(rows), len(asked))
        pick = self.rng.integers(self.goals + 1, size=len(rows))  # the last: the task's goal
        goal = store.goals[rows, np.minimum(pick, self.goals - 1)]
        seen = (pick < self.goals) & goal.any(axis=1)
        place, rows, pick, goal = place[seen], rows[seen], pick[seen], goal[seen]
        asked[place] = goal
        reached = (store.held_next[rows] | ~goal).all(axis=1)
        columns["reward"][place] = columns["terminated"][place] = reached
        if self.use_bounds:
            columns["bound"][place] = store.goal_bounds[rows, pick]
