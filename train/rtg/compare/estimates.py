"""Statistics over seeds and tasks, after Agarwal et al. 2021 (the measures of `rliable`).

`Scores` are the scores of one method: an array [seeds] per task.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Scores = Sequence[Floats]  # per task [seeds]

RESAMPLES = 2000
_SEED = 0
_LEVEL = 0.95


def mean_std(values: Sequence[float]) -> tuple[float, float | None]:
    """Returns mean and sample standard deviation. The deviation of a single value is None."""
    return float(np.mean(values)), float(np.std(values, ddof=1)) if len(values) > 1 else None


def interquartile_mean(scores: Scores) -> float:
    """Returns the mean of the middle half of all scores.

    A quarter of the scores, rounded down, is cut off at each end.
    """
    ordered = np.sort(np.concatenate(scores))
    cut = len(ordered) // 4
    return float(ordered[cut : len(ordered) - cut].mean())


def task_mean(scores: Scores) -> float:
    """Returns the mean over the tasks of the mean of each task."""
    return float(np.mean([task.mean() for task in scores]))


def probability_of_improvement(scores: Scores, others: Scores) -> float:
    """Returns the probability that a run of `scores` beats a run of `others` on the same task.

    It is the mean of the Mann-Whitney statistic over the tasks: equal scores count half.
    """
    wins = [np.sign(x[:, None] - y[None, :]).mean() for x, y in zip(scores, others, strict=True)]
    return 0.5 + 0.5 * float(np.mean(wins))


def _are_single(scores: Scores) -> bool:
    return all(len(task) == 1 for task in scores)


def profile(scores: Scores, levels: Floats) -> Floats:
    """Returns the performance profile: the share of runs with a score of each level or more.

    It is the mean over the tasks. [levels]
    """
    return np.mean([(task[:, None] >= levels).mean(axis=0) for task in scores], axis=0)


def band(estimate: Callable[[Scores], Floats], scores: Scores) -> tuple[Floats, Floats] | None:
    """Returns the 95 % percentile intervals of the values of `estimate` by stratified bootstrap.

    Resamples the seeds of each task. Returns None if every task has a single seed.
    """
    if _are_single(scores):
        return None
    rng = np.random.default_rng(_SEED)
    drawn = [
        estimate([task[rng.integers(len(task), size=len(task))] for task in scores])
        for _ in range(RESAMPLES)
    ]
    low, high = np.quantile(drawn, [(1 - _LEVEL) / 2, (1 + _LEVEL) / 2], axis=0)
    return low, high


def interval(estimate: Callable[[Scores], float], scores: Scores) -> tuple[float, float] | None:
    """Returns the band() of a single value."""
    found = band(lambda drawn: np.array(estimate(drawn)), scores)
    return None if found is None else (float(found[0]), float(found[1]))


def improvement_interval(scores: Scores, others: Scores) -> tuple[float, float] | None:
    """Returns the interval() of probability_of_improvement().

    Resamples the seeds of both methods. Returns None if a method has a single seed on every task.
    """
    if _are_single(scores) or _are_single(others):
        return None
    count = len(scores)
    return interval(
        lambda drawn: probability_of_improvement(drawn[:count], drawn[count:]), [*scores, *others]
    )


def rank_test(values: Floats, others: Floats) -> float:
    """Returns the one-sided p-value that `values` are smaller than `others`.

    It is that of the exact rank test [Mann and Whitney 1947]: the share of all ways to divide the
    numbers into groups of these sizes in which the rank sum of the first one is as low. Equal
    numbers, infinite ones too, have the mean of their ranks.
    """
    pooled = np.concatenate([values, others])
    # Twice the rank of each number, less 1: a whole number.
    twice_ranks = [int(2 * (pooled < x).sum() + (pooled == x).sum()) for x in pooled]
    # How many ways there are to choose 0, 1, ... numbers, by their sum of ranks.
    ways = [Counter({0: 1}), *(Counter[int]() for _ in values)]
    for rank in twice_ranks:
        for size in range(len(values), 0, -1):
            for total, count in ways[size - 1].items():
                ways[size][total + rank] += count
    low = sum(twice_ranks[: len(values)])
    return sum(n for total, n in ways[-1].items() if total <= low) / ways[-1].total()


def first_reach(success: Floats, threshold: float) -> int | None:
    """Returns the index of the first of two values in a row with `success` >= `threshold`.

    Returns None if there are none. One value alone may be luck. `success`: [values].
    """
    reached = success >= threshold
    both = np.flatnonzero(reached[:-1] & reached[1:])
    return int(both[0]) if len(both) else None


def carried_forward(interactions: Floats, values: Floats, grid: Floats) -> Floats:
    """Resamples the curve `values` over `interactions` at the points `grid`. [grid]

    Each point gets the last finite value up to it, NaN if there is none. Beyond the end of the
    curve its last value holds.
    """
    known = np.isfinite(values)
    at = np.searchsorted(interactions[known], grid, side="right") - 1
    found = np.append(values[known], np.nan)
    return found[np.where(at < 0, -1, at)]
