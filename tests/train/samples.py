"""Shared data of the learner's tests."""

import numpy as np
from rtg.dataset import Transitions


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
