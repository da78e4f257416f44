"""Lower bounds of Q* that follow from a set of simulated transitions.

The dynamics are deterministic. So if stored transitions lead from (s, a) to a success in k actions,
then Q*(s, a) ≥ γ^(k-1). Two states count as equal if their observations are bitwise equal.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]


def value_bounds(
    observation: Array,  # [N, observation] float32
    next_observation: Array,  # [N, observation] float32
    reward: Array,  # [N] float32, 1 is a success and ends the episode
    discount: float,
) -> Array:
    """Returns a lower bound of Q*(s, a) for each transition. [N] float32

    It is 0 if no chain of stored transitions leads to success.
    """
    here, there = _state_ids(observation, next_observation)
    order = np.argsort(here, kind="stable")
    first = np.flatnonzero(np.diff(here[order], prepend=-1))  # first index of each state's group
    value = np.zeros(max(here.max(), there.max()) + 1, np.float64)
    bound = reward.astype(np.float64)
    while True:
        value[here[order][first]] = np.maximum.reduceat(bound[order], first)
        better = np.maximum(reward, discount * value[there])
        if np.array_equal(better, bound):
            return bound.astype(np.float32)
        bound = better


def _state_ids(observation: Array, next_observation: Array) -> tuple[Array, Array]:
    both = np.concatenate((observation, next_observation)) + np.float32(0.0)  # -0 becomes 0
    rows = np.ascontiguousarray(both).view(np.dtype((np.void, both.shape[1] * both.itemsize)))
    ids = np.unique(rows.ravel(), return_inverse=True)[1].ravel()
    return ids[: len(observation)], ids[len(observation) :]
