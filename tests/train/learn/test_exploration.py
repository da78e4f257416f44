from typing import Any

import numpy as np
from rtg.learn.exploration import REVISIT_WINDOW, Exploration
from samples import train_settings


def exploration(seed: int = 0, **changes: Any) -> Exploration:
    settings = train_settings(**{"leave_loops": False, **changes})
    return Exploration(settings, headings=8, seed=seed)


def test_a_share_of_what_explores_heads_towards_objects() -> None:
    """The contact heading is 6, the greedy one 1, and 20,000 environments act."""
    n, seeds = 20_000, []

    def contact(seed: int) -> np.ndarray:
        seeds.append(seed)
        return np.full(n, 6)

    settings = train_settings(leave_loops=False, nearby_share=1.0, contact_share=0.25)
    one = Exploration(settings, headings=8, seed=0, contact=contact)
    found = one.actions(np.full(n, 1), np.zeros((n, 5)), 0.4)
    assert set(found) <= {0, 1, 2, 3, 6, 7}  # nearby_headings is 2
    assert abs((found == 6).mean() - 0.1) < 4 * np.sqrt(0.1 * 0.9 / n)  # four sigma
    assert abs((found == 1).mean() - 0.6) < 4 * np.sqrt(0.6 * 0.4 / n)
    one.actions(np.full(n, 1), np.zeros((n, 5)), 0.4)
    assert len(set(seeds)) == 2, "another seed in each step"


def test_without_a_share_nobody_is_asked_for_contact_headings() -> None:
    greedy, seen = np.full(100, 1), np.zeros((100, 5))
    one = exploration()  # without anybody to ask
    other = Exploration(one.settings, 8, 0, contact=lambda seed: np.full(100, seed))
    np.testing.assert_array_equal(one.actions(greedy, seen, 0.5), other.actions(greedy, seen, 0.5))
    assert one.state() == other.state()


def explored(one: Exploration, states: list[float], epsilon: float = 0.0) -> list[bool]:
    """Tells of each state whether an environment whose greedy heading is 3 does something else."""
    done = [one.actions(np.array([3]), np.full((1, 5), x), epsilon)[0] for x in states]
    return [bool(action != 3) for action in done]


def test_noise_is_nearby_or_anywhere_and_as_frequent_as_asked() -> None:
    n = 20_000
    greedy, seen = np.full(n, 1), np.zeros((n, 5))
    one = exploration(nearby_share=1.0, nearby_headings=2)
    shift = (one.actions(greedy, seen, 0.3) - 1 + 4) % 8 - 4
    assert set(shift) == {-2, -1, 0, 1, 2}
    assert abs((shift != 0).mean() - 0.3) < 4 * np.sqrt(0.3 * 0.7 / n)  # four sigma
    anywhere = exploration(nearby_share=0.0).actions(greedy, seen, 1.0)
    counts = np.bincount(anywhere, minlength=8)
    assert (np.abs(counts / n - 1 / 8) < 0.012).all()  # five sigma


def test_nearby_headings_have_the_stride_of_the_greedy_action() -> None:
    settings = train_settings(leave_loops=False, nearby_share=1.0, nearby_headings=2)
    one = Exploration(settings, headings=8, seed=0, strides=3)
    greedy = np.repeat([0, 8, 23], 1000)
    actions = one.actions(greedy, np.zeros((3000, 5)), 1.0)
    assert (actions // 8 == greedy // 8).all()
    assert set(actions[2000:]) == {16, 17, 21, 22}
    anywhere = Exploration(
        train_settings(leave_loops=False, nearby_share=0.0), headings=8, seed=0, strides=3
    ).actions(greedy, np.zeros((3000, 5)), 1.0)
    assert set(anywhere) == set(range(24))


def test_a_loop_is_left_where_it_closes() -> None:
    nearby = {"nearby_share": 1.0}  # what explores differs
    states = [0.0, 1.0, 0.03, 1.03, 2.0, 2.05, 2.2]
    left = [False, False, True, True, False, False, False]
    assert explored(exploration(leave_loops=True, **nearby), states) == left
    assert explored(exploration(leave_loops=False, **nearby), states) == [False] * 7


def test_one_number_that_differs_makes_another_state() -> None:
    one = exploration(leave_loops=True, nearby_share=1.0)
    seen = np.zeros((1, 5))
    one.actions(np.array([3]), seen, 0.0)
    seen[0, 4] = 0.05  # in place: what is remembered is a copy
    assert one.actions(np.array([3]), seen, 0.0) == [3]
    assert one.actions(np.array([3]), seen, 0.0) != [3]


def test_environments_have_loops_of_their_own() -> None:
    one = exploration(leave_loops=True, nearby_share=1.0)
    greedy = np.array([3, 3])
    one.actions(greedy, np.array([[0.0], [5.0]]), 0.0)
    done = one.actions(greedy, np.array([[5.0], [5.0]]), 0.0)
    assert (done == 3).tolist() == [True, False]


def test_what_was_long_ago_is_forgotten() -> None:
    steps = [float(k) for k in range(REVISIT_WINDOW)]
    one = exploration(leave_loops=True, nearby_share=1.0)
    assert explored(one, [*steps, 0.0])[-1]
    one = exploration(leave_loops=True, nearby_share=1.0)
    assert not explored(one, [*steps, float(REVISIT_WINDOW), 0.0])[-1]


def test_goes_on_from_its_state() -> None:
    one = exploration(leave_loops=True)
    rng = np.random.default_rng(5)
    states = rng.integers(4, size=60).astype(float).tolist()
    explored(one, states[:30], 0.5)
    other = exploration(seed=9, leave_loops=True)
    other.restore(one.state())
    rest = explored(one, states[30:], 0.5)
    assert explored(other, states[30:], 0.5) == rest
    assert 0 < sum(rest) < 30


def test_contact_headings_go_on_from_its_state() -> None:
    def contact(seed: int) -> np.ndarray:
        return np.array([seed % 8])

    settings = train_settings(leave_loops=True, contact_share=0.5)
    one, other = (Exploration(settings, 8, seed, contact) for seed in (0, 9))
    states = [float(k % 5) for k in range(60)]

    def actions(some: Exploration) -> list[int]:
        seen = [np.full((1, 5), x) for x in states]
        return [int(some.actions(np.array([3]), row, 0.5)[0]) for row in seen]

    actions(one)
    other.restore(one.state())
    assert actions(one) == actions(other)
    assert set(actions(one)) > {0, 7}
