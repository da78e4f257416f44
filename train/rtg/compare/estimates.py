"""Figures over seeds and tasks, after Agarwal et al. 2021 (the measures of `rliable`).

A score table is a list with the scores of one method per task, [seeds] each.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Scores = Sequence[Floats]  # per task [seeds]

RESAMPLES = 2000
_SEED = 0
_LEVEL = 0.95


def mean_std(values: Sequence[float]) -> tuple[float, float | None]:
    """Mean and sample standard deviation; None of a single value."""
    return float(np.mean(values)), float(np.std(values, ddof=1)) if len(values) > 1 else None


def interquartile_mean(scores: Scores) -> float:
    """Mean of the middle half of all scores: a quarter, rounded down, is cut off at either end."""
    ordered = np.sort(np.concatenate(scores))
    cut = len(ordered) // 4
    return float(ordered[cut : len(ordered) - cut].mean())


def probability_of_improvement(scores: Scores, others: Scores) -> float:
    """That a run scores above one of the other method on the same task, mean over the tasks.

    Equal scores count half: the statistic of Mann and Whitney.
    """
    wins = [np.sign(x[:, None] - y[None, :]).mean() for x, y in zip(scores, others, strict=True)]
    return 0.5 + 0.5 * float(np.mean(wins))


def _are_single(scores: Scores) -> bool:
    return all(len(task) == 1 for task in scores)


def interval(estimate: Callable[[Scores], float], scores: Scores) -> tuple[float, float] | None:
    """Percentile interval of `estimate` by stratified bootstrap: seeds are drawn within a task. Of
    single seeds None."""
    if _are_single(scores):
        return None
    rng = np.random.default_rng(_SEED)
    drawn = [
        estimate([task[rng.integers(len(task), size=len(task))] for task in scores])
        for _ in range(RESAMPLES)
    ]
    low, high = np.quantile(drawn, [(1 - _LEVEL) / 2, (1 + _LEVEL) / 2])
    return float(low), float(high)


def improvement_interval(scores: Scores, others: Scores) -> tuple[float, float] | None:
    """The same of the probability of improvement: seeds of both methods are drawn. None if either
    has single seeds alone."""
    if _are_single(scores) or _are_single(others):
        return None
    count = len(scores)
    return interval(
        lambda drawn: probability_of_improvement(drawn[:count], drawn[count:]), [*scores, *others]
    )


def first_reach(interactions: Floats, success: Floats, bar: float) -> int | None:
    """Interactions at the first evaluation with that success or more; None: never. [N] each"""
    reached = np.flatnonzero(success >= bar)
    return int(interactions[reached[0]]) if len(reached) else None


def carried_forward(interactions: Floats, values: Floats, grid: Floats) -> Floats:
    """A course on another grid: the last value before, that of the end from there on. [grid]

    NaN before the first value.
    """
    known = np.isfinite(values)
    at = np.searchsorted(interactions[known], grid, side="right") - 1
    found = np.append(values[known], np.nan)
    return found[np.where(at < 0, -1, at)]
