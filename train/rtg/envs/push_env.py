"""A task as a Gymnasium environment, for other learners, notebooks and pictures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from rtg import _core, paths
from rtg.pictures.draw import state_image

OBSERVATION_LIMIT = 1e6  # bound of all entries; no body gets 1 km far, no unit is below 1 mm


def observation_space(task: _core.Task) -> spaces.Box:
    """Returns the space of observations, see core/tasks/task.hpp. float32 [observation]"""
    return spaces.Box(-OBSERVATION_LIMIT, OBSERVATION_LIMIT, (task.observation_size,), np.float32)


class PushEnv(gymnasium.Env[Any, Any]):
    """The environment of a task in which a robot pushes objects until the goal holds.

    Action a moves the robot along 2πa/headings, by the stride a // headings of the task. The
    reward is 1 when the goal holds, else 0. Success ends the episode. An episode is truncated after
    task.horizon actions. The seed determines all random numbers.

    - `config`: the configuration with the task and the physics, or its file; Gathering's if None.
    - `jitter`: largest random offset of an object's x and y at the start, in units
      of the task (Task.metre); the task's if None.
    - `info` has the keys "poses" [bodies, 3], "is_success" and "rejected".

    "rejected" means that the simulator could not finish the push. The episode is then truncated and
    the state is unchanged.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 4}  # noqa: RUF012  (gymnasium's own way)

    def __init__(
        self,
        config: _core.Config | str | Path | None = None,
        jitter: float | None = None,
        render_mode: str | None = None,
    ) -> None:
        if not isinstance(config, _core.Config):
            config = _core.Config.from_file(config or paths.CONFIG / "gathering.yaml")
        self.task = config.task
        self.jitter = self.task.start_jitter if jitter is None else jitter
        self.render_mode = render_mode
        self.observation_space = observation_space(self.task)
        self.action_space = spaces.Discrete(self.task.actions)
        self._simulator = _core.Simulator(config)
        self._path: list[NDArray[np.float64]] = [self.task.start]  # states of the current episode

    @property
    def poses(self) -> NDArray[np.float64]:
        """The current state. [bodies, 3]"""
        return self._path[-1]

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begins an episode. Raises ValueError for unknown options.

        `options`: "poses", the start [bodies, 3]; "jitter", which replaces self.jitter. Both
        are in units of the task.
        """
        super().reset(seed=seed)
        options = options or {}
        unknown = set(options) - {"poses", "jitter"}
        if unknown:
            raise ValueError(f"unknown options {sorted(unknown)}; legal: 'poses', 'jitter'")
        key = int(self.np_random.integers(2**63))
        start = options.get("poses")
        if start is None:
            start = self.task.jittered_start(float(options.get("jitter", self.jitter)), key)
        self._path = [np.array(start, np.float64)]
        return self._observation(), {"poses": self.poses.copy()}

    def step(
        self, action: np.int64 | int
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        if not self.action_space.contains(action):
            raise ValueError(f"action {action}; legal: integers from 0 to {self.task.actions - 1}")
        after, ok = self._simulator.push(self.poses[None], np.array([action], np.int64))
        self._path.append(after[0] if ok[0] else self.poses)
        success = bool(ok[0]) and bool(self.task.succeeded(self.poses[None])[0])
        truncated = not success and (len(self._path) > self.task.horizon or not ok[0])
        info = {"poses": self.poses.copy(), "is_success": success, "rejected": not ok[0]}
        return self._observation(), float(success), success, bool(truncated), info

    def render(self) -> NDArray[np.uint8] | None:
        if self.render_mode != "rgb_array":
            return None
        way = np.array(self._path)
        way[:-1, 1:] = self.poses[1:]  # shows the objects only at their current poses
        reached = bool(self.task.succeeded(self.poses[None])[0])
        return state_image(self.task, way, caption=f"{len(way) - 1}", reached=reached)

    def _observation(self) -> NDArray[np.float32]:
        return self.task.observation(self.poses[None])[0]
