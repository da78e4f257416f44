"""The environments of the learner. One call of the C++ core steps all of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray
from stable_baselines3.common.vec_env import VecEnv

from rtg import _core
from rtg.envs.curriculum import NOT_FROM_CURRICULUM, Curriculum
from rtg.envs.push_env import observation_space


class PushVecEnv(VecEnv):
    """A vector of `count` environments like PushEnv, for Stable-Baselines3 (SB3).

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
        self.render_mode = None
        self.task = task = config.task
        super().__init__(count, observation_space(task), spaces.Discrete(task.headings))
        self._simulator = _core.Simulator(config)
        self._jitter, self._seed = jitter, seed
        self.curriculum = curriculum
        # Number in the curriculum of the start of each current episode.
        self._start_numbers = [NOT_FROM_CURRICULUM] * count
        self._starts = 0  # number of starts so far that are not from the curriculum
        self.successes = 0  # number of successful episodes
        self._poses = np.zeros((count, task.bodies, 3))  # [count, bodies, 3]
        self._steps = np.zeros(count, np.int64)  # number of actions in the current episodes
        self._actions = np.zeros(count, np.int64)

    def reset(self) -> NDArray[np.float32]:
        for env in range(self.num_envs):
            self._begin(env)
        return self.task.observation(self._poses)

    def step_async(self, actions: NDArray[Any]) -> None:
        self._actions = np.asarray(actions, np.int64)

    def step_wait(self) -> Any:
        after, ok = self._simulator.push(self._poses, self._actions)
        after[~ok] = self._poses[~ok]
        self._poses, self._steps = after, self._steps + 1
        success = self.task.succeeded(after) & ok
        self.successes += int(success.sum())
        timeout = ~success & ((self._steps >= self.task.horizon) | ~ok)
        observation = self.task.observation(after)
        infos: list[dict[str, Any]] = [
            {"TimeLimit.truncated": bool(timeout[env]), "rejected": not ok[env]}
            for env in range(self.num_envs)
        ]
        done = success | timeout
        if done.any():
            for env in map(int, np.flatnonzero(done)):
                infos[env]["terminal_observation"] = observation[env]
                # Only episodes from the task's own starts count, as in evaluations.
                if self._start_numbers[env] == NOT_FROM_CURRICULUM:
                    infos[env]["is_success"] = bool(success[env])
                    infos[env]["episode"] = {"r": float(success[env]), "l": int(self._steps[env])}
                if self.curriculum:
                    self.curriculum.record_episode(
                        self._start_numbers[env], bool(success[env]), int(self._steps[env])
                    )
                self._begin(env)
            observation = self.task.observation(self._poses)
        return observation, success.astype(np.float32), done, infos

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
        self._poses = np.asarray(state["poses"]).copy()
        self._steps = np.asarray(state["steps"]).copy()
        self._starts = state["starts"]
        self.successes = state["successes"]
        self._start_numbers = list(state["origins"])
        if self.curriculum:
            self.curriculum.restore(state["curriculum"])

    # The remaining methods of VecEnv.

    def close(self) -> None:
        pass

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        return [getattr(self, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        raise NotImplementedError("the environments share their attributes")

    def env_method(
        self, method_name: str, *args: Any, indices: Any = None, **kwargs: Any
    ) -> list[Any]:
        raise NotImplementedError("the environments are no objects of their own")

    def env_is_wrapped(self, wrapper_class: type, indices: Any = None) -> list[bool]:
        return [False] * len(list(self._get_indices(indices)))

    def seed(self, seed: int | None = None) -> Sequence[int | None]:
        """Does nothing: the seed is fixed at construction."""
        return [None] * self.num_envs
