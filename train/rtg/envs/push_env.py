"""A task as a Gymnasium environment, for other learners, notebooks and pictures."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from rtg import _core, paths
from rtg.pictures.draw import state_image

Floats = NDArray[np.float64]

OBSERVATION_LIMIT = 1e6  # bound of all entries; no body gets 1 km far, no unit is below 1 mm


def observation_space(task: _core.Task) -> spaces.Box:
    """Returns the space of observations, see core/tasks/task.hpp. float32 [observation]"""
    return spaces.Box(-OBSERVATION_LIMIT, OBSERVATION_LIMIT, (task.observation_size,), np.float32)


def read_config(config: _core.Config | str | Path, settings: Sequence[str] = ()) -> _core.Config:
    """Returns the configuration that is meant: itself, or that of a task's name or file.

    Raises ValueError for a bad file or setting.
    """
    if isinstance(config, _core.Config):
        return config
    own = paths.CONFIG / f"{config}.yaml"
    file = own if isinstance(config, str) and own.is_file() else config
    return _core.Config.from_file(file, list(settings))


def checked_state(task: _core.Task, poses: Any) -> Floats:
    """Returns `poses` as a state of the task. [bodies, 3]

    Raises ValueError for another shape, for numbers that are not finite, for bodies that overlap or
    are farther out than twice the arena, and for fixed bodies that are not in their places.
    """
    state = np.array(poses, np.float64)
    if state.shape != task.start.shape:
        raise ValueError(f"poses of shape {list(state.shape)}; legal: {list(task.start.shape)}")
    if not task.is_legal(state[None])[0]:
        raise ValueError(
            "poses are no state of the task; legal: finite numbers, no bodies that overlap, none "
            "out of twice the arena, fixed bodies in their places"
        )
    return state


class PushEnv(gymnasium.Env[Any, Any]):
    """The environment of a task in which a robot pushes objects until the goal holds.

    Action a moves the robot along 2πa/headings, by the stride a // headings of the task. The
    reward is 1 when the goal holds, else 0. Success ends the episode. The seed determines all
    random numbers.

    - `config`: the name of a task, its file, or its configuration.
    - `settings`: further ones, each "section.key=value".
    - `jitter`: largest random offset of an object's x and y at the start, in units
      of the task (Task.metre); the task's if None.
    - `ends_at_horizon`: an episode is truncated after task.horizon actions. Else it has no limit of
      its own, for `gymnasium.make`, which limits it to `max_episode_steps`.
    - `info` has the keys "poses" [bodies, 3], "is_success" and "rejected".

    "rejected" means that the simulator could not finish the push. The episode is then truncated and
    the state is unchanged.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 4}  # noqa: RUF012  (gymnasium's own way)

    def __init__(
        self,
        config: _core.Config | str | Path = "gathering",
        settings: Sequence[str] = (),
        jitter: float | None = None,
        ends_at_horizon: bool = True,
        render_mode: str | None = None,
    ) -> None:
        read = read_config(config, settings)
        self.task = read.task
        self.jitter = self.task.start_jitter if jitter is None else jitter
        self.ends_at_horizon = ends_at_horizon
        self.render_mode = render_mode
        self.observation_space = observation_space(self.task)
        self.action_space = spaces.Discrete(self.task.actions)
        self._simulator = _core.Simulator(read)
        self._path: list[Floats] = [self.task.start]  # states of the current episode
        self._steps = 0  # actions of the current episode

    @property
    def poses(self) -> Floats:
        """The current state. [bodies, 3]"""
        return self._path[-1]

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begins an episode. Raises ValueError for unknown options and illegal poses.

        `options`: "poses", the start [bodies, 3]; "jitter", which replaces self.jitter. Both
        are in units of the task.
        """
        super().reset(seed=seed)
        options = options or {}
        unknown = set(options) - {"poses", "jitter"}
        if unknown:
            raise ValueError(f"unknown options {sorted(unknown)}; legal: 'poses', 'jitter'")
        key = int(self.np_random.integers(2**63))
        if (start := options.get("poses")) is not None:
            self._path = [checked_state(self.task, start)]
        else:
            jitter = float(options.get("jitter", self.jitter))
            self._path = [self.task.jittered_start(jitter, key)]
        self._steps = 0
        return self._observation(), self._info(rejected=False)

    def step(
        self, action: np.int64 | int
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        if not self.action_space.contains(action):
            raise ValueError(f"action {action}; legal: integers from 0 to {self.task.actions - 1}")
        after, ok = self._simulator.push(self.poses[None], np.array([action], np.int64))
        self._path.append(after[0] if ok[0] else self.poses)
        self._steps += 1
        info = self._info(rejected=not ok[0])
        success = bool(ok[0]) and info["is_success"]
        truncated = not success and (self._is_out_of_time() or not ok[0])
        return self._observation(), float(success), success, bool(truncated), info

    def get_state(self) -> dict[str, Any]:
        """Returns the state of the episode, for set_state(): "poses" [bodies, 3] and "steps"."""
        return {"poses": self.poses.copy(), "steps": self._steps}

    def set_state(self, state: dict[str, Any]) -> NDArray[np.float32]:
        """Goes on from a state of get_state(), to the bit, and returns its observation.

        Raises ValueError for poses that are not legal. A wrapper that counts steps, as
        `gymnasium.make` adds one, keeps its own count.
        """
        self._path = [checked_state(self.task, state["poses"])]
        self._steps = int(state["steps"])
        return self._observation()

    def render(self) -> NDArray[np.uint8] | None:
        if self.render_mode != "rgb_array":
            return None
        way = np.array(self._path)
        way[:-1, 1:] = self.poses[1:]  # shows the objects only at their current poses
        reached = bool(self.task.succeeded(self.poses[None])[0])
        return state_image(self.task, way, caption=f"{self._steps}", reached=reached)

    def _is_out_of_time(self) -> bool:
        return self.ends_at_horizon and self._steps >= self.task.horizon

    def _info(self, rejected: bool) -> dict[str, Any]:
        success = bool(self.task.succeeded(self.poses[None])[0])
        return {"poses": self.poses.copy(), "is_success": success, "rejected": rejected}

    def _observation(self) -> NDArray[np.float32]:
        return self.task.observation(self.poses[None])[0]
