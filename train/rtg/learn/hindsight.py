"""Hindsight experience replay [Andrychowicz et al. 2017] on the poses of the objects.

A goal is a layout: where every movable object shall be, and how bodies that joints connect shall be
turned. The network sees the observation and how far each object is from the layout asked for. A
training episode is asked for a layout in which the task's goal holds. In the replay buffer the
share k / (k + 1) of the online transitions is asked for one that the episode reached later on (the
paper's strategy "future" with k goals drawn per transition). Then the reward is 1, and the episode
over, where the objects of s' are within TOLERANCE and TURN of it. The other transitions keep the
reward of the task: its goal is reached whichever layout was asked for.

Choices that give the method its best chance:
- The layouts of the task are those of DRAWS goal states that stay goal states when their objects
  are moved by TOLERANCE in any direction and the two bodies of each joint are turned by TURN
  against each other (all, where none is). So to reach one means success.
- Objects of one kind may stand for each other, and any goal state will do. So an episode is asked
  for the layout that is nearest to its start, among a random tenth of them: in training many are
  asked for, which the paper finds to learn faster. The policy that is judged asks in each state for
  the nearest of all.
- A layout that s has reached already teaches nothing: an episode that was asked for it is over
  before s. Hindsight goals are drawn from the later states that s is not near to. Where there is
  none the transition keeps the layout that its episode was asked for.

TOLERANCE is 0.5 m: one push of 2 m, of 48 headings, seldom places a box more precisely, and a
disc of 2 m or a half-plane has layouts that keep so far from its edge.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from rtg import _core
from rtg.envs.curriculum import goal_states
from rtg.learn.replay import MixedReplayBuffer, Part, Store

Array = npt.NDArray[Any]

TOLERANCE = 0.5  # of each object [m]
TURN = 0.05  # of each body that a joint connects [rad]
DRAWS, LAYOUTS = 5000, 1000  # goal states drawn; the most layouts that are kept of them
FEW = 10  # a training episode is asked for the nearest of 1 / FEW of the layouts
OF_LAYOUTS = 3 << 61  # seed of the draws: no run's, so that a policy's file need not hold it
LENGTH = 8.0  # of an observation's lengths [m]
OF_BODY = 6  # numbers of an observation per movable object; the first two are the robot's


class Layouts:
    """The layouts of a task: as part of an observation, as goals, as the network sees them.

    A layout is float32: x, y of each movable object [8 m], cos θ, sin θ of each that has a joint.
    """

    def __init__(self, task: _core.Task) -> None:
        movable = [body for body in range(1, task.bodies) if not task.fixed[body]]
        jointed = {body for parent, child, _ in task.joints for body in (parent, child)}
        at = [2 + OF_BODY * k for k in range(len(movable))]
        turned = [first for first, body in zip(at, movable, strict=True) if body in jointed]
        places = [column for first in at for column in (first, first + 1)]
        turns = [column for first in turned for column in (first + 2, first + 3)]
        self._columns = np.array(places + turns)  # of an observation
        self._places = len(places)
        self.size = len(self._columns)
        goals = lasting(task, goal_states(task, OF_LAYOUTS, DRAWS))[:LAYOUTS]
        self.of_task = self.of(task.observation(goals))  # [layouts, size]

    def of(self, observation: Array) -> Array:
        """Where the objects are. [N, observation] -> [N, size]"""
        layout: Array = observation[:, self._columns]
        return layout

    def near(self, one: Array, other: Array) -> Array:
        """Says if every object is within TOLERANCE, and TURN. [..., size] each -> [...] bool"""
        places, turns = self._difference(one, other)
        close = np.hypot(places[..., 0], places[..., 1]) * LENGTH <= TOLERANCE
        alike = turns[..., 0] >= np.cos(TURN)
        reached: Array = close.all(axis=-1) & alike.all(axis=-1)
        return reached

    def nearest(self, observation: Array, among: Array | None = None) -> Array:
        """The layout of the task to which the objects have the shortest way in all.

        `among`: rows of `of_task`, all of them if None. [N, observation] -> [N, size]
        """
        goals = self.of_task if among is None else self.of_task[among]
        way, _ = self._difference(self.of(observation)[:, None], goals)
        nearest: Array = goals[np.hypot(way[..., 0], way[..., 1]).sum(axis=2).argmin(axis=1)]
        return nearest

    def asked(self, observation: Array, goal: Array) -> Array:
        """The input of the network: the observation; from the objects to `goal` dx, dy [8 m]; cos,
        sin of the turns to it. [N, observation], [N, size] -> [N, observation + size]"""
        parts = self._difference(self.of(observation), goal)
        way = [part.reshape(len(part), part.shape[1] * 2) for part in parts]
        return np.concatenate((observation, *way), axis=1)

    def asked_nearest(self, observation: Array) -> Array:
        """The input of the network where it is asked for the nearest layout of the task."""
        return self.asked(observation, self.nearest(observation))

    def _difference(self, here: Array, there: Array) -> tuple[Array, Array]:
        """dx, dy [8 m], [..., objects, 2], and cos, sin of the turns, [..., jointed, 2]."""
        places = there[..., : self._places] - here[..., : self._places]
        c, s = here[..., self._places :: 2], here[..., self._places + 1 :: 2]
        d, t = there[..., self._places :: 2], there[..., self._places + 1 :: 2]
        turns = np.stack((c * d + s * t, c * t - s * d), axis=-1)
        return places.reshape(*places.shape[:-1], self._places // 2, 2), turns


def _sides(task: _core.Task) -> Array:
    """1 or -1 for bodies that joints connect, different for the two of a joint; else 0. [bodies]"""
    sides = np.zeros(task.bodies)
    for parent, child, _ in task.joints:
        sides[parent] = sides[parent] or 1.0
        sides[child] = -sides[parent]
    return sides


def lasting(task: _core.Task, states: Array) -> Array:
    """Those in which the goal still holds with all objects moved by TOLERANCE in any of eight
    directions and the two bodies of each joint turned by TURN, one against the other; all of them
    where none is. [N, bodies, 3]"""
    angles = np.arange(8) * np.pi / 4
    moved = np.repeat(states[:, None], 2 * len(angles), axis=1)  # [N, 16, bodies, 3]
    moved[:, :, 1:, 0] += TOLERANCE * np.tile(np.cos(angles), 2)[:, None]
    moved[:, :, 1:, 1] += TOLERANCE * np.tile(np.sin(angles), 2)[:, None]
    moved[:, :, :, 2] += TURN * np.repeat((1, -1), len(angles))[:, None] * _sides(task)
    holds = task.succeeded(moved.reshape(-1, *states.shape[1:])).reshape(len(states), -1)
    stays = holds.all(axis=1)
    return states[stays] if stays.any() else states


def future_goals(
    layouts: Layouts,
    path: Array,  # [T + 1, size], the layouts of an episode of T transitions
    count: int,
    discount: float,
    rng: np.random.Generator,
) -> tuple[Array, Array, Array]:
    """For each transition `count` layouts that its episode reached later on and s is not near to.

    With the values that the episode proves, γ^n with n more actions from s' to where it is near the
    layout; and whether there are any.  [T, count, size], [T, count] float32, [T] bool
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


