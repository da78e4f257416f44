"""Finds plans in a transition set and replays them in the simulator."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.engines import simulator as make_simulator
from rtg.files.dataset import SOURCES, Transitions

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_MAX_GAP = 0.25  # [task units], largest jump of a body from the end of a step to the next one
_MAX_REPLAYS = 50  # largest number of plans to simulate for replayed_plan()


class Episode(NamedTuple):
    """Pushes of the simulator, each from the state in which the one before it ended."""

    poses: Floats  # [T + 1, bodies, 3], x, y [task units], θ [rad]
    action: Ints  # [T]
    success: bool  # the goal holds in the last state, and in none before


def positions(states: Floats) -> NDArray[np.float32]:
    """Returns the positions of all bodies. [N, bodies, 3] -> [N, 2 bodies]"""
    return states[:, :, :2].reshape(len(states), -1).astype(np.float32)


def _nearest(states: Floats, among: Floats) -> Ints:
    """Returns, for each state, the index of the state in `among` with the nearest positions.

    [N, bodies, 3], [M, bodies, 3] -> [N]
    """
    x = positions(among)
    squares = (x * x).sum(axis=1)
    parts = np.array_split(positions(states), 1 + len(states) // 500)
    return np.concatenate([(squares - 2.0 * part @ x.T).argmin(axis=1) for part in parts])


def _plans(steps: Transitions) -> tuple[Ints, Ints]:
    """Finds plans: chains of steps that end in a success. Returns two arrays [steps].

    - lengths: number of steps from each step to success, itself included; 0 if there is no plan;
    - following: index of the next step after each step.
    """
    following = _nearest(steps.next_poses, steps.poses)
    gaps = np.linalg.norm((steps.next_poses - steps.poses[following])[:, :, :2], axis=2)
    joined = gaps.max(axis=1) <= _MAX_GAP
    lengths = steps.terminated.astype(np.int64)
    while (found := (lengths == 0) & joined & (lengths[following] > 0)).any():
        lengths[found] = lengths[following[found]] + 1
    return lengths, following


def _steps(transitions: Transitions) -> Transitions:
    """Returns the transitions without branches (outcomes of other headings)."""
    chosen = transitions.source != SOURCES.index("branch")
    return Transitions(*(column[chosen] for column in transitions))


def _nearest_first(task: _core.Task, steps: Transitions, among: Ints) -> Ints:
    """Sorts steps: those that begin in the start region first, then those nearest to the start."""
    distances = np.linalg.norm(positions(steps.poses[among]) - positions(task.start[None]), axis=1)
    outside = ~task.in_start_region(steps.poses[among].astype(np.float64))
    return among[np.lexsort((distances, outside))]


def _actions(steps: Transitions, first: int, length: int, following: Ints) -> Ints:
    plan = [first]
    while len(plan) < length:
        plan.append(int(following[plan[-1]]))
    return steps.action[plan].astype(np.int64)


def simulated(
    config: _core.Config, starts: Sequence[Floats], plans: Sequence[Ints]
) -> list[Episode]:
    """Simulates a sequence of actions from each start. [bodies, 3] each, [actions] each

    An episode stops after a success, at the horizon of the task, or before a push that the
    simulator cannot finish.
    """
    simulator, task = make_simulator(config), config.task
    states = [[start] for start in starts]
    running = range(len(starts))
    for step in range(task.horizon):
        alive = [k for k in running if step < len(plans[k])]
        if not alive:
            break
        actions = np.array([plans[k][step] for k in alive], np.int64)
        after, ok = simulator.push(np.stack([states[k][-1] for k in alive]), actions)
        for k in np.flatnonzero(ok):
            states[alive[k]].append(after[k])
        running = np.array(alive)[ok & ~task.succeeded(after)].tolist()
    return [
        Episode(np.stack(path), plan[: len(path) - 1], bool(task.succeeded(path[-1][None])[0]))
        for path, plan in zip(states, plans, strict=True)
    ]


def replayed_plans(
    config: _core.Config, transitions: Transitions, count: int | None = None, whole: bool = True
) -> list[Episode]:
    """Simulates plans from the stored transitions, each from its first state to its end.

    A plan is a chain of stored transitions that ends in a success. Each one begins within 0.25
    task units of the end of the previous one. Branches are left out. If `whole`, plans that are the
    end of another one are left out, too.

    Those that begin in the start region come first, then those that begin nearest to the start of
    the task. `count`: at most so many; None: all. An episode may fail where its plan succeeds.
    """
    steps = _steps(transitions)
    if not steps.terminated.any():
        return []
    lengths, following = _plans(steps)
    planned = np.flatnonzero(lengths)
    if whole:
        planned = np.setdiff1d(planned, following[lengths > 1])
    chosen = _nearest_first(config.task, steps, planned)[:count]
    plans = [_actions(steps, int(k), int(lengths[k]), following) for k in chosen]
    found = simulated(config, list(steps.poses[chosen].astype(np.float64)), plans)
    return [episode for episode in found if len(episode.action)]


def replayed_plan(config: _core.Config, transitions: Transitions) -> Floats | None:
    """Returns the states of one of the replayed_plans(). [T+1, bodies, 3]

    It is the first one that succeeds of at most 50. If all fail, it is the first one. Returns None
    if there is no plan.
    """
    episodes = replayed_plans(config, transitions, _MAX_REPLAYS, whole=False)
    if not episodes:
        return None
    return next((episode for episode in episodes if episode.success), episodes[0]).poses
