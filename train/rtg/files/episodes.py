"""Finds a plan in a transition set and replays it in the simulator."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.files.dataset import SOURCES, Transitions

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_MAX_GAP = 0.25  # [m], largest jump of a body between the end of a step and the next one's start
_MAX_REPLAYS = 50  # largest number of plans to simulate


def _positions(states: Floats) -> NDArray[np.float32]:
    """Returns the positions of all bodies [m]. [N, bodies, 3] -> [N, 2 bodies]"""
    return states[:, :, :2].reshape(len(states), -1).astype(np.float32)


def _nearest(states: Floats, among: Floats) -> Ints:
    """Returns, for each state, the index of the state in `among` with the nearest positions.

    [N, bodies, 3], [M, bodies, 3] -> [N]
    """
    x = _positions(among)
    squares = (x * x).sum(axis=1)
    parts = np.array_split(_positions(states), 1 + len(states) // 500)
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


def _simulated(config: _core.Config, start: Floats, actions: Ints) -> Floats:
    """Simulates `actions` from `start` and returns the visited states.

    Stops after a success, or before a push that the simulator cannot finish.
    [bodies, 3], [actions] -> [T+1, bodies, 3]
    """
    simulator, states = _core.Simulator(config), [start]
    for action in actions:
        after, ok = simulator.push(states[-1][None], np.array([action]))
        if not ok[0]:
            break
        states.append(after[0])
        if config.task.succeeded(after)[0]:
            break
    return np.stack(states)


def replayed_plan(config: _core.Config, transitions: Transitions) -> Floats | None:
    """Simulates a plan from the stored transitions and returns its states. [T+1, bodies, 3]

    A plan is a chain of stored transitions that ends in a success. Each one begins within 0.25 m of
    the end of the previous one. Branches (outcomes of other headings) are left out.

    Plans are simulated until one succeeds, at most 50 of them. Those that begin in the start region
    come first, then those that begin nearest to the start of the task. If all fail, the states of
    the first one are returned. Returns None if there is no plan.
    """
    chosen = transitions.source != SOURCES.index("branch")
    steps = Transitions(*(column[chosen] for column in transitions))
    if not steps.terminated.any():
        return None
    lengths, following = _plans(steps)
    distances = np.linalg.norm(
        _positions(steps.poses) - _positions(config.task.start[None]), axis=1
    )
    planned = np.flatnonzero(lengths)
    outside = ~config.task.in_start_region(steps.poses[planned].astype(np.float64))
    episodes = []
    for step in planned[np.lexsort((distances[planned], outside))][:_MAX_REPLAYS]:
        plan = [int(step)]
        while len(plan) < lengths[step]:
            plan.append(int(following[plan[-1]]))
        episodes.append(_simulated(config, steps.poses[step], steps.action[plan]))
        if config.task.succeeded(episodes[-1][-1:])[0]:
            return episodes[-1]
    return episodes[0]
