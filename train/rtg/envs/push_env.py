"""A task as a Gymnasium environment, for other learners, notebooks and pictures."""

from __future__ import annotations

from collections.abc import Sequence
from numbers import Integral
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import ArrayLike, NDArray

from rtg import _core
from rtg.arguments import checked
from rtg.envs.interface import Interface, variant_of
from rtg.envs.layouts import BODY_ENTRY_NAMES
from rtg.envs.window import Window
from rtg.pictures.draw import objects
from rtg.task_config import read_config

Floats = NDArray[np.float64]

RENDERED_PIXELS = 360  # of a side of a rendered picture


def observation_names(task: _core.Task) -> list[str]:
    """Returns the entries of an observation, in words."""
    robot = ["robot x", "robot y", "robot cos theta", "robot sin theta"]
    names = robot[: task.robot_entries]
    for body in objects(task):
        names += [f"{task.names[body]} {entry}" for entry in BODY_ENTRY_NAMES]
    for _, child, points in task.joints:
        joint = f"joint of {task.names[child]}"
        if len(points) == 1:
            names += [f"{joint} sin", f"{joint} cos"]
        elif points:
            names.append(f"{joint} slide")
    return names


def checked_jitter(config: _core.Config, jitter: float | None) -> float:
    """Returns the jitter of starts, that of the task if None, in units of the task.

    Raises ValueError if it is out of range, or leaves too few legal starts.
    """
    task = config.task
    if jitter is None:
        return task.start_jitter
    metres = float(jitter) / task.metre
    setting = f"task.start_jitter={metres!r}"
    try:
        _core.Config.from_text(config.yaml, task.name, [setting])
    except _core.ConfigError as error:
        why = str(error).removeprefix(f"--set {setting}: ")
        raise ValueError(f"jitter {jitter} ({metres:g} m): {why}") from None
    return jitter


def checked_state(task: _core.Task, poses: Any) -> Floats:
    """Returns `poses` as a state of the task. [bodies, 3]

    Raises ValueError for another shape, for numbers that are not finite, for bodies that overlap or
    are farther out than twice the arena, and for fixed bodies that are not in their places.
    """
    state = np.array(poses, np.float64)
    if state.shape != task.start.shape:
        raise ValueError(f"poses of shape {list(state.shape)}; legal: {list(task.start.shape)}")
    if defect := task.defect(state[None]):
        raise ValueError(
            f"poses are no state of the task: {defect}; legal: finite numbers in the unit of the "
            "task, which rtg.Task.inner() makes of metres; no bodies that overlap, none out of "
            "twice the arena, fixed bodies in their places"
        )
    return state


def checked_steps(steps: Any) -> int:
    """Returns the number of steps of an episode. Raises ValueError for what is none."""
    if not (isinstance(steps, Integral) and 0 <= int(steps) < 2**63):
        raise ValueError(f"steps {steps!r}; legal: a whole number from 0 to 2**63 - 1")
    return int(steps)


def check_render_mode(mode: str | None, legal: list[str]) -> None:
    """Raises ValueError for a mode that is none of the `legal` ones, nor None."""
    if mode is not None and mode not in legal:
        raise ValueError(f"render_mode {mode!r}; legal: None, {', '.join(map(repr, legal))}")


def first(observation: Any) -> Any:
    """Returns the first of the observations of Interface.seen()."""
    if isinstance(observation, dict):
        return {key: entries[0] for key, entries in observation.items()}
    return observation[0]


