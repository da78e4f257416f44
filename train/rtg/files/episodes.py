"""A plan of a transition set, replayed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.files.dataset import SOURCES, Transitions

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_GAP = 0.25  # [m], how far a body may lie from where the next step of a plan begins
_REPLAYED = 50  # plans


def _places(states: Floats) -> Floats:
    """[N, bodies, 3] -> [N, 2 bodies], m"""
    return states[:, :, :2].reshape(len(states), -1)


def _nearest(states: Floats, among: Floats) -> Ints:
    """For each state the number of the nearest by place. [N, bodies, 3], [M, bodies, 3] -> [N]"""
    x = _places(among)
    squares = (x * x).sum(axis=1)
    parts = np.array_split(_places(states), 1 + len(states) // 500)
    return np.concatenate([(squares - 2.0 * part @ x.T).argmin(axis=1) for part in parts])


def _plans(steps: Transitions) -> tuple[Ints, Ints]:
    """Says of each step how many there are to a success, itself included, and which is the next
    one; 0 where the steps lead to none. [steps] each"""
    following = _nearest(steps.next_poses, steps.poses)
    gaps = np.linalg.norm((steps.next_poses - steps.poses[following])[:, :, :2], axis=2)
    joined = gaps.max(axis=1) <= _GAP
    lengths = steps.terminated.astype(np.int64)
    while (found := (lengths == 0) & joined & (lengths[following] > 0)).any():
        lengths[found] = lengths[following[found]] + 1
    return lengths, following


def _replayed(config: _core.Config, start: Floats, actions: Ints) -> Floats:
    """The states of an episode, up to success. [bodies, 3], [actions] -> [T+1, bodies, 3]"""
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
    """A true episode: a plan's actions end to end, whether they still succeed or not.

    A plan goes from step to step (a tree's, but no branch), each of which begins within 0.25 m of
    where the one before it ends, to a success. Of those that begin nearest to the start of the task
    it is the first one that succeeds; without any, the nearest. [T+1, bodies, 3]; None without a
    plan.
    """
    chosen = transitions.source != SOURCES.index("branch")
    steps = Transitions(*(column[chosen] for column in transitions))
    if not steps.terminated.any():
        return None
    lengths, following = _plans(steps)
    away = np.linalg.norm(_places(steps.poses) - _places(config.task.start[None]), axis=1)
    planned = np.flatnonzero(lengths)
    episodes = []
    for step in planned[np.argsort(away[planned], kind="stable")][:_REPLAYED]:
        plan = [int(step)]
        while len(plan) < lengths[step]:
            plan.append(int(following[plan[-1]]))
        episodes.append(_replayed(config, steps.poses[step], steps.action[plan]))
        if config.task.succeeded(episodes[-1][-1:])[0]:
            return episodes[-1]
    return episodes[0]
