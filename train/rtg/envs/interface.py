"""The side of a task that an agent meets: observations, actions and goals."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from numbers import Integral
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
from gymnasium import spaces
from numpy.typing import ArrayLike, NDArray

from rtg import _core
from rtg.engines import simulator as make_simulator
from rtg.envs.layouts import Layouts
from rtg.pictures.draw import MarkLike, objects, outline, state_image

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

Observations = Literal["state", "image"]
Actions = Literal["discrete", "continuous"]
Goals = Literal["task", "drawn"]

OBSERVATION_LIMIT = 1e6  # bound of all entries; no body gets 1 km far, no unit is below 1 mm


class Variant(NamedTuple):
    """A choice among the interfaces of a task.

    - `observations`: "state", see core/tasks/task.hpp, float32 [observation]; "image", an RGB
      picture of the arena, uint8 [pixels, pixels, 3].
    - `actions`: "discrete", those of the task; "continuous", the way (x, y) of the robot in units
      of the task's longest stride, float32 [2]. Longer ways are shortened to 1.
    - `goals`: "task"; "drawn": each episode has a goal state of the task drawn for it, whose layout
      is to be reached, see rtg.envs.layouts. Observations are then dictionaries of "observation",
      "achieved_goal" and "desired_goal".
    """

    observations: Observations = "state"
    actions: Actions = "discrete"
    goals: Goals = "task"
    pixels: int = 96

    def check(self) -> None:
        """Raises ValueError for values that are not legal."""
        legal = {"observations": Observations, "actions": Actions, "goals": Goals}
        for name, kind in legal.items():
            if getattr(self, name) not in get_args(kind):
                words = ", ".join(repr(word) for word in get_args(kind))
                raise ValueError(f"{name} {getattr(self, name)!r}; legal: {words}")
        if not (isinstance(self.pixels, Integral) and 8 <= self.pixels <= 2048):
            raise ValueError(f"pixels {self.pixels!r}; legal: 8 to 2048")


def variant_of(made: Callable[..., Any], given: Mapping[str, Any]) -> Variant:
    """Returns the variant that the further keywords of the environment `made` ask for.

    Raises ValueError for unknown ones.
    """
    if unknown := sorted(given.keys() - set(Variant._fields)):
        own = [name for name in inspect.signature(made).parameters if name != "variant"]
        legal = ", ".join([*own, *Variant._fields])
        raise ValueError(f"unknown keywords {unknown}; legal: {legal}")
    return Variant(**given)


class _Outline(NamedTuple):
    """A mark of a drawn goal: where a body is to lie."""

    kind: str
    ring: Floats  # [vertices, 2]
    target: bool = True
    negated: bool = False


class Interface:
    """The interface of a task in one variant. Holds no state of an episode."""

    def __init__(self, config: _core.Config, variant: Variant) -> None:
        variant.check()
        self.task = config.task
        self.variant = variant
        self._simulator = make_simulator(config)
        self._layouts = Layouts(self.task) if variant.goals == "drawn" else None
        self.action_space = self._action_space()
        self.observation_space = self._observation_space()

    @property
    def draws_goals(self) -> bool:
        """Returns whether each episode has a goal of its own."""
        return self._layouts is not None

    def checked_actions(self, actions: Any, count: int) -> NDArray[Any]:
        """Returns actions of `count` states for push(), [count] int64 or [count, 2] float64.

        Raises ValueError for actions that are not legal.
        """
        given = np.asarray(actions)
        if self.variant.actions == "discrete":
            legal = f"integers from 0 to {self.task.actions - 1}"
            is_right = given.shape == (count,) and given.dtype.kind in "iu"
            if not is_right or not ((given >= 0) & (given < self.task.actions)).all():
                raise ValueError(f"action {_words(actions)}; legal: {legal}")
            return given.astype(np.int64)
        is_right = given.shape == (count, 2) and given.dtype.kind in "iuf"
        if not is_right or not (np.abs(given) <= 1.0).all():
            raise ValueError(f"action {_words(actions)}; legal: two numbers from -1 to 1")
        return given.astype(np.float64)

    def push(self, states: Floats, actions: NDArray[Any]) -> tuple[Floats, Bools]:
        """Simulates an action, one of checked_actions(), in each state.

        Returns the states afterwards, and whether the simulator could finish each push; states of
        others are unchanged. A way of length 0 leaves the state as it is. [N, bodies, 3], [N, ...]
        """
        if self.variant.actions == "discrete":
            after, ok = self._simulator.push(states, actions)
        else:
            after, ok = self._pushed_along(states, actions)
        return np.where(ok[:, None, None], after, states), ok

    def drawn_goal(self, key: int) -> Floats:
        """Returns the goal state of an episode, which `key` determines. [bodies, 3]

        Returns the start of the task where goals are those of the task. Raises ValueError if 1,000
        attempts find no goal state.
        """
        if self._layouts is None:
            return self.task.start
        state = self.task.goal_state(key)
        if state is None:
            raise ValueError(f"no goal state of '{self.task.name}' was found in 1,000 attempts")
        return state

    def succeeded(self, states: Floats, goals: Floats) -> Bools:
        """Returns in which states the goal is reached. [N, bodies, 3] each -> [N]"""
        if self._layouts is None:
            return self.task.succeeded(states)
        near: Bools = self._layouts.near(self._layout(states), self._layout(goals))
        return near

    def compute_reward(
        self, achieved_goal: ArrayLike, desired_goal: ArrayLike, info: Any = None
    ) -> Any:
        """Returns 1 where layouts agree within the tolerances, else 0; for drawn goals alone.

        [..., size] each -> [...]; `info` is not used.
        """
        assert self._layouts is not None
        near = self._layouts.near(np.asarray(achieved_goal), np.asarray(desired_goal))
        return near.astype(np.float64) if near.ndim else float(near)

    def seen(self, states: Floats, goals: Floats) -> tuple[Any, Bools]:
        """Returns what an agent sees of states with their goal states. [N, bodies, 3] each

        It is an array [N, ...] or a dictionary of such; and in which states the goal is reached, as
        succeeded() tells.
        """
        entries = self.task.observation(states)
        if self._layouts is None:
            success = self.task.succeeded(states)
            return self._shown(entries, states, goals, success), success
        achieved, desired = self._layouts.of(entries), self._layout(goals)
        success = self._layouts.near(achieved, desired)
        observation = {
            "observation": self._shown(entries, states, goals, success),
            "achieved_goal": achieved,
            "desired_goal": desired,
        }
        return observation, success

    def _shown(
        self, entries: NDArray[np.float32], states: Floats, goals: Floats, success: Bools
    ) -> NDArray[Any]:
        """Returns the observations of states, whose `entries` are known; or pictures of them."""
        if self.variant.observations == "state":
            return entries
        frames = [
            self.image(state[None], goal, self.variant.pixels, bool(reached))
            for state, goal, reached in zip(states, goals, success, strict=True)
        ]
        return np.stack(frames)

    def image(
        self, path: Floats, goal: Floats, pixels: int, reached: bool, caption: str = ""
    ) -> NDArray[np.uint8]:
        """Draws the last of some states, the way of the robot there, and the goal.

        `reached`: whether the goal is. [T, bodies, 3], [bodies, 3] -> [pixels, pixels, 3]
        """
        return state_image(
            self.task,
            path,
            pixels=pixels,
            caption=caption,
            reached=reached,
            marks=None if self._layouts is None else self._outlines(goal),
        )

    def _outlines(self, goal: Floats) -> list[MarkLike]:
        task = self.task
        return [
            _Outline(task.kinds[body], outline(task.outlines[body][0], goal[body]))
            for body in objects(task)
        ]

    def _layout(self, states: Floats) -> NDArray[np.float32]:
        assert self._layouts is not None
        layout: NDArray[np.float32] = self._layouts.of(self.task.observation(states))
        return layout

    def _pushed_along(self, states: Floats, ways: Floats) -> tuple[Floats, Bools]:
        lengths = np.linalg.norm(ways, axis=1)
        longest = 2.0 * self.task.relative_unit
        ways = longest * ways / np.maximum(lengths, 1.0)[:, None]
        after, ok, moves = states.copy(), np.ones(len(states), np.bool_), lengths > 0.0
        if moves.any():
            after[moves], ok[moves] = self._simulator.push_along(states[moves], ways[moves])
        return after, ok

    def _action_space(self) -> spaces.Space[Any]:
        if self.variant.actions == "discrete":
            return spaces.Discrete(self.task.actions)
        return spaces.Box(-1.0, 1.0, (2,), np.float32)

    def _observation_space(self) -> spaces.Space[Any]:
        side = self.variant.pixels
        seen = (
            spaces.Box(0, 255, (side, side, 3), np.uint8)
            if self.variant.observations == "image"
            else _unbounded(self.task.observation_size)
        )
        if self._layouts is None:
            return seen
        layout = _unbounded(self._layouts.size)
        return spaces.Dict({"observation": seen, "achieved_goal": layout, "desired_goal": layout})


def _words(actions: Any) -> str:
    """Returns actions in words, a single one without brackets."""
    is_single = isinstance(actions, list) and len(actions) == 1
    return str(actions[0] if is_single else actions)


def _unbounded(size: int) -> spaces.Box:
    return spaces.Box(-OBSERVATION_LIMIT, OBSERVATION_LIMIT, (size,), np.float32)