class PushEnv(gymnasium.Env[Any, Any]):
    """The environment of a task in which a robot pushes objects until the goal holds.

    Action a moves the robot along 2πa/headings, by the stride a // headings of the task. The
    reward is 1 when the goal is reached, else 0. Success ends the episode. The seed determines all
    random numbers.

    - `config`: the name of a task, its file, the text of one, or its configuration.
    - `settings`: further ones, each "section.key=value".
    - `jitter`: largest random offset of an object's x and y at the start, in units
      of the task (Task.metre); the task's if None.
    - `ends_at_horizon`: an episode is truncated after task.horizon actions, or before by the
      `max_episode_steps` of `gymnasium.make`. Else `max_episode_steps` is the only limit.
    - `render_mode`: "rgb_array", or "human", a window that shows each state.
    - `variant`: `observations`, `actions`, `goals` and `pixels`, see Variant.
    - `info` has the keys "poses" [bodies, 3], "is_success" and "rejected".

    "rejected" means that the simulator could not finish the push. The episode is then truncated and
    the state is unchanged.
    """

    metadata = {  # noqa: RUF012  (gymnasium's own way)
        "render_modes": ["rgb_array", "human"],
        "render_fps": 4,
    }

    @checked
    def __init__(
        self,
        config: _core.Config | str | Path | None = "gathering",
        settings: Sequence[str] = (),
        jitter: float | None = None,
        ends_at_horizon: bool = True,
        render_mode: str | None = None,
        **variant: Any,
    ) -> None:
        check_render_mode(render_mode, self.metadata["render_modes"])
        read = read_config(config, settings)
        self.interface = Interface(read, variant_of(PushEnv, variant))
        self.task = read.task
        self.jitter = checked_jitter(read, jitter)
        self.ends_at_horizon = ends_at_horizon
        self.render_mode = render_mode
        self.observation_space = self.interface.observation_space
        self.action_space = self.interface.action_space
        self._path: list[Floats] = [self.task.start]  # states of the current episode
        self._goal = self.task.start  # goal state of the episode, see Interface.drawn_goal()
        self._steps = 0  # actions of the current episode
        self._window: Window | None = None
        if self.interface.draws_goals:  # by this attribute others know that goals are drawn
            self.compute_reward = self.interface.compute_reward

    @property
    def poses(self) -> Floats:
        """The current state. [bodies, 3]"""
        return self._path[-1]

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begins an episode. Raises ValueError for unknown options and illegal poses.

        `options`: "poses", the start [bodies, 3]; "jitter", which replaces self.jitter; with
        drawn goals "goal", the state whose layout is to be reached [bodies, 3]. All are in units of
        the task, in which the robot has a radius of 0.8: rtg.Task.inner() makes them of metres.
        """
        super().reset(seed=seed)
        options = options or {}
        legal = ["poses", "jitter", *(["goal"] if self.interface.draws_goals else [])]
        if unknown := set(options) - set(legal):
            words = ", ".join(map(repr, legal))
            raise ValueError(f"unknown options {sorted(unknown)}; legal: {words}")
        key = int(self.np_random.integers(2**63))
        if (start := options.get("poses")) is not None:
            self._path = [checked_state(self.task, start)]
        else:
            jitter = float(options.get("jitter", self.jitter))
            self._path = [self.task.jittered_start(jitter, key)]
        if (goal := options.get("goal")) is not None:
            self._goal = checked_state(self.task, goal)
        elif self.interface.draws_goals:
            self._goal = self.interface.drawn_goal(int(self.np_random.integers(2**63)))
        self._steps = 0
        self._show()
        return self._seen(rejected=False)

    def step(self, action: ArrayLike) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Performs an action. Raises ValueError for one that is not legal."""
        after, ok = self.interface.push(
            self.poses[None], self.interface.checked_actions([action], 1)
        )
        self._path.append(after[0])
        self._steps += 1
        observation, info = self._seen(rejected=not ok[0])
        success = bool(ok[0]) and info["is_success"]
        truncated = not success and (self._is_out_of_time() or not ok[0])
        self._show()
        return observation, float(success), success, bool(truncated), info

    def get_state(self) -> dict[str, Any]:
        """Returns the state of the episode, for set_state().

        "poses" and "goal" [bodies, 3], and "steps".
        """
        return {"poses": self.poses.copy(), "goal": self._goal.copy(), "steps": self._steps}

    def set_state(self, state: dict[str, Any]) -> Any:
        """Goes on from a state of get_state(), to the bit, and returns its observation.

        Raises ValueError for a state that is not legal, and changes nothing then. A wrapper that
        counts steps, as `gymnasium.make` adds one, keeps its own count.
        """
        if missing := {"poses", "goal", "steps"} - state.keys():
            raise ValueError(f"state without {sorted(missing)}; legal: one of get_state()")
        poses = checked_state(self.task, state["poses"])
        goal = checked_state(self.task, state["goal"])
        self._steps = checked_steps(state["steps"])
        self._path, self._goal = [poses], goal
        return self._seen(rejected=False)[0]

    def render(self) -> NDArray[np.uint8] | None:
        """Returns the picture of the state and of the robot's way, in the mode "rgb_array"."""
        return self._picture() if self.render_mode == "rgb_array" else None

    def close(self) -> None:
        """Closes the window, if there is one."""
        if self._window:
            self._window.close()
            self._window = None

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_window": None}  # a copy opens its own

    def _picture(self) -> NDArray[np.uint8]:
        way = np.array(self._path)
        way[:-1, 1:] = self.poses[1:]  # shows the objects only at their current poses
        reached = bool(self.interface.succeeded(self.poses[None], self._goal[None])[0])
        return self.interface.image(way, self._goal, RENDERED_PIXELS, reached, f"{self._steps}")

    def _show(self) -> None:
        if self.render_mode != "human":
            return
        self._window = self._window or Window(self.task.name, RENDERED_PIXELS)
        self._window.show(self._picture(), self.metadata["render_fps"])

    def _is_out_of_time(self) -> bool:
        return self.ends_at_horizon and self._steps >= self.task.horizon

    def _seen(self, rejected: bool) -> tuple[Any, dict[str, Any]]:
        """Returns the observation of the current state, and its info."""
        seen, success = self.interface.seen(self.poses[None], self._goal[None])
        info = {"poses": self.poses.copy(), "is_success": bool(success[0]), "rejected": rejected}
        return first(seen), info
