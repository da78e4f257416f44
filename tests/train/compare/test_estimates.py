"""Figures over seeds and tasks, against hand calculations."""

import itertools

import numpy as np
import pytest
from rtg.compare.estimates import (
    band,
    carried_forward,
    first_reach,
    improvement_interval,
    interquartile_mean,
    interval,
    mean_std,
    probability_of_improvement,
    profile,
    rank_test,
    task_mean,
)
from rtg.compare.report_plots import LEVELS

NAN = float("nan")


def scores(*tasks):
    return [np.array(task, float) for task in tasks]


def test_the_spread_is_that_of_a_sample():
    assert mean_std([1.0, 2.0, 3.0]) == (2.0, 1.0)
    assert mean_std([2.0]) == (2.0, None)


def test_the_interquartile_mean_drops_a_quarter_at_either_end():
    assert interquartile_mean(scores([0.0, 1.0], [2.0, 9.0])) == 1.5
    assert interquartile_mean(scores([0.0, 1.0, 5.0])) == 2.0  # a quarter of three is none
    assert interquartile_mean(scores(range(8))) == 3.5


def test_the_probability_of_improvement_counts_ties_half_and_tasks_alike():
    assert probability_of_improvement(scores([2.0]), scores([1.0])) == 1.0
    assert probability_of_improvement(scores([1.0, 1.0]), scores([1.0])) == 0.5
    assert probability_of_improvement(scores([1.0, 3.0]), scores([2.0, 0.0])) == 0.75
    uneven = scores([2.0], [0.0, 0.0, 0.0])
    assert probability_of_improvement(uneven, scores([1.0], [1.0])) == 0.5


def test_seeds_are_drawn_within_their_task():
    """Without that the mean of the means of two constant tasks would vary."""
    table = scores([0.0, 0.0, 0.0], [1.0, 1.0, 1.0])
    assert interval(interquartile_mean, table) == (0.5, 0.5)


def test_single_seeds_have_no_interval():
    alone = scores([0.3], [0.9])
    assert interval(interquartile_mean, alone) is None
    assert improvement_interval(alone, alone) is None
    several = scores([0.3, 0.4], [0.9])
    assert improvement_interval(alone, several) is improvement_interval(several, alone) is None
    assert improvement_interval(several, several) is not None


def test_an_interval_is_that_of_the_mean_and_always_the_same():
    rng = np.random.default_rng(1)
    sample = scores(rng.normal(size=400))

    def mean(drawn):
        return float(drawn[0].mean())

    low, high = interval(mean, sample)
    wide = 1.96 * sample[0].std() / 20.0
    # Of 2,000 resamples; an interval of 97 or 90 % is off by 0.006 or more.
    assert low == pytest.approx(sample[0].mean() - wide, abs=0.005)
    assert high == pytest.approx(sample[0].mean() + wide, abs=0.005)
    assert interval(mean, sample) == (low, high)


def test_the_interval_of_the_improvement_draws_seeds_of_both():
    low, high = improvement_interval(scores([1.0, 3.0]), scores([2.0, 0.0]))
    assert (low, high) == (0.0, 1.0)
    assert improvement_interval(scores([3.0, 3.0]), scores([2.0, 0.0])) == (1.0, 1.0)


def test_a_bar_is_reached_at_the_first_of_two_evaluations_in_a_row_that_have_it():
    success = np.array([0.7, 0.6, 0.7, 0.8, 0.9])
    assert first_reach(success, 0.7) == 2
    assert first_reach(success, 0.8) == 3
    assert first_reach(success, 0.9) is None, "the last one alone may be luck"
    assert first_reach(success[:1], 0.7) is None


def test_the_mean_counts_tasks_alike():
    assert task_mean(scores([0.0, 0.0, 0.0], [1.0])) == 0.5


def test_the_rank_test_is_exact():
    few, many = np.array([1.0, 2.0, 3.0]), np.array([4.0, 5.0, 6.0])
    assert rank_test(few, many) == 1 / 20 and rank_test(many, few) == 1.0
    assert rank_test(few, np.array([4.0])) == 1 / 4
    five = np.arange(5.0)
    assert rank_test(five, five + 10.0) == 1 / 252


def test_the_rank_test_counts_all_divisions_that_are_as_clear():
    rng = np.random.default_rng(2)
    for _ in range(30):
        pooled = rng.integers(0, 4, size=8).astype(float)
        pooled[pooled == 3.0] = np.inf
        count = int(rng.integers(1, 8))
        middle = [sum(pooled < x) + 0.5 * (sum(pooled == x) + 1) for x in pooled]
        sums = [sum(of) for of in itertools.combinations(middle, count)]
        expected = np.mean(np.array(sums) <= sum(middle[:count]))
        assert rank_test(pooled[:count], pooled[count:]) == pytest.approx(expected)


def test_a_course_that_ends_early_keeps_its_last_value():
    at, values = np.array([10.0, 20.0, 30.0]), np.array([NAN, 0.5, 0.9])
    found = carried_forward(at, values, np.array([5.0, 10.0, 20.0, 25.0, 30.0, 99.0]))
    assert np.isnan(found[:2]).all()
    assert found[2:].tolist() == [0.5, 0.5, 0.9, 0.9]
    assert np.isnan(carried_forward(at, np.full(3, NAN), at)).all()


def test_a_profile_is_the_share_of_runs_at_each_level_tasks_alike():
    table = scores([0.2, 0.8], [0.5])
    assert profile(table, np.array([0.1, 0.5, 0.8, 0.9])).tolist() == [1.0, 0.75, 0.25, 0.0]


def test_a_success_counts_at_its_own_level():
    for successes in range(1, 101):
        found = profile(scores([successes / 100]), LEVELS)
        assert found.tolist() == [1.0] * successes + [0.0] * (100 - successes)


def test_the_band_of_a_profile_holds_at_each_level():
    levels = np.array([0.5, 0.9])
    low, high = band(lambda drawn: profile(drawn, levels), scores([0.6, 0.6, 1.0]))
    assert (low[0], high[0]) == (1.0, 1.0) and low[1] == 0.0 and high[1] == 1.0
    assert band(lambda drawn: profile(drawn, levels), scores([0.6])) is None
