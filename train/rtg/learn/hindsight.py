"""Hindsight experience replay [Andrychowicz et al. 2017] on the poses of the objects.

A layout consists of the positions of all movable objects and the angles of those whose turn can
undo a goal, see goal_angles(). It serves as the goal. Each training episode has a desired layout,
in which the task's goal holds. The network receives the observation and the offset of each object
from the desired layout.

With k = train.hindsight, the share k / (k + 1) of the online transitions in a batch is relabelled:
the desired layout becomes one that the episode reached later (the strategy "future"). A relabelled
transition has reward 1 and ends the episode if s' is near the new layout. Near means that all
objects are within the tolerances of the layouts. The other transitions keep the reward of the task,
which does not depend on the desired layout.

Choices that give the method its best chance:
- Desired layouts come from goal states that remain goal states if each object moves a little, see
  robust_goal_states(). So whoever reaches a layout nearly always succeeds.
- Objects of one kind are interchangeable, and any goal state suffices. So the desired layout of a
  training episode is the one nearest to its start among a random tenth of the layouts. Training
  thus covers many layouts, which makes learning faster [Andrychowicz et al. 2017]. The evaluated
  policy uses the nearest of all layouts in each state.
- Hindsight goals are drawn only from later states that s is not near to. A layout near s teaches
  nothing, because an episode that desires it ends before s. Without such a later state the
  transition keeps the desired layout of its episode.

TOLERANCE is 0.5 m, because one push of 2 m in one of 48 headings seldom places a box more
precisely. Goal regions, such as a disc of 2 m or a half-plane, contain layouts that far from
their edge. Where few goal states of a task are so robust, as with a pose for a goal or objects that
are to touch, all tolerances are halved until enough are.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from rtg import _core
from rtg.envs.curriculum import goal_states
from rtg.learn.replay import Field, MixedReplayBuffer, Part, Store

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
SUBSET_DIVISOR = 10  # a training episode gets the nearest of 1 / SUBSET_DIVISOR of the layouts
DIRECTIONS = 8  # of the displacements that robust goal states bear
MIXED = 112  # number of such displacements in which each object has a direction of its own
LAYOUT_SEED = 3 << 61  # fixed seed of the draws, so a policy file need not store it
BODY_ENTRIES = 6  # entries of an observation per movable object


def object_columns(task: _core.Task) -> dict[int, int]:
    """Returns the first column of each movable object in an observation; see rtg.task.

    Its BODY_ENTRIES columns are x, y, cos θ, sin θ and the offset from the robot.
    """
    movable = [body for body in range(1, task.bodies) if not task.fixed[body]]
    return {body: task.robot_entries + BODY_ENTRIES * k for k, body in enumerate(movable)}


class Layouts:
    """The desired layouts of a task, and functions that compare layouts with observations.

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
        goals = _desired_states(task, states, self.tolerance, turns * share)
        self.goal_layouts = self.of(task.observation(goals))  # [layouts, size]

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


def future_goals(
    layouts: Layouts,
    path: Array,  # [T + 1, size], the layouts of an episode of T transitions
    count: int,
    discount: float,
    rng: np.random.Generator,
) -> tuple[Array, Array, Array]:
    """Draws `count` hindsight goals for each transition of an episode. Returns three arrays:

    - the goals, [T, count, size]: layouts of later states that s is not near to;
    - lower bounds of their values, [T, count] float32: γ^n for n actions from s' to the first state
      near the goal;
    - whether such goals exist, [T] bool.
    """
    steps = len(path) - 1
    goals = np.zeros((steps, count, layouts.size), np.float32)
    bounds, found = np.zeros((steps, count), np.float32), np.zeros(steps, np.bool_)
    for t in range(steps):
        later = path[t + 1 :]
        teaching = np.flatnonzero(~layouts.near(later, path[t]))
        found[t] = len(teaching) > 0
        if found[t]:
            goals[t] = later[rng.choice(teaching, count)]
            reached = layouts.near(later, goals[t][:, None])  # [count, T - t]
            bounds[t] = discount ** reached.argmax(axis=1)
    return goals, bounds, found


