"""Environments of a task side by side, as one Gymnasium vector environment."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from rtg import _core
from rtg.arguments import checked
from rtg.envs.interface import Interface, variant_of
from rtg.envs.push_env import RENDERED_PIXELS, check_render_mode, checked_jitter
from rtg.task_config import read_config

Bools = NDArray[np.bool_]


class PushVectorEnv(gymnasium.vector.VectorEnv[Any, Any, Any]):
    """`num_envs` environments like PushEnv, all of which one call of the core steps.

    An environment whose episode has ended begins a new one at its next step, which takes no action.
    `max_episode_steps`: an episode is truncated after so many, as by `gymnasium.make`; with
    `ends_at_horizon` after task.horizon at the latest. The rest is as in PushEnv; entries of
    observations and of `info` are arrays [num_envs, ...].
    """

    metadata = {  # noqa: RUF012  (gymnasium's own way)
        "autoreset_mode": AutoresetMode.NEXT_STEP,
        "render_modes": ["rgb_array"],
        "render_fps": 4,
    }

    @checked
    def __init__(
        self,
        num_envs: int = 1,
        config: _core.Config | str | Path | None = "gathering",
        settings: Sequence[str] = (),
        jitter: float | None = None,
        max_episode_steps: int | None = None,
        ends_at_horizon: bool = True,
        render_mode: str | None = None,
        **variant: Any,
    ) -> None:
        check_render_mode(render_mode, self.metadata["render_modes"])
        if num_envs < 1:
            raise ValueError(f"num_envs {num_envs}; legal: at least 1")
        read = read_config(config, settings)
        self.interface = Interface(read, variant_of(PushVectorEnv, variant))
        self.task = read.task
        self.num_envs = num_envs
        self.jitter = checked_jitter(read, jitter)
        if max_episode_steps is not None and max_episode_steps < 1:
            raise ValueError(f"max_episode_steps {max_episode_steps}; legal: at least 1")
        self.limit = min(
            max_episode_steps or math.inf, self.task.horizon if ends_at_horizon else math.inf
        )
        self.render_mode = render_mode
        self.single_observation_space = self.interface.observation_space
        self.single_action_space = self.interface.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._poses = np.repeat(self.task.start[None], num_envs, axis=0)
        self._goals = self._poses.copy()  # goal states, see Interface.drawn_goal()
        self._steps = np.zeros(num_envs, np.int64)
        self._ended = np.zeros(num_envs, np.bool_)
        if self.interface.draws_goals:
            self.compute_reward = self.interface.compute_reward

    def reset(
        self, *, seed: int | list[int] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begins an episode in each environment. `seed`: one for all. Knows no options.

        Raises ValueError for options, and for a list of seeds.
        """
        if options:
            raise ValueError(f"unknown options {sorted(options)}; legal: none")
        if isinstance(seed, list):
            raise ValueError("seed is a list; legal: one number for all environments")
        super().reset(seed=seed)
        self.begin(np.ones(self.num_envs, np.bool_))
        return self._seen(np.zeros(self.num_envs, np.bool_))

    def step(
        self, actions: NDArray[Any]
    ) -> tuple[Any, NDArray[np.float64], Bools, Bools, dict[str, Any]]:
        actions = self.interface.checked_actions(actions, self.num_envs)
        begun = self._ended.copy()
        goes_on = ~begun
        ok = np.ones(self.num_envs, np.bool_)
        if goes_on.any():
            pushed = self.interface.push(self._poses[goes_on], actions[goes_on])
            self._poses[goes_on], ok[goes_on] = pushed
            self._steps[goes_on] += 1
        if begun.any():
            self.begin(begun)
        observation, info = self._seen(~ok)
        success = info["is_success"] & ok & goes_on
        truncated = goes_on & ~success & ((self._steps >= self.limit) | ~ok)
        self._ended = success | truncated
        return observation, success.astype(np.float64), success, truncated, info

    def begin(self, which: Bools) -> None:
        """Begins an episode at once in some environments, [num_envs]."""
        for env in map(int, np.flatnonzero(which)):
            key = int(self.np_random.integers(2**63))
            self._poses[env] = self.task.jittered_start(self.jitter, key)
            if self.interface.draws_goals:
                self._goals[env] = self.interface.drawn_goal(int(self.np_random.integers(2**63)))
        self._steps[which] = 0
        self._ended[which] = False

    def observation(self) -> Any:
        """Returns the observations of the current states. [num_envs, ...]"""
        return self.interface.seen(self._poses, self._goals)[0]

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """Returns a picture of each environment [pixels, pixels, 3], in the mode "rgb_array"."""
        if self.render_mode is None:
            return None
        success = self.interface.succeeded(self._poses, self._goals)
        parts = zip(self._poses, self._goals, success, self._steps, strict=True)
        return tuple(
            self.interface.image(state[None], goal, RENDERED_PIXELS, bool(reached), f"{steps}")
            for state, goal, reached, steps in parts
        )

    def _seen(self, rejected: Bools) -> tuple[Any, dict[str, Any]]:
        """Returns the observations of the current states, and their info."""
        seen, success = self.interface.seen(self._poses, self._goals)
        return seen, {"poses": self._poses.copy(), "is_success": success, "rejected": rejected}
