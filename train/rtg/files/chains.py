"""Tells which stored transitions follow one another: columns `episode`, `step` and `truncated`."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rtg import _core

Ints = NDArray[np.int64]

_BRANCH = _core.SOURCES.index("branch")


class Chains(NamedTuple):
    """The episodes that N transitions form, each a sequence of pushes of the simulator."""

    episode: NDArray[np.int32]  # [N], numbered by the first row of each, from 0
    step: NDArray[np.int32]  # [N], number of the row within its episode, from 0
    truncated: NDArray[np.bool_]  # [N], True for a last row without success


def chains_of(
    poses: NDArray[np.float64],
    next_poses: NDArray[np.float64],
    terminated: NDArray[np.bool_],
    source: NDArray[np.int8],
) -> Chains:
    """Returns the episodes of transitions. [N, bodies, 3], [N, bodies, 3], [N], [N]

    A row continues an earlier one if it begins, bit for bit, in the state in which that one ended
    without success, and no row in between begins or ends there. Branches stand alone: nobody went
    on from them.
    """
    steps = np.flatnonzero(source != _BRANCH)
    before, after = _joined(poses[steps], next_poses[steps], terminated[steps])
    previous = np.arange(len(source))  # the row that each continues; itself if there is none
    previous[steps[after]] = steps[before]
    has_next = np.zeros(len(source), np.bool_)
    has_next[steps[before]] = True
    first, step = _counted(previous)
    episode = np.unique(first, return_inverse=True)[1]
    return Chains(
        episode.astype(np.int32), step.astype(np.int32), ~has_next & ~terminated.astype(np.bool_)
    )


def _joined(poses: Any, next_poses: Any, terminated: Any) -> tuple[Ints, Ints]:
    """Returns pairs of rows, the second of which continues the first."""
    count = len(terminated)
    state = numbered(np.concatenate([poses, next_poses]))
    row = np.tile(np.arange(count), 2)
    is_end = np.repeat([False, True], count)
    counts = ~(is_end & np.tile(terminated, 2))
    order = np.lexsort((is_end, row, state))  # a row begins before it ends
    order = order[counts[order]]
    one, other = order[:-1], order[1:]
    pairs = (state[one] == state[other]) & is_end[one] & ~is_end[other]
    return row[one[pairs]], row[other[pairs]]


def numbered(states: NDArray[np.float64]) -> Ints:
    """Returns a number for each state, equal for states of equal bits. [M, bodies, 3] -> [M]"""
    entries = int(np.prod(states.shape[1:]))
    rows = np.ascontiguousarray(states, np.float64).reshape(len(states), entries)
    keys = rows.view(np.dtype((np.void, rows.itemsize * entries))).ravel()
    numbers: Ints = np.unique(keys, return_inverse=True)[1]
    return numbers


def _counted(previous: Ints) -> tuple[Ints, Ints]:
    """Returns the first row of each row's episode, and how many rows lie between. [N], [N]"""
    first, step = previous, (previous != np.arange(len(previous))).astype(np.int64)
    while (first[first] != first).any():  # doubles the distance
        first, step = first[first], step + step[first]
    return first, step
