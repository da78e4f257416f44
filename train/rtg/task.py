"""A task as a user sees it: lengths in metres, angles in rad, one row per state."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rtg import _core
from rtg.arguments import checked, numbers
from rtg.envs.push_env import observation_names
from rtg.files import own_data
from rtg.pictures.draw import outline, state_image
from rtg.task_config import read_config

Floats = NDArray[np.float64]


class GoalArea(NamedTuple):
    """An area of the plane that a goal is about.

    - `kind`: of the bodies; "*": of all objects.
    - `ring`: its outline. [vertices, 2] in m
    - `target`: whether it is the outline of a body where that is to lie.
    - `negated`: whether it is to be avoided.
    """

    kind: str
    ring: Floats
    target: bool
    negated: bool


class Task:
    """A task: bodies, joints, a goal and the pushes of the robot, which is body 0.

    A state is an array [bodies, 3] of x [m], y [m] and θ [rad] of each body; states are [N, bodies,
    3]. Action a pushes along the heading 2π (a % headings) / headings, by the stride a // headings.

    `core` is the task in the units of the C++ core, in which the robot has the radius 0.8 and the
    density 1; files and messages have these, too.
    """

    @checked
    def __init__(self, config: _core.Config) -> None:
        self.config = config
        self.core: _core.Task = config.task

    @property
    def name(self) -> str:
        return self.core.name

    @property
    def bodies(self) -> list[str]:
        """The names of the bodies, the robot first."""
        return self.core.names

    @property
    def masses(self) -> Floats:
        """The masses of the bodies. [bodies] in kg"""
        return np.array([body.mass for body in self.core.scene[0]]) / self.core.kilogram

    @property
    def actions(self) -> int:
        """The number of actions, headings times strides."""
        return self.core.actions

    @property
    def headings(self) -> int:
        return self.core.headings

    @property
    def horizon(self) -> int:
        """The number of pushes after which an episode ends."""
        return self.core.horizon

    @property
    def observation_names(self) -> list[str]:
        """The entries of an observation, in words; for units see `observation`."""
        return observation_names(self.core)

    @checked
    def start(self, seed: int = 1) -> Floats:
        """Returns the start number `seed`, with objects jittered. [bodies, 3]"""
        return self.outer(self.core.jittered_start(self.core.start_jitter, seed))

    @checked
    def goal_state(self, seed: int = 1) -> Floats:
        """Returns a random state in which the goal holds. [bodies, 3]

        Raises ValueError if 1,000 attempts find none.
        """
        state = self.core.goal_state(seed)
        if state is None:
            raise ValueError(f"no goal state of '{self.name}' was found in 1,000 attempts")
        return self.outer(state)

    def succeeded(self, states: ArrayLike) -> NDArray[np.bool_]:
        """Returns in which states the goal holds. [N, bodies, 3] -> [N]"""
        return self.core.succeeded(self.inner(states))

    def observation(self, states: ArrayLike) -> NDArray[np.float32]:
        """Returns what a learner sees of states. [N, bodies, 3] -> [N, observation]

        Entries are named by `observation_names`. Positions are in units of half the arena's half
        width, relative ones and slides in half the longest stride.
        """
        return self.core.observation(self.inner(states))

    def outlines(self, state: ArrayLike) -> list[list[Floats]]:
        """Returns where the outlines of the bodies are in a state, [bodies, 3].

        For each body the outer ring, then its holes: [vertices, 2] in m.
        """
        poses = self.inner_state(state)
        return [
            [outline(ring, pose) / self.core.metre for ring in rings]
            for rings, pose in zip(self.core.outlines, poses, strict=True)
        ]

    @property
    def goal(self) -> list[GoalArea]:
        """The areas of the plane that the goal is about; `description` has it in words."""
        metre = self.core.metre
        return [
            GoalArea(mark.kind, mark.ring / metre, mark.target, mark.negated)
            for mark in self.core.goal_marks
        ]

    @property
    def description(self) -> str:
        """The task in words, as `rtg check` prints it."""
        return self.config.description

    @checked
    def image(self, states: ArrayLike, caption: str = "") -> NDArray[np.uint8]:
        """Draws the last of some states [T, bodies, 3], and the robot's way there, as RGB.

        A goal that holds is drawn as reached. [pixels, pixels, 3]
        """
        path = self.inner(states)
        reached = bool(self.core.succeeded(path[-1:])[0])
        return state_image(self.core, path, caption=caption, reached=reached)

    def inner(self, states: ArrayLike) -> Floats:
        """Returns states as the core takes them. [N, bodies, 3] -> [N, bodies, 3]

        Raises ValueError for another shape, for numbers that are not finite, for fixed bodies off
        their places, and for others out of twice the arena.
        """
        return own_data.in_task_units(self.core, states)

    def inner_state(self, state: ArrayLike, name: str = "state") -> Floats:
        """Returns one state as the core takes it. [bodies, 3] -> [bodies, 3]

        `name`: that of the argument, for the ValueError that inner() raises, too.
        """
        given = numbers(name, state, (len(self.bodies), 3))
        return own_data.in_task_units(self.core, given[None], name)[0]

    def config_with(self, *settings: str | Sequence[str]) -> _core.Config:
        """Returns the configuration with further settings, each "section.key=value", or lists.

        Raises ValueError for settings that are not legal.
        """
        lists = ([some] if isinstance(some, str) else some for some in settings)
        changed = [setting for some in lists for setting in some]
        return _core.Config.from_text(self.config.yaml, self.name, changed)

    def outer(self, states: Floats) -> Floats:
        """Returns states of the core in metres. [..., bodies, 3] -> [..., bodies, 3]"""
        metres: Floats = states / [self.core.metre, self.core.metre, 1.0]
        return metres


@checked
def load_task(task: str | PathLike[str], settings: Sequence[str] = ()) -> Task:
    """Loads a task: the name of one of RTG's, such as "push_t", or the path of a YAML file.

    `settings`: each "section.key=value", as after `--set`. Raises ValueError, which says what is
    wrong with the file and where.
    """
    return Task(read_config(Path(task) if isinstance(task, PathLike) else task, settings))
