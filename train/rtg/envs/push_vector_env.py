"""Environments of a task side by side, as one Gymnasium vector environment."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from rtg import _core
from rtg.envs.push_env import observation_space, read_config

Bools = NDArray[np.bool_]


class PushVectorEnv(gymnasium.vector.VectorEnv[Any, Any, Any]):
    """`num_envs` environments like PushEnv, all of which one call of the core steps.

    An environment whose episode has ended begins a new one at its next step, which takes no action.
    `max_episode_steps`: if None, task.horizon with `ends_at_horizon`, else no limit. The rest is as
    in PushEnv; entries of `info` are arrays [num_envs, ...].
    """

    metadata = {"autoreset_mode": AutoresetMode.NEXT_STEP}  # noqa: RUF012  (gymnasium's own way)

    def __init__(
        self,
        num_envs: int = 1,
        config: _core.Config | str | Path = "gathering",
        settings: Sequence[str] = (),
        jitter: float | None = None,
        max_episode_steps: int | None = None,
        ends_at_horizon: bool = True,
        render_mode: str | None = None,
    ) -> None:
        if render_mode is not None:
            raise ValueError(
                f"render_mode {render_mode!r}; legal: None, or make_vec with vectorization_mode"
                "='sync'"
            )
        read = read_config(config, settings)
        self.task = read.task
        self.num_envs = num_envs
        self.jitter = self.task.start_jitter if jitter is None else jitter
        self.limit = max_episode_steps or (self.task.horizon if ends_at_horizon else math.inf)
        self.render_mode = render_mode
        self.single_observation_space = observation_space(self.task)
        self.single_action_space = spaces.Discrete(self.task.actions)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._simulator = _core.Simulator(read)
        self._poses = np.repeat(self.task.start[None], num_envs, axis=0)
        self._steps = np.zeros(num_envs, np.int64)
        self._ended = np.zeros(num_envs, np.bool_)

    def reset(
        self, *, seed: int | list[int] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begins an episode in each environment. `seed`: one for all. Knows no options."""
        if options:
            raise ValueError(f"unknown options {sorted(options)}; legal: none")
        if isinstance(seed, list):
            seed = seed[0]
        super().reset(seed=seed)
        self._begin(np.ones(self.num_envs, np.bool_))
        return self._observation(), self._info(np.zeros(self.num_envs, np.bool_))

    def step(
        self, actions: NDArray[np.int64]
    ) -> tuple[NDArray[np.float32], NDArray[np.float64], Bools, Bools, dict[str, Any]]:
        begun = self._ended.copy()
        goes_on = ~begun
        ok = np.ones(self.num_envs, np.bool_)
        if goes_on.any():
            pushes = np.asarray(actions, np.int64)[goes_on]
            after, ok[goes_on] = self._simulator.push(self._poses[goes_on], pushes)
            kept = np.where(ok[goes_on, None, None], after, self._poses[goes_on])
            self._poses[goes_on] = kept
            self._steps[goes_on] += 1
        if begun.any():
            self._begin(begun)
        info = self._info(~ok)
        success = info["is_success"] & ok & goes_on
        truncated = goes_on & ~success & ((self._steps >= self.limit) | ~ok)
        self._ended = success | truncated
        return self._observation(), success.astype(np.float64), success, truncated, info

    def _begin(self, which: Bools) -> None:
        for env in map(int, np.flatnonzero(which)):
            key = int(self.np_random.integers(2**63))
            self._poses[env] = self.task.jittered_start(self.jitter, key)
        self._steps[which] = 0
        self._ended[which] = False

    def _observation(self) -> NDArray[np.float32]:
        return self.task.observation(self._poses)

    def _info(self, rejected: Bools) -> dict[str, Any]:
        success = self.task.succeeded(self._poses)
        return {"poses": self._poses.copy(), "is_success": success, "rejected": rejected}
