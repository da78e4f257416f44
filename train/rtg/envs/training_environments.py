"""The environments of the learner. One call of the C++ core steps all of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.engines import simulator as make_simulator
from rtg.envs.curriculum import NOT_FROM_CURRICULUM, Curriculum

Bools = NDArray[np.bool_]
Observations = NDArray[np.float32]  # [environments, observation]


class Step(NamedTuple):
    """The outcome of one action in each environment. [environments] each, but for observations."""

    next_observation: Observations  # after the action
    reward: NDArray[np.float32]
    terminated: Bools  # success
    truncated: Bools  # the horizon is reached, or the push was rejected
    rejected: Bools  # the simulator could not finish the push
    observation: Observations  # before the next action, which may belong to a new episode
    # Success and length of the episodes that ended, without those from starts of a curriculum.
    episodes: list[tuple[bool, int]]


def _of_shape(known: NDArray[Any], found: Any) -> NDArray[Any]:
    """Returns a copy of `found` with the type of `known`. Raises ValueError for another shape."""
    array = np.asarray(found, known.dtype).copy()
    if array.shape != known.shape:
        raise ValueError(f"shape {list(array.shape)}, not {list(known.shape)}")
    return array


class TrainingEnvironments:
    """A vector of `count` environments like PushEnv.

    A finished environment begins a new episode at once. The k-th episode of all environments begins
    at start k of random stream `seed`. The count k leaves out episodes that begin at starts of the
    `curriculum`.
    """

    def __init__(
        self,
        config: _core.Config,
        count: int,
        jitter: float,
        seed: int,
        curriculum: Curriculum | None = None,
    ) -> None:
        self.task = task = config.task
        self.count = count
        self.observation_size = task.observation_size
        self.headings = task.headings
        self.strides: Sequence[float] = task.strides
        self._simulator = make_simulator(config)
        self._jitter, self._seed = jitter, seed
        self.curriculum = curriculum
        # Number in the curriculum of the start of each current episode.
        self._start_numbers = [NOT_FROM_CURRICULUM] * count
        self._starts = 0  # number of starts so far that are not from the curriculum
        self.successes = 0  # number of successful episodes
        self._poses = np.zeros((count, task.bodies, 3))  # [count, bodies, 3]
        self._steps = np.zeros(count, np.int64)  # number of actions in the current episodes

    def reset(self) -> Observations:
        """Begins an episode in each environment and returns the observations."""
        for env in range(self.count):
            self._begin(env)
        return self.task.observation(self._poses)

    def step(self, actions: NDArray[Any]) -> Step:
        """Performs an action in each environment. actions [environments] int"""
        after, ok = self._simulator.push(self._poses, np.asarray(actions, np.int64))
        after[~ok] = self._poses[~ok]
        self._poses, self._steps = after, self._steps + 1
        success = self.task.succeeded(after) & ok
        self.successes += int(success.sum())
        truncated = ~success & ((self._steps >= self.task.horizon) | ~ok)
        seen = following = self.task.observation(after)
        episodes = []
        ended = np.flatnonzero(success | truncated)
        for env in map(int, ended):
            number, length = self._start_numbers[env], int(self._steps[env])
            # Only episodes from the task's own starts count, as in evaluations.
            if number == NOT_FROM_CURRICULUM:
                episodes.append((bool(success[env]), length))
            if self.curriculum:
                self.curriculum.record_episode(number, bool(success[env]), length)
            self._begin(env)
        if len(ended):
            following = self.task.observation(self._poses)
        reward = success.astype(np.float32)
        return Step(seen, reward, success, truncated, ~ok, following, episodes)

    def contact_headings(self, seed: int) -> NDArray[np.int64]:
        """Draws, for each environment, a heading towards a random object. [count]"""
        return self.task.contact_headings(self._poses, seed)

    def _begin(self, env: int) -> None:
        self._start_numbers[env], start = (
            self.curriculum.draw() if self.curriculum else (NOT_FROM_CURRICULUM, None)
        )
        if start is None:
            start = self.task.jittered_start(self._jitter, self._seed, self._starts)
            self._starts += 1
        self._poses[env] = start
        self._steps[env] = 0

    def state(self) -> dict[str, Any]:
        """Returns the state for a checkpoint: all that later steps depend on."""
        return {
            "poses": self._poses.copy(),
            "steps": self._steps.copy(),
            "starts": self._starts,
            "successes": self.successes,
            "origins": list(self._start_numbers),
            "curriculum": self.curriculum.state() if self.curriculum else None,
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Continues from state(). Raises an error if it is that of other environments."""
        self._poses = _of_shape(self._poses, state["poses"])
        self._steps = _of_shape(self._steps, state["steps"])
        self._starts, self.successes = int(state["starts"]), int(state["successes"])
        self._start_numbers = _of_shape(np.array(self._start_numbers), state["origins"]).tolist()
        if self.curriculum:
            self.curriculum.restore(state["curriculum"])
