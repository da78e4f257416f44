"""Learning from data alone: rounds without interactions, and CQL's term of the loss."""

import numpy as np
import torch as th
from rtg.learn.ddqn import conservative_gap
from test_ddqn import column, model


def test_the_conservative_gap_by_hand() -> None:
    """log (1 + 2 + 5) less the logarithm of the action's share."""
    q = th.tensor([[1.0, 2.0, 5.0], [1.0, 2.0, 5.0], [3.0, 3.0, 3.0]]).log() - 7.0
    actions = th.tensor([[1], [2], [0]])
    wanted = column(np.log(8 / 2), np.log(8 / 5), np.log(3.0))
    th.testing.assert_close(conservative_gap(q, actions), wanted)


def test_values_of_headings_that_are_not_in_the_data_are_held_down() -> None:
    """All of the line's data go right. What else could be done is thought less of by far more than
    values can differ: 1."""
    gaps = []
    for cql_weight in (0.0, 1.0):
        one = model(cql_weight=cql_weight, learning_rate=1e-3)
        x = np.array([[k / 4, 1, 0] for k in range(5)], np.float32)
        reward = np.array([0, 0, 0, 1], np.float32)
        one.replay.offline.append(
            observation=x[:4],
            next_observation=x[1:],
            action=np.ones(4, np.int64),
            reward=reward,
            terminated=reward,
        )
        for _ in range(100):
            one.learn_offline()
        q = one.values(x[:4])
        gaps.append((q[:, 1] - np.delete(q, 1, axis=1).max(axis=1)).min())
    assert gaps[0] < 1.0 < gaps[1]


def test_learning_offline_counts_the_interactions_it_leaves_out() -> None:
    one = model(train_frequency=4, gradient_steps=3)
    one.replay.offline.append(
        observation=np.zeros((1, 3), np.float32),
        next_observation=np.zeros((1, 3), np.float32),
        action=np.zeros(1, np.int64),
        reward=np.zeros(1, np.float32),
        terminated=np.zeros(1, np.float32),
    )
    for _ in range(5):
        one.learn_offline()
    assert (one.interactions, one.gradient_steps) == (20, 15)
    assert one.replay.online.count == 0
