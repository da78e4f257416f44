"""Toy environments: a line to walk along to the right, and episodes that end as they are told."""

from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np
from rtg.envs.training_environments import Step

TASK = SimpleNamespace(
    strides=(1.0,),
    relative_unit=1.0,
    position_unit=4.0,
    bodies=1,  # the robot alone
    kinds=["robot"],
    fixed=[False],
    robot_entries=3,
    interchangeable=[],
    turn_periods=[0.0],
)
TIME_LIMIT = 20  # actions of an episode of the line


class Outcomes:
    """An environment of episodes of one step that end as they are told, in turn; the k-th says it
    had k steps."""

    count, observation_size, headings, strides, task = 1, 3, 8, (1.0,), TASK

    def __init__(self, successes: Sequence[bool]) -> None:
        self.left = list(enumerate(successes))

    def contact_headings(self, seed: int) -> np.ndarray:
        raise NotImplementedError("there are no objects")

    def reset(self) -> np.ndarray:
        return np.zeros((1, 3), np.float32)

    def step(self, actions: np.ndarray) -> Step:
        length, success = self.left.pop(0)
        ends = np.array([success])
        seen = self.reset()
        episodes = [(success, length)]
        return Step(seen, ends.astype(np.float32), ends, ~ends, ends & False, seen, episodes)


class Line:
    """Environments with positions 0 to 4; heading 1 goes right, every other heading stays."""

    observation_size, strides, task = 3, (1.0,), TASK

    def __init__(self, count: int = 4, headings: int = 8) -> None:
        self.count, self.headings = count, headings
        self.at, self.steps = np.zeros(count, int), np.zeros(count, int)

    def contact_headings(self, seed: int) -> np.ndarray:
        raise NotImplementedError("there are no objects")

    def _observation(self) -> np.ndarray:
        one = np.ones(self.count)
        return np.stack((self.at / 4.0, one, 0.0 * one), axis=1).astype(np.float32)

    def reset(self) -> np.ndarray:
        self.at[:] = self.steps[:] = 0
        return self._observation()

    def step(self, actions: np.ndarray) -> Step:
        self.at, self.steps = self.at + (actions == 1), self.steps + 1
        seen, success = self._observation(), self.at == 4
        truncated = ~success & (self.steps == TIME_LIMIT)
        ended = success | truncated
        episodes = [(bool(success[k]), int(self.steps[k])) for k in np.flatnonzero(ended)]
        self.at[ended] = self.steps[ended] = 0
        reward = success.astype(np.float32)
        return Step(seen, reward, success, truncated, ended & False, self._observation(), episodes)
