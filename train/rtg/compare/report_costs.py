"""Compares what each method needs to solve a task with what the reference method needs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import comb

import numpy as np
from numpy.typing import NDArray

from rtg.compare.estimates import rank_test
from rtg.compare.methods import RANDOMISED, REFERENCE
from rtg.compare.report_tables import NO_VALUE, is_randomised, mean_success, table
from rtg.compare.run_results import COSTS, THRESHOLD, Comparison, RunResult

Floats = NDArray[np.float64]
Runs = Sequence[RunResult]

CHANCE = 0.05  # p-value up to which a difference is told, in each direction
_COST_NAMES = {"interactions": "Interactions", "pushes": "Pushes", "cpu_s": "CPU seconds"}
_COST_HEADS = {"interactions": "interactions [1000]", "pushes": "pushes [1000]", "cpu_s": "CPU [s]"}
_UNITS = {"interactions": 1000.0, "pushes": 1000.0, "cpu_s": 1.0}
_FEWER, _MORE, _LEVEL = "fewer than", "more than", "not told apart from"
_FEW = "too few seeds to tell from"
NOTE = f"""\
Costs of the whole run, generation included and evaluations left out, until the policy solves
{THRESHOLD}: of `{REFERENCE}` the median, lowest and highest of the seeds; of the others the
median as a multiple of that one, with how many seeds get there if not all do. A median that
never gets there has no multiple. **Bold**: told apart from `{REFERENCE}` by an exact rank test
of the seeds, in which one that never gets there costs more than any that does. Chance makes a
difference as clear in {100 * CHANCE:.0f} % of comparisons at most, in each direction: three
seeds against three must not overlap at all. With many rows some will be bold by chance. Compared
are runs of one budget, and CPU seconds those of one kind of processor, device and precision.
Pushes are those of the forward simulator; reverse solves are in the table of run times.
`planner` searches anew from every start: its costs are those of one start, and in brackets is
after how many starts they exceed those of `{REFERENCE}`, if it solves as much. `{RANDOMISED}` is
left out, as its starts are others."""


def _costs(runs: Runs, cost: str) -> Floats:
    """Returns the cost of each run until it solves the task, infinite if it never does. [runs]

    The cost "interactions" leaves out runs without interactions.
    """
    shown = [run for run in runs if run.interacts or cost != "interactions"]
    needed = [run.cost_to_reach(THRESHOLD, cost) for run in shown]
    return np.array([np.inf if value is None else value for value in needed])


def _cpu_time(run: RunResult) -> tuple[object, ...] | None:
    """Returns what CPU seconds depend on beside the method; None if the run does not say."""
    names = ("device", "precision", "runs_in_process")
    found = (run.versions.get("processor"), *(run.summary.get(name) for name in names))
    return None if None in found or run.total_cost("cpu_s") is None else found


def _obstacle(reference: Runs, runs: Runs, cost: str) -> str:
    """Returns why costs of `runs` and `reference` are not comparable; "" if they are."""
    if any(run.is_planned for run in runs):
        return "planned"
    if len({run.budget for run in (*reference, *runs)}) > 1:
        return "other budget"
    kinds = {_cpu_time(run) for run in (*reference, *runs)}
    if cost == "cpu_s" and (None in kinds or len(kinds) > 1):
        return "not comparable"
    return ""


def _relation(reference: Floats, others: Floats) -> str:
    """Returns whether the reference needs fewer or more than the others, as far as can be told."""
    count = len(reference)
    if comb(count + len(others), count) * CHANCE < 1.0:
        return _FEW
    if rank_test(reference, others) <= CHANCE:
        return _FEWER
    return _MORE if rank_test(others, reference) <= CHANCE else _LEVEL


def _number(value: float, cost: str) -> str:
    return "never" if np.isinf(value) else f"{value / _UNITS[cost]:.3g}"


def _own_cell(runs: Runs, cost: str) -> str:
    costs = _costs(runs, cost)
    if len(costs) == 0 or (cost == "cpu_s" and any(_cpu_time(run) is None for run in runs)):
        return NO_VALUE
    middle, low, high = (_number(of(costs), cost) for of in (np.median, np.min, np.max))
    return middle if len(costs) == 1 or low == high else f"{middle} ({low}–{high})"


def _planned_cell(reference: Runs, runs: Runs, cost: str) -> str:
    """Returns the mean cost of a search from one start."""
    totals = [total for run in runs if (total := run.total_cost(cost)) is not None]
    if cost == "interactions" or not totals:
        return NO_VALUE
    of_start = float(np.mean(totals)) / runs[0].planned_starts
    words = f"{_number(of_start, cost)} a start"
    middle = float(np.median(_costs(reference, cost)))
    same = (
        cost != "cpu_s" or len({run.versions.get("processor") for run in (*reference, *runs)}) < 2
    )
    if not same or np.isinf(middle) or mean_success(runs) < THRESHOLD or of_start == 0.0:
        return words
    return f"{words} ({middle / of_start:.3g})"


def _cell(reference: Runs, runs: Runs, cost: str) -> str:
    obstacle = _obstacle(reference, runs, cost)
    if obstacle:
        is_planned = obstacle == "planned"
        return _planned_cell(reference, runs, cost) if is_planned else obstacle
    own, costs = _costs(reference, cost), _costs(runs, cost)
    if len(costs) == 0:
        return NO_VALUE
    solved = int(np.isfinite(costs).sum())
    middle, own_middle = float(np.median(costs)), float(np.median(own))
    has_ratio = np.isfinite(middle) and np.isfinite(own_middle) and own_middle > 0.0
    parts = [f"{middle / own_middle:.2f} ×"] if has_ratio else []
    parts += [f"{solved} of {len(costs)}"] if solved < len(costs) or not has_ratio else []
    words = ", ".join(parts) if solved else "never"
    return f"**{words}**" if _relation(own, costs) in (_FEWER, _MORE) else words


def _compared(comparison: Comparison, task: str) -> dict[str, list[RunResult]]:
    """Returns the runs on a task of all other labels with results, by label."""
    found = {
        label: comparison.done(task, label)
        for label in comparison.labels
        if label != REFERENCE and not is_randomised(label)
    }
    return {label: runs for label, runs in found.items() if runs}


def _sentence(reference: Runs, others: Mapping[str, Runs], cost: str) -> str:
    """Returns how the reference stands beside the other methods, swept settings left out."""
    own = _costs(reference, cost)
    found: dict[str, list[str]] = {_FEWER: [], _LEVEL: [], _MORE: [], _FEW: []}
    for label, runs in others.items():
        costs = _costs(runs, cost)
        if "@" not in label and len(costs) and not _obstacle(reference, runs, cost):
            found[_relation(own, costs)].append(f"`{label}`")
    parts = [f"{words} {', '.join(labels)}" for words, labels in found.items() if labels]
    return f"{_COST_NAMES[cost]}: {'; '.join(parts)}." if parts else ""


def cost_comparison(comparison: Comparison) -> str:
    """Returns sentences for each task, and the table of the figures behind them.

    Returns "" if there is no task with results of the reference and of another label.
    """
    sentences, rows = [], []
    for task in comparison.tasks:
        reference, others = comparison.done(task, REFERENCE), _compared(comparison, task)
        if not reference or not others:
            continue
        told = [said for cost in COSTS if (said := _sentence(reference, others, cost))]
        sentences += [f"- **{task}**. {' '.join(told)}"] if told else []
        rows.append([task, f"`{REFERENCE}`", *(_own_cell(reference, cost) for cost in COSTS)])
        for label, runs in others.items():
            rows.append([task, f"`{label}`", *(_cell(reference, runs, cost) for cost in COSTS)])
    if not rows:
        return ""
    shown = table(["task", "method", *(_COST_HEADS[cost] for cost in COSTS)], rows, left=2)
    lead = [f"What `{REFERENCE}` needs until it solves {THRESHOLD}:", "\n".join(sentences)]
    return "\n\n".join([*(lead if sentences else []), shown])
