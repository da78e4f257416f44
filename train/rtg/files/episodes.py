"""Replays a plan of a transition set in the simulator."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.files.dataset import SOURCES, Transitions

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_MAX_GAP = 0.25  # [m], largest distance of a body from its place where the next step begins
_MAX_REPLAYS = 50  # plans, at most


def _positions(states: Floats) -> Floats:
    """Returns the positions of all bodies [m]. [N, bodies, 3] -> [N, 2 bodies]"""
    return states[:, :, :2].reshape(len(states), -1)


def _nearest(states: Floats, among: Floats) -> Ints:
    """Returns, for each state, the index of the state in `among` with the nearest positions.

    [N, bodies, 3], [M, bodies, 3] -> [N]
    """
    x = _positions(among)
    squares = (x * x).sum(axis=1)
    parts = np.array_split(_positions(states), 1 + len(states) // 500)
    return np.concatenate([(squares - 2.0 * part @ x.T).argmin(axis=1) for part in parts])


def _plans(steps: Transitions) -> tuple[Ints, Ints]:
    """Returns, for each step, the length of its plan and the index of the following step.

    The length counts the steps to a success, the step itself included; it is 0 if the following
    steps lead to no success. [steps] each
    """
    following = _nearest(steps.next_poses, steps.poses)
    gaps = np.linalg.norm((steps.next_poses - steps.poses[following])[:, :, :2], axis=2)
    joined = gaps.max(axis=1) <= _MAX_GAP
    lengths = steps.terminated.astype(np.int64)
    while (found := (lengths == 0) & joined & (lengths[following] > 0)).any():
        lengths[found] = lengths[following[found]] + 1
    return lengths, following


def _simulated(config: _core.Config, start: Floats, actions: Ints) -> Floats:
    """Simulates `actions` from `start` and returns the states.

    Stops after a success and before a push that the simulator cannot finish.
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
    """Returns the states of a true episode: the actions of a plan, simulated one after the other.

    A plan is a chain of steps, branches excluded, that ends in a success; each step begins within
    0.25 m of the end of the step before it. Up to 50 plans, those that begin nearest to the start
    of the task, are simulated in order of that distance until one succeeds. If none succeeds, the
    episode of the nearest plan is returned. [T+1, bodies, 3]; None if there is no plan.
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
    episodes = []
    for step in planned[np.argsort(distances[planned], kind="stable")][:_MAX_REPLAYS]:
        plan = [int(step)]
        while len(plan) < lengths[step]:
            plan.append(int(following[plan[-1]]))
        episodes.append(_simulated(config, steps.poses[step], steps.action[plan]))
        if config.task.succeeded(episodes[-1][-1:])[0]:
            return episodes[-1]
    return episodes[0]
