import numpy as np
from rtg.learn.value_bounds import value_bounds


def observations(*names: float) -> np.ndarray:
    return np.array(names, np.float32)[:, None]


def test_chain_gets_powers_of_the_discount() -> None:
    bounds = value_bounds(
        observations(0, 1, 2), observations(1, 2, 3), np.array([0, 0, 1], np.float32), 0.5
    )
    np.testing.assert_array_equal(bounds, [0.25, 0.5, 1.0])


def test_the_shortest_way_counts_and_dead_ends_are_zero() -> None:
    #  0 -> 1 -> 2 -> success,  0 -> 2,  1 -> 9 (dead end),  2 -> 0 (cycle)
    here, there = observations(0, 1, 2, 0, 1, 2), observations(1, 2, 7, 2, 9, 0)
    reward = np.array([0, 0, 1, 0, 0, 0], np.float32)
    bounds = value_bounds(here, there, reward, 0.5)
    np.testing.assert_array_equal(bounds, [0.25, 0.5, 1.0, 0.5, 0.0, 0.25])


def test_agrees_with_value_iteration_on_random_graphs() -> None:
    rng = np.random.default_rng(3)
    here, there = rng.integers(40, size=(2, 120))
    reward = (rng.random(120) < 0.03).astype(np.float32)
    value = np.zeros(40)
    for _ in range(200):
        q = np.maximum(reward, 0.9 * value[there])
        value = np.array([q[here == s].max(initial=0.0) for s in range(40)])
    bounds = value_bounds(observations(*here), observations(*there), reward, 0.9)
    np.testing.assert_allclose(bounds, q, rtol=1e-6)


def test_negative_zero_is_zero() -> None:
    bounds = value_bounds(
        observations(1.0, 0.0), observations(-0.0, 3.0), np.array([0, 1], np.float32), 0.5
    )
    np.testing.assert_array_equal(bounds, [0.5, 1.0])
