"""Layouts: the places of movable objects, and the angles of those whose turn can undo a goal.

A layout serves as a goal of its own: it is reached where all objects are within the tolerances.
TOLERANCE is 0.5 m, because one push of 2 m in one of 48 headings seldom places a box more
precisely. Goal regions, such as a disc of 2 m or a half-plane, contain layouts that far from
their edge. Where few goal states of a task are so robust, as with a pose for a goal or objects that
are to touch, all tolerances are halved until enough are.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from rtg import _core
from rtg.envs.curriculum import goal_states
from rtg.pictures.draw import objects

Array = npt.NDArray[Any]

TOLERANCE = 0.5  # [m], largest distance of each object from a reached layout
JOINT_TOLERANCE = 0.05  # [rad], largest angle of each body with a joint from a reached layout
ANGLE_TOLERANCE = 0.2  # [rad], the same of the other bodies of goal_angles()
HALVINGS = 5  # of the tolerances, at most
ENOUGH = 0.03  # least share of the goal states that are robust, else tolerances are halved
ANGLE_REACH = 0.5  # [m / rad], weighs angles against ways
MAX_LAYOUTS = 1000  # goal states are drawn until so many of them are robust
FIRST_DRAWS = 200  # number of goal states by which the tolerances are chosen
MAX_DRAWS = 5000  # maximum number of goal states drawn
DIRECTIONS = 8  # of the displacements that robust goal states bear
MIXED = 112  # number of such displacements in which each object has a direction of its own
LAYOUT_SEED = 3 << 61  # fixed seed of the draws, so a policy file need not store it
# Entries of an observation per movable object.
BODY_ENTRY_NAMES = ("x", "y", "cos theta", "sin theta", "x to robot", "y to robot")
BODY_ENTRIES = len(BODY_ENTRY_NAMES)


def object_columns(task: _core.Task) -> dict[int, int]:
    """Returns the first column of each movable object in an observation.

    Its columns are those of BODY_ENTRY_NAMES.
    """
    return {body: task.robot_entries + BODY_ENTRIES * k for k, body in enumerate(objects(task))}


class Layouts:
    """The layouts of a task, and functions that compare them with observations.

    A layout is a float32 vector: x, y of each movable object in units of task.position_unit, then
    cos θ, sin θ of each of goal_angles().
    """

    def __init__(self, task: _core.Task) -> None:
        self._unit = task.position_unit  # [m]
        states = goal_states(task, LAYOUT_SEED, FIRST_DRAWS)
        self._at = at = object_columns(task)
        turned = [body for body in goal_angles(task, states) if body in at]
        positions = [column for body in at for column in (at[body], at[body] + 1)]
        angles = [column for body in turned for column in (at[body] + 2, at[body] + 3)]
        self._columns = np.array(positions + angles)  # columns of an observation
        self._first = task.observation_size  # of the columns that network_input() appends
        self._position_entries = len(positions)
        self.size = len(self._columns)
        turns = _tolerated_turns(task, turned)
        share = _robust_share(task, states, turns)
        self.tolerance = TOLERANCE * share  # [m]
        self.turns = turns[turned] * share  # [rad], per angle of a layout
        self._task, self._states, self._turns = task, states, turns * share

    @cached_property
    def goal_layouts(self) -> Array:
        """The desired layouts: those of robust goal states. [layouts, size]"""
        goals = _desired_states(self._task, self._states, self.tolerance, self._turns)
        return self.of(self._task.observation(goals))

    def columns_of(self, body: int) -> list[int]:
        """Returns the columns about an object that network_input() appends."""
        own = range(self._at[body], self._at[body] + BODY_ENTRIES)
        return [self._first + k for k, column in enumerate(self._columns) if column in own]

    def of(self, observation: Array) -> Array:
        """Returns the layouts of the observations. [N, observation] -> [N, size]"""
        layout: Array = observation[:, self._columns]
        return layout

    def near(self, one: Array, other: Array) -> Array:
        """Returns whether two layouts agree within the tolerances. [..., size] -> [...] bool"""
        positions, angles = self._difference(one, other)
        close = np.hypot(positions[..., 0], positions[..., 1]) * self._unit <= self.tolerance
        alike = angles[..., 0] >= np.cos(self.turns)
        reached: Array = np.logical_and(close.all(axis=-1), alike.all(axis=-1))
        return reached

    def nearest(self, observation: Array, among: Array | None = None) -> Array:
        """Returns, for each observation, the task's layout with the smallest sum of distances.

        The sum is over the objects, of their ways and of their angles times ANGLE_REACH. `among`:
        indices in `goal_layouts` of the layouts to choose from; all if None.
        [N, observation] -> [N, size]
        """
        goals = self.goal_layouts if among is None else self.goal_layouts[among]
        way, turn = self._difference(self.of(observation)[:, None], goals)
        ways = self._unit * np.hypot(way[..., 0], way[..., 1]).sum(axis=2)
        angles = np.abs(np.arctan2(turn[..., 1], turn[..., 0])).sum(axis=2)
        nearest: Array = goals[(ways + ANGLE_REACH * angles).argmin(axis=1)]
        return nearest

    def network_input(self, observation: Array, goal: Array) -> Array:
        """Returns the input of the network for the desired layout `goal`. It consists of:

        - the observation;
        - dx, dy from each object to its position in `goal`, in units of task.position_unit;
        - cos, sin of the angle from each body of goal_angles() to its angle in `goal`.

        [N, observation], [N, size] -> [N, observation + size]
        """
        parts = self._difference(self.of(observation), goal)
        way = [part.reshape(len(part), part.shape[1] * 2) for part in parts]
        return np.concatenate((observation, *way), axis=1)

    def network_input_nearest(self, observation: Array) -> Array:
        """Returns network_input() for the task's layout nearest to each observation."""
        return self.network_input(observation, self.nearest(observation))

    def _difference(self, here: Array, there: Array) -> tuple[Array, Array]:
        """Returns the differences of positions and of angles from layout `here` to `there`.

        Positions: dx, dy, [..., objects, 2]. Angles: cos, sin of the difference for each body of
        goal_angles(), [..., angles, 2].
        """
        positions = there[..., : self._position_entries] - here[..., : self._position_entries]
        c, s = here[..., self._position_entries :: 2], here[..., self._position_entries + 1 :: 2]
        d, t = there[..., self._position_entries :: 2], there[..., self._position_entries + 1 :: 2]
        angles = np.stack((c * d + s * t, c * t - s * d), axis=-1)
        return positions.reshape(*positions.shape[:-1], self._position_entries // 2, 2), angles


def _sides(task: _core.Task) -> Array:
    """Returns 1 and -1 for the two bodies of each joint, 0 for bodies without a joint. [bodies]

    Roots have 1. Joints may be listed in any order, so each body follows its parents to its root.
    """
    parents = {child: parent for parent, child, _ in task.joints}
    sides = np.zeros(task.bodies)
    for body in {*parents, *parents.values()}:
        ancestor, sides[body] = body, 1.0
        while ancestor in parents:
            ancestor, sides[body] = parents[ancestor], -sides[body]
    return sides


def goal_angles(task: _core.Task, states: Array) -> list[int]:
    """Returns the bodies with a joint, and those whose turn alone undoes a goal state.

    `states`: goal states, [N, bodies, 3].
    """
    bodies = {body for parent, child, _ in task.joints for body in (parent, child)}
    for body in range(1, task.bodies):
        for turn in (np.pi, 0.7, -0.7):
            turned = states.copy()
            turned[:, body, 2] += turn
            if not task.fixed[body] and not task.succeeded(turned).all():
                bodies.add(body)
    return sorted(bodies)


def _tolerated_turns(task: _core.Task, turned: list[int]) -> Array:
    """Returns the tolerances of the angles of the bodies `turned`; 0 of others. [bodies] [rad]"""
    turns = np.zeros(task.bodies)
    turns[turned] = np.where(_sides(task)[turned] == 0.0, ANGLE_TOLERANCE, JOINT_TOLERANCE)
    return turns


def _displacements(task: _core.Task, way: float, turns: Array) -> Array:
    """Returns those that robust_goal_states() are to bear. [displacements, bodies, 3]"""
    sides = _sides(task)
    against = np.where(sides == 0.0, 1.0, sides)
    rng = np.random.default_rng(0)
    together = np.repeat(np.arange(DIRECTIONS)[:, None], task.bodies, axis=1)
    mixed = rng.integers(DIRECTIONS, size=(MIXED, task.bodies))
    mixed_signs = rng.choice((1.0, -1.0), size=(MIXED, task.bodies))
    angles = 2.0 * np.pi / DIRECTIONS * np.concatenate((together, together, mixed))
    signs = np.concatenate((np.outer(np.repeat((1, -1), DIRECTIONS), against), mixed_signs))
    moved = np.stack((way * np.cos(angles), way * np.sin(angles), turns * signs), axis=2)
    moved[:, [body for body in range(task.bodies) if body == 0 or task.fixed[body]]] = 0.0
    return moved


def robust_goal_states(task: _core.Task, states: Array, way: float, turns: Array) -> Array:
    """Returns those `states` in which the goal is robust. [N, bodies, 3]

    The goal is robust if it still holds after each of these displacements:
    - all objects move by `way` in the same of DIRECTIONS; at the same time, each body turns by its
      entry of `turns` [bodies], all to the left or all to the right, but one body of each joint
      against the other;
    - each object moves by `way` in a direction of its own, and turns to a side of its own. Such
      displacements show whether objects still touch or keep apart, MIXED of them are drawn.

    The robot and fixed bodies stay where they are.
    """
    moved = states[:, None] + _displacements(task, way, turns)
    holds = task.succeeded(moved.reshape(-1, *states.shape[1:])).reshape(len(states), -1)
    robust: Array = states[holds.all(axis=1)]
    return robust


def _robust_share(task: _core.Task, states: Array, turns: Array) -> float:
    """Returns the largest share of the tolerances at which enough of the goal states are robust.

    It is 1, 1/2, 1/4, ...; the smallest one if there never are enough. `turns`: [bodies] [rad]
    """
    shares = [0.5**k for k in range(HALVINGS + 1)]
    for share in shares:
        robust = robust_goal_states(task, states, TOLERANCE * share, turns * share)
        if len(robust) >= ENOUGH * len(states):
            return share
    return shares[-1]


def _desired_states(task: _core.Task, states: Array, way: float, turns: Array) -> Array:
    """Draws goal states after the first ones, `states`, until MAX_LAYOUTS of them are robust.

    Returns these [layouts, bodies, 3]; `states` if none of them is robust.
    """
    robust = robust_goal_states(task, states, way, turns)
    if not len(robust):
        return states[:MAX_LAYOUTS]
    for first in range(FIRST_DRAWS, MAX_DRAWS, FIRST_DRAWS):
        if len(robust) >= MAX_LAYOUTS:
            break
        draws = [task.goal_state(LAYOUT_SEED, first + k) for k in range(FIRST_DRAWS)]
        more = np.array([state for state in draws if state is not None])
        more = robust_goal_states(task, more.reshape(-1, task.bodies, 3), way, turns)
        robust = np.concatenate((robust, more))
    return robust[:MAX_LAYOUTS]
