"""How good a policy is: episodes from held-out starts, all side by side."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rtg import _core

Floats = NDArray[np.float64]
Policy = Callable[[NDArray[np.float32]], NDArray[Any]]  # [N, observation] -> [N] actions

# Seeds of runs are smaller, so no training start is among these.
HELD_OUT = 1 << 63  # what training is watched, and stopped, with
FINAL = HELD_OUT + 1  # what the result is measured with: nothing was chosen by these


class Evaluation(NamedTuple):
    """Episodes of a policy, one per start."""

    success: NDArray[np.bool_]  # [N]
    length: NDArray[np.int64]  # [N], actions; the horizon where time ran out
    discounted: NDArray[np.float64]  # [N], γ^(length - 1) of a success, else 0
    paths: list[Floats]  # per episode [length + 1, bodies, 3]

    def best(self) -> int:
        """The first among the shortest successes; without any, the first among the longest."""
        return int(np.argmin(np.where(self.success, self.length, 10**9 - self.length)))

    def summary(self) -> dict[str, float]:
        """The means under the names of summary.json."""
        return {
            "success_rate": float(self.success.mean()),
            "episode_length_mean": float(self.length.mean()),
            "episode_return_mean": float(self.discounted.mean()),
        }


def held_out_starts(
    task: _core.Task, count: int, seed: int = HELD_OUT, randomise: bool = False
) -> Floats:
    """The same for every run: objects moved by ± task.start_jitter, or ± task.randomisation if
    `randomise`. [count, bodies, 3]"""
    amplitude = task.randomisation if randomise else task.start_jitter
    return np.stack([task.jittered_start(amplitude, seed, k) for k in range(count)])


def evaluate(config: _core.Config, policy: Policy, starts: Floats, discount: float) -> Evaluation:
    """Plays an episode from each start, up to task.horizon actions. starts [N, bodies, 3]

    An episode in which the simulator gives up a push ends there as a failure.
    """
    task, simulator = config.task, _core.Simulator(config)
    success = np.zeros(len(starts), np.bool_)
    length = np.zeros(len(starts), np.int64)
    paths = [[start] for start in starts]
    running = np.arange(len(starts))
    for _ in range(task.horizon):
        if not len(running):
            break
        states = np.stack([paths[k][-1] for k in running])
        actions = np.asarray(policy(task.observation(states)), np.int64)
        after, ok = simulator.push(states, actions)
        after[~ok] = states[~ok]
        for k, state in zip(running, after, strict=True):
            paths[k].append(state)
        length[running] += 1
        success[running] = task.succeeded(after) & ok
        running = running[~success[running] & ok]
    discounted = np.where(success, discount ** (length - 1.0), 0.0)
    return Evaluation(success, length, discounted, [np.stack(path) for path in paths])
