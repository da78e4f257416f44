"""Toy environments: a line to walk along to the right, and episodes that end as they are told."""

from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from stable_baselines3.common.vec_env import DummyVecEnv


class Outcomes(gymnasium.Env):
    """Episodes of one step that end as they are told, in turn; the k-th says it had k steps."""

    def __init__(self, successes: Sequence[bool], actions: int = 8) -> None:
        self.observation_space = spaces.Box(-1e4, 1e4, (3,), np.float32)
        self.action_space = spaces.Discrete(actions)
        self.left = list(enumerate(successes))

    def reset(self, **kwargs: Any) -> tuple[np.ndarray, dict[str, Any]]:
        super().reset(seed=kwargs.get("seed"))
        return np.zeros(3, np.float32), {}

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        number, success = self.left.pop(0)
        told = {"is_success": success, "episode": {"r": float(success), "l": number}}
        return np.zeros(3, np.float32), float(success), success, not success, told


class Line(gymnasium.Env):
    """Positions 0 to 4; action 1 goes right, every other action stays."""

    def __init__(self, actions: int = 8) -> None:
        self.observation_space = spaces.Box(-1e4, 1e4, (3,), np.float32)
        self.action_space = spaces.Discrete(actions)
        self.at = 0

    def _observation(self) -> np.ndarray:
        return np.array([self.at / 4.0, 1.0, 0.0], np.float32)

    def reset(self, **kwargs: Any) -> tuple[np.ndarray, dict[str, Any]]:
        super().reset(seed=kwargs.get("seed"))
        self.at = 0
        return self._observation(), {}

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        self.at += int(action == 1)
        success = self.at == 4
        return self._observation(), float(success), success, False, {"is_success": success}


def line(count: int = 4, actions: int = 8) -> DummyVecEnv:
    return DummyVecEnv([lambda: gymnasium.wrappers.TimeLimit(Line(actions), 20)] * count)
