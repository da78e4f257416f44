"""Q against the simulator over all headings."""

from __future__ import annotations

import numpy as np
import pytest
from rtg import _core
from rtg.learn.value_check import check_values, stored_states
from rtg.paths import CONFIG

CONFIGURATION = _core.Config.from_file(CONFIG / "gathering.yaml")
TASK = CONFIGURATION.task
DISCOUNT = 0.5
# How far a push moves the robot, in units of what right() sees, times the weight that it has there.
REACH = 0.5 * 2.0 / TASK.position_unit


def right(observation: np.ndarray) -> np.ndarray:
    """Returns what is wanted, by the first number that the learner sees: the robot to the right."""
    return 0.5 + 0.5 * observation[:, 0]


def states(count: int) -> np.ndarray:
    return np.stack([TASK.jittered_start(0.1, 1, k) for k in range(count)])


def one_step_ahead(observation: np.ndarray, sign: float) -> np.ndarray:
    """The true worth of each heading where the robot pushes nothing: `right` of where it ends."""
    angles = 2.0 * np.pi * np.arange(TASK.headings) / TASK.headings
    ahead = right(observation)[:, None] + sign * REACH * np.cos(angles)
    return ahead


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_correlation_is_1_where_q_orders_as_the_simulator_and_its_opposite_is_minus_1(
    sign: float,
) -> None:
    check = check_values(
        CONFIGURATION, lambda seen: one_step_ahead(seen, sign), DISCOUNT, states(5)
    )
    assert check is not None
    assert check.rank_correlation == pytest.approx(sign, abs=0.02)
    # γ max Q(s') = 0.5 (right(s') + REACH): the spread is of half of what the heading moves.
    assert check.spread == pytest.approx(0.5 * REACH / np.sqrt(2.0), rel=0.01)


def test_the_spread_is_over_the_headings_of_a_state_and_not_over_the_states() -> None:
    """The robot is free everywhere; where it stands is worth more than what a heading moves."""
    apart = np.repeat(TASK.start[None], 3, axis=0)
    apart[:, 0, :2] = [[-4.0, -6.5], [0.0, -6.5], [4.0, -6.5]]
    check = check_values(CONFIGURATION, lambda seen: one_step_ahead(seen, 1.0), DISCOUNT, apart)
    assert check is not None
    assert check.spread == pytest.approx(0.5 * REACH / np.sqrt(2.0), rel=0.01)


def test_the_error_is_that_of_q_against_the_discounted_best_value_behind_the_push() -> None:
    constant = check_values(
        CONFIGURATION,
        lambda seen: right(seen)[:, None] + np.zeros(TASK.headings),
        DISCOUNT,
        np.stack([TASK.start]),
    )
    assert constant is not None
    here = right(TASK.observation(TASK.start[None]))[0]
    angles = 2.0 * np.pi * np.arange(TASK.headings) / TASK.headings
    worth = DISCOUNT * (here + REACH * np.cos(angles))
    assert constant.error == pytest.approx(np.sqrt(np.square(here - worth).mean()), rel=0.01)


def test_a_state_from_which_a_push_cannot_be_finished_is_left_out(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Nothing is known of what that heading is worth."""

    class Failing:
        def __init__(self, config: _core.Config) -> None:
            self.inner = _core.Simulator(config)

        def push(self, states: np.ndarray, actions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            after, ok = self.inner.push(states, actions)
            ok[TASK.headings + 7] = False  # of the second state
            return after, ok

    class Core:
        Simulator = Failing

    def worse_behind(seen: np.ndarray) -> np.ndarray:
        return one_step_ahead(seen, 1.0) ** 3

    both, first = states(2), states(1)
    alone = check_values(CONFIGURATION, worse_behind, DISCOUNT, first)
    monkeypatch.setattr("rtg.learn.value_check._core", Core)
    assert check_values(CONFIGURATION, worse_behind, DISCOUNT, both) == alone


def test_where_all_headings_are_worth_the_same_nothing_is_said() -> None:
    flat = check_values(
        CONFIGURATION, lambda seen: np.zeros((len(seen), TASK.headings)), DISCOUNT, states(2)
    )
    assert flat is None


def test_states_are_distinct_and_a_function_of_the_seed() -> None:
    class Data:
        poses = np.concatenate((states(6), states(6)))

    few = stored_states(Data, 4, seed=3)
    assert len(np.unique(few, axis=0)) == 4
    assert np.array_equal(few, stored_states(Data, 4, seed=3))
    assert len(stored_states(Data, 100, seed=3)) == 6
