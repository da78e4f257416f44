"""Shared data of the learner's tests."""

import json
from typing import Any

import numpy as np
from rtg import _core, paths
from rtg.envs.training_environments import Step
from rtg.files.dataset import Transitions
from rtg.learn.replay import ReplayRules


def train_settings(**train: Any) -> _core.TrainConfig:
    """Returns what the loader makes of these values; its defaults for all others."""
    overrides = [f"train.{key}={json.dumps(value)}" for key, value in train.items()]
    text = f"task: {paths.CONFIG / 'gathering.yaml'}\nsearch: {{transitions: 1}}"
    return _core.Config.from_text(text, overrides=overrides).train


def replay_rules(**changes: Any) -> ReplayRules:
    """Returns rules by which half of a batch is offline, none of it recent, with bounds."""
    usual = {"offline_share": 0.5, "recent_share": 0.0, "discount": 0.9, "use_bounds": True}
    return ReplayRules(**{**usual, "seed": 0, **changes})


def step_to(
    after: np.ndarray, reward: Any = 0.0, truncated: Any = False, rejected: Any = False
) -> Step:
    """Makes the outcome of actions in all environments. Rewards end episodes. [N, observation]

    The observation before the next action is far from all, as no buffer stores it.
    """
    got, cut, given_up = (np.broadcast_to(x, len(after)) for x in (reward, truncated, rejected))
    return Step(after, np.float32(got), got > 0, cut, given_up, after + 100.0, episodes=[])


def random_transitions(count: int, bodies: int = 4, seed: int = 0) -> Transitions:
    """Legal arrays with random content; every fifth transition is a success."""
    rng = np.random.default_rng(seed)
    size = 2 + 6 * (bodies - 1)
    reward = (np.arange(count) % 5 == 4).astype(np.float32)
    return Transitions(
        poses=rng.normal(size=(count, bodies, 3)),
        action=rng.integers(48, size=count).astype(np.int32),
        next_poses=rng.normal(size=(count, bodies, 3)),
        reward=reward,
        terminated=reward == 1.0,
        observation=rng.normal(size=(count, size)).astype(np.float32),
        next_observation=rng.normal(size=(count, size)).astype(np.float32),
        source=rng.integers(4, size=count).astype(np.int8),
    )