class HindsightReplayBuffer(MixedReplayBuffer):
    """A replay buffer whose batches hold network inputs: observations with desired layouts.

    Transitions of running episodes keep the desired layout of their episode. Offline transitions
    get the task's layout nearest to s.
    """

    def __init__(self, *of_buffer: Any, layouts: Layouts, goals: int) -> None:
        """`goals`: number of hindsight goals per transition."""
        super().__init__(*of_buffer)
        self.layouts, self.goals = layouts, goals
        fields: list[Field] = [
            ("asked", np.float32, (layouts.size,)),  # the desired layout
            ("goals", np.float32, (goals, layouts.size)),  # hindsight goals
            ("goal_bounds", np.float32, (goals,)),  # lower bounds of their values
            ("has_goals", np.bool_, ()),  # False until the episode has ended
        ]
        self.offline = Store(self.capacity, self.observation_size, *fields)
        self.online = Store(self.capacity, self.observation_size, *fields)
        # The desired layout of each environment's episode.
        self._desired = np.zeros((self.environments, layouts.size), np.float32)
        # True if the next step begins an episode.
        self._begins_episode = np.ones(self.environments, np.bool_)

    def desired_layouts(self, observation: Array) -> Array:
        """Returns the desired layout of each environment; draws one for each new episode.

        [environments, observation] -> [environments, size]
        """
        count = len(self.layouts.goal_layouts)
        for env in np.flatnonzero(self._begins_episode):
            among = self.rng.permutation(count)[: -(-count // SUBSET_DIVISOR)]
            self._desired[env] = self.layouts.nearest(observation[env : env + 1], among)[0]
        self._begins_episode[:] = False
        return self._desired.copy()

    def _extra_online_columns(self, observation: Array) -> dict[str, Array]:
        return {"asked": self.desired_layouts(observation)}

    def _extra_offline_columns(self, observation: Array) -> dict[str, Array]:
        pieces = np.array_split(observation, 1 + len(observation) // 1000)  # to limit memory
        return {"asked": np.concatenate([self.layouts.nearest(piece) for piece in pieces])}

    def _close_episode(self, env: int, success: bool) -> None:
        store, numbers = self.online, np.array(self._episodes[env], np.int64)
        super()._close_episode(env, success)
        self._begins_episode[env] = True
        rows = numbers[numbers >= store.written - store.capacity] % store.capacity
        if len(rows) == 0:  # the simulator could not finish its first push
            return
        episode = store.rows[rows]
        seen = np.concatenate((episode["observation"][:1], episode["next_observation"]))
        episode["goals"], episode["goal_bounds"], episode["has_goals"] = future_goals(
            self.layouts, self.layouts.of(seen), self.goals, self.rules.discount, self.rng
        )
        store.rows[rows] = episode

    def _columns(self, parts: list[Part]) -> dict[str, Array]:
        columns = super()._columns(parts)
        online = sum(len(rows) for store, rows in parts if store is self.online)
        self._relabel({name: column[len(column) - online :] for name, column in columns.items()})
        for name in ("observation", "next_observation"):
            columns[name] = self.layouts.network_input(columns[name], columns["asked"])
        return columns

    def _relabel(self, online: dict[str, Array]) -> None:
        """Replaces desired layouts by hindsight goals and adapts the other columns to them.

        Each online transition with hindsight goals gets one with probability k / (k + 1).
        """
        pick = self.rng.integers(self.goals + 1, size=len(online["asked"]))  # last: no relabelling
        place = np.flatnonzero((pick < self.goals) & online["has_goals"])
        goal = online["goals"][place, pick[place]]
        online["asked"][place] = goal
        reached = self.layouts.near(self.layouts.of(online["next_observation"][place]), goal)
        online["reward"][place] = online["terminated"][place] = reached
        if self.rules.use_bounds:
            online["bound"][place] = online["goal_bounds"][place, pick[place]]

    def state(self) -> dict[str, Any]:
        return {
            **super().state(),
            "asked": self._desired.copy(),
            "begins": self._begins_episode.copy(),
        }

    def restore(self, state: dict[str, Any]) -> None:
        super().restore(state)
        self._desired = np.asarray(state["asked"]).copy()
        self._begins_episode = np.asarray(state["begins"]).copy()