class GoalStore(Store):
    """Transitions with the layout that was asked for, and those that their episode reached."""

    columns = (*Store.columns, "asked", "goals", "goal_bounds", "has_goals")

    def __init__(self, capacity: int, observation_size: int, size: int, goals: int) -> None:
        super().__init__(capacity, observation_size)
        self.asked = np.zeros((0, size), np.float32)
        self.goals = np.zeros((0, goals, size), np.float32)
        self.goal_bounds = np.zeros((0, goals), np.float32)
        self.has_goals = np.zeros(0, np.bool_)  # not before the episode is over


class HindsightReplayBuffer(MixedReplayBuffer):
    """Batches whose observations end with the way to the layout asked for.

    Transitions of running episodes keep what they were asked for. Offline ones are asked for the
    layout that is nearest to their s.
    """

    offline: GoalStore
    online: GoalStore

    def __init__(self, *of_buffer: Any, layouts: Layouts, goals: int, **more: Any) -> None:
        """`goals`: of hindsight, per transition."""
        super().__init__(*of_buffer, **more)
        self.layouts, self.goals = layouts, goals
        shape = (self.buffer_size, self.obs_shape[0], layouts.size, goals)
        self.offline, self.online = GoalStore(*shape), GoalStore(*shape)
        self._asked = np.zeros((self.n_envs, layouts.size), np.float32)
        self._begins = np.ones(self.n_envs, np.bool_)  # whether the next step is an episode's first

    def asked_of(self, observation: Array) -> Array:
        """The layout that the episode of each environment is asked for; drawn where one begins.

        [environments, observation] -> [environments, size]
        """
        count = len(self.layouts.of_task)
        for env in np.flatnonzero(self._begins):
            among = self.rng.permutation(count)[: -(-count // FEW)]
            self._asked[env] = self.layouts.nearest(observation[env : env + 1], among)[0]
        self._begins[:] = False
        return self._asked.copy()

    def _more_online(self, observation: Array) -> dict[str, Array]:
        return {"asked": self.asked_of(observation)}

    def _more_offline(self, observation: Array) -> dict[str, Array]:
        pieces = np.array_split(observation, 1 + len(observation) // 1000)  # they take less memory
        return {"asked": np.concatenate([self.layouts.nearest(piece) for piece in pieces])}

    def _close_episode(self, env: int, success: bool) -> None:
        store, numbers = self.online, np.array(self._episodes[env], np.int64)
        super()._close_episode(env, success)
        self._begins[env] = True
        rows = numbers[numbers >= store.written - store.capacity] % store.capacity
        if len(rows) == 0:  # the simulator gave up its first push
            return
        seen = np.concatenate((store.observation[rows[:1]], store.next_observation[rows]))
        store.goals[rows], store.goal_bounds[rows], store.has_goals[rows] = future_goals(
            self.layouts, self.layouts.of(seen), self.goals, self.discount, self.rng
        )

    def _columns(self, parts: list[Part]) -> dict[str, Array]:
        columns = super()._columns(parts)
        goal = np.concatenate([s.asked[rows] for s, rows in parts if isinstance(s, GoalStore)])
        for store, rows in parts:
            if store is self.online:
                self._relabel(columns, goal, rows)
        for name in ("observation", "next_observation"):
            columns[name] = self.layouts.asked(columns[name], goal)
        return columns

    def _relabel(self, columns: dict[str, Array], goal: Array, rows: Array) -> None:
        """`rows`: of the online transitions, which stand last in `columns` and `goal`."""
        store, place = self.online, np.arange(len(goal) - len(rows), len(goal))
        pick = self.rng.integers(self.goals + 1, size=len(rows))  # the last: as it was asked
        seen = (pick < self.goals) & store.has_goals[rows]
        place, rows, pick = place[seen], rows[seen], pick[seen]
        goal[place] = store.goals[rows, pick]
        reached = self.layouts.near(self.layouts.of(store.next_observation[rows]), goal[place])
        columns["reward"][place] = columns["terminated"][place] = reached
        if self.use_bounds:
            columns["bound"][place] = store.goal_bounds[rows, pick]

    def state(self) -> dict[str, Any]:
        return {**super().state(), "asked": self._asked.copy(), "begins": self._begins.copy()}

    def restore(self, state: dict[str, Any]) -> None:
        super().restore(state)
        self._asked = np.asarray(state["asked"]).copy()
        self._begins = np.asarray(state["begins"]).copy()
