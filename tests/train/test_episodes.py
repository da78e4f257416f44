"""Whole episodes found in a transition set."""

from itertools import pairwise

import numpy as np
from rtg.dataset import SOURCES, Transitions
from rtg.episodes import best_episode, episodes


def chain(source, states, success):
    """Transitions through states, numbers that stand for poses: (from, to, source, success)."""
    steps = list(pairwise(states))
    return [(a, b, source, success and k == len(steps) - 1) for k, (a, b) in enumerate(steps)]


def transitions(*chains):
    rows = [row for steps in chains for row in steps]
    state = lambda k: np.full((2, 3), float(k))  # noqa: E731
    success = np.array([row[3] for row in rows])
    count = len(rows)
    return Transitions(
        poses=np.stack([state(row[0]) for row in rows]),
        action=np.zeros(count, np.int32),
        next_poses=np.stack([state(row[1]) for row in rows]),
        reward=success.astype(np.float32),
        terminated=success,
        observation=np.zeros((count, 8), np.float32),
        next_observation=np.zeros((count, 8), np.float32),
        source=np.array([SOURCES.index(row[2]) for row in rows], np.int8),
    )


def test_an_episode_ends_where_the_next_row_starts_elsewhere():
    data = transitions(
        chain("step_replay", [1, 2, 3], False),
        chain("roll_out", [3, 4, 5, 6], True),
        chain("roll_out", [6, 7], False),  # starts where a success ended: another episode
        chain("roll_out", [9, 8, 7], False),
    )
    assert episodes(data, "roll_out") == [slice(2, 5), slice(5, 6), slice(6, 8)]
    assert episodes(data, "step_replay") == [slice(0, 2)]
    assert episodes(data, "chain_replay") == []


def test_the_best_episode_is_the_shortest_solved_roll_out():
    data = transitions(
        chain("roll_out", [1, 2, 3, 4], True),
        chain("roll_out", [5, 6], False),
        chain("roll_out", [7, 8, 9], True),
        chain("chain_replay", [10, 11], True),
    )
    assert best_episode(data)[:, 0, 0].tolist() == [7, 8, 9]


def test_without_solved_roll_outs_it_is_the_shortest_mended_one():
    data = transitions(
        chain("roll_out", [1, 2], False),
        chain("mended", [3, 4, 5], True),
        chain("chain_replay", [10, 11], True),
        chain("mended", [6, 7], True),
    )
    assert best_episode(data)[:, 0, 0].tolist() == [6, 7]


def test_without_any_it_is_the_longest_chain():
    data = transitions(
        chain("roll_out", [1, 2, 3, 4], False),
        chain("chain_replay", [10, 11], True),
        chain("chain_replay", [12, 13, 14], True),
    )
    assert best_episode(data)[:, 0, 0].tolist() == [12, 13, 14]
    assert best_episode(transitions(chain("roll_out", [1, 2], False))) is None
