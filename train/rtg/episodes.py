"""Whole episodes in a transition set."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rtg.dataset import SOURCES, Transitions

Floats = NDArray[np.float64]


def episodes(transitions: Transitions, source: str) -> list[slice]:
    """The stretches of rows of that source in which every row starts where the one before ends."""
    chosen = transitions.source == SOURCES.index(source)
    joined = np.zeros(len(chosen), np.bool_)  # row k goes on from row k-1
    same = (transitions.next_poses[:-1] == transitions.poses[1:]).all(axis=(1, 2))
    joined[1:] = same & ~transitions.terminated[:-1] & chosen[:-1] & chosen[1:]
    first = np.flatnonzero(chosen & ~joined)
    ends = np.flatnonzero(chosen & ~np.append(joined[1:], False)) + 1
    return [slice(int(a), int(b)) for a, b in zip(first, ends, strict=True)]


def best_episode(transitions: Transitions) -> Floats | None:
    """States of the shortest successful roll-out, else mended episode, else of the longest chain.

    Steps that were stored before their chain are not part of it.
    [T+1, bodies, 3]; None if there is neither.
    """
    for source, sign in (("roll_out", 1), ("mended", 1), ("chain_replay", -1)):
        solved = [e for e in episodes(transitions, source) if transitions.terminated[e.stop - 1]]
        if solved:
            best = min(solved, key=lambda e: (sign * (e.stop - e.start), e.start))
            return np.concatenate(
                [transitions.poses[best], transitions.next_poses[best.stop - 1 : best.stop]]
            )
    return None
