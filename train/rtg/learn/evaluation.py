"""Evaluates the greedy policy of values by episodes from held-out starts, side by side."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.engines import simulator as make_simulator
from rtg.learn.tried_actions import TriedActions

Floats = NDArray[np.float64]
# A policy takes the action of the largest value. [N, observation] -> [N, actions]
Values = Callable[[NDArray[np.float32]], NDArray[Any]]

# Seeds of the held-out starts. They exceed all seeds of runs, so no training start is among them.
HELD_OUT_SEED = 1 << 63  # for evaluations during training, which decide when to stop
# For the final result: no decision depends on these starts, neither when to stop nor the choice of
# a setting.
FINAL_SEED = HELD_OUT_SEED + 2
FINAL_FACTOR = 10  # number of final episodes per episode of an evaluation during training


class Evaluation(NamedTuple):
    """The results of episodes of a policy, one per start."""

    success: NDArray[np.bool_]  # [N]
    length: NDArray[np.int64]  # [N], number of actions; the horizon if time ran out
    discounted: NDArray[np.float64]  # [N], γ^(length - 1) after a success, else 0
    paths: list[Floats]  # per episode [length + 1, bodies, 3]

    def best(self) -> int:
        """Returns the index of the first of the shortest successful episodes; 0 without any."""
        return int(np.argmin(np.where(self.success, self.length, np.iinfo(np.int64).max)))

    def summary(self) -> dict[str, float]:
        """Returns the means over the episodes, by their names in summary.json."""
        return {
            "success_rate": float(self.success.mean()),
            "episode_length_mean": float(self.length.mean()),
            "episode_return_mean": float(self.discounted.mean()),
        }


def held_out_starts(config: _core.Config, number: int = 0) -> Floats:
    """Returns the starts of an evaluation, the same for every run. [episodes, bodies, 3]

    There is one for each of the `train.eval_episodes`. They are those of evaluation `number`: a
    policy that is lucky in one is not so in the next.
    """
    count = config.train.eval_episodes
    return _starts(config, HELD_OUT_SEED, range(number * count, (number + 1) * count))


def final_starts(config: _core.Config, episodes: int) -> Floats:
    """Returns the first starts of the final evaluation of every run. [episodes, bodies, 3]"""
    return _starts(config, FINAL_SEED, range(episodes))


def _starts(config: _core.Config, seed: int, of_stream: range) -> Floats:
    amplitude = config.evaluation_jitter
    return np.stack([config.task.jittered_start(amplitude, seed, k) for k in of_stream])


def _greedy_actions(
    config: _core.Config, tried: TriedActions, seen: NDArray[np.float32], values: NDArray[Any]
) -> NDArray[np.int64]:
    if not config.train.leave_loops:
        return values.argmax(axis=1)
    actions = tried.best_untried(seen, values)
    tried.add(seen, actions)
    return actions


def evaluate(
    config: _core.Config,
    values: Values,
    starts: Floats,
    discount: float,
    observe: Callable[[Floats], NDArray[np.float32]] | None = None,
) -> Evaluation:
    """Simulates a greedy episode from each start, [N, bodies, 3].

    The action is that of the largest of the `values`. With `train.leave_loops` it is the best one
    that the episode has not yet tried in this state. `observe`: what the policy sees of states; the
    task's observation if None.

    An episode fails after task.horizon actions, or if the simulator cannot finish a push.
    """
    task, simulator = config.task, make_simulator(config)
    observe = observe or task.observation
    success = np.zeros(len(starts), np.bool_)
    length = np.zeros(len(starts), np.int64)
    paths = [[start] for start in starts]
    running = np.arange(len(starts))
    tried = TriedActions(len(starts), task)
    for _ in range(task.horizon):
        if not len(running):
            break
        states = np.stack([paths[k][-1] for k in running])
        seen = observe(states)
        actions = _greedy_actions(config, tried, seen, values(seen))
        after, ok = simulator.push(states, actions)
        after[~ok] = states[~ok]
        for k, state in zip(running, after, strict=True):
            paths[k].append(state)
        length[running] += 1
        success[running] = task.succeeded(after) & ok
        goes_on = ~success[running] & ok
        running = running[goes_on]
        tried.keep(goes_on)
    discounted = np.where(success, discount ** (length - 1.0), 0.0)
    return Evaluation(success, length, discounted, [np.stack(path) for path in paths])
