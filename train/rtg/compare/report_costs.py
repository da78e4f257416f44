"""Compares what each method needs to solve a task with what the reference method needs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from rtg.compare.estimates import rank_test
from rtg.compare.methods import RANDOMISED, REFERENCE
from rtg.compare.report_tables import NO_VALUE, is_randomised, spread, table, thousands
from rtg.compare.run_results import COSTS, THRESHOLD, Comparison, RunResult

Floats = NDArray[np.float64]

CHANCE = 0.05  # a difference is told where chance makes one as clear no more often
_COST_NAMES = {"interactions": "Interactions", "pushes": "Pushes", "cpu_s": "CPU seconds"}
_COST_HEADS = {"interactions": "interactions [1000]", "pushes": "pushes [1000]", "cpu_s": "CPU [s]"}
_FEWER, _MORE, _LEVEL = "fewer than", "more than", "not told apart from"
NOTE = f"""\
Costs of the whole run, generation included and evaluations left out, until the policy solves
{THRESHOLD}: of `{REFERENCE}` as mean ± standard deviation of the seeds; of the others as multiples,
median by median, with how many seeds get there if not all do. A median that never gets there has no
multiple. **Bold**: cheaper or dearer than `{REFERENCE}` by an exact rank test of the seeds, in
which one that never gets there costs more than any that does; chance makes a difference as clear in
no more than {100 * CHANCE:.0f} % of comparisons (one-sided: three seeds against three must not
overlap at all, and single seeds never suffice). With many rows some will be bold by chance. CPU
seconds are compared only on one kind of processor. Pushes are those of the forward simulator;
reverse solves are in the table of run times. `planner` searches anew from every start: its costs
are those of one start, and in brackets is after how many starts they exceed those of `{REFERENCE}`.
`{RANDOMISED}` is left out, as its starts are others."""


def _costs(runs: Sequence[RunResult], cost: str) -> Floats:
    """Returns the cost of each run until it solves the task, infinite if it never does. [runs]

    The cost "interactions" leaves out runs without interactions.
    """
    shown = [run for run in runs if run.interacts or cost != "interactions"]
    needed = [run.cost_to_reach(THRESHOLD, cost) for run in shown]
    return np.array([np.inf if value is None else value for value in needed])


def _processors(runs: Sequence[RunResult]) -> set[str | None]:
    return {run.versions.get("processor") for run in runs}


def _relation(reference: Floats, costs: Floats) -> str:
    """Returns whether the reference needs fewer or more than `costs`, or is level with them."""
    if rank_test(reference, costs) <= CHANCE:
        return _FEWER
    return _MORE if rank_test(costs, reference) <= CHANCE else _LEVEL


def _are_comparable(reference: Sequence[RunResult], runs: Sequence[RunResult], cost: str) -> bool:
    if any(run.is_planned for run in runs):
        return False
    return cost != "cpu_s" or len(_processors([*reference, *runs])) == 1


def _own_cell(runs: Sequence[RunResult], cost: str) -> str:
    costs = [value if np.isfinite(value) else None for value in _costs(runs, cost)]
    if costs and not any(value is not None for value in costs):
        return "never"
    return spread(costs if cost == "cpu_s" else [thousands(value) for value in costs], "count")


def _planned_cell(reference: Floats, runs: Sequence[RunResult], cost: str) -> str:
    """Returns the mean cost of a search from one start."""
    totals = [run.total_cost(cost) or 0.0 for run in runs]
    starts = sum(run.summary.get("final_episodes") or 0 for run in runs)
    if cost == "interactions" or not starts:
        return NO_VALUE
    of_start = sum(totals) / starts
    words = f"{of_start if cost == 'cpu_s' else of_start / 1000.0:.3g} a start"
    after = float(np.median(reference)) / of_start if len(reference) and of_start else np.inf
    return f"{words} ({after:.3g})" if np.isfinite(after) else words


def _cell(reference: Sequence[RunResult], runs: Sequence[RunResult], cost: str) -> str:
    own, costs = _costs(reference, cost), _costs(runs, cost)
    if any(run.is_planned for run in runs):
        return _planned_cell(own, runs, cost)
    if len(costs) == 0:
        return NO_VALUE
    if not _are_comparable(reference, runs, cost):
        return "other processor"
    solved = int(np.isfinite(costs).sum())
    middle, own_middle = float(np.median(costs)), float(np.median(own))
    has_ratio = np.isfinite(middle) and np.isfinite(own_middle) and own_middle > 0.0
    parts = [f"{middle / own_middle:.2f} ×"] if has_ratio else []
    parts += [f"{solved} of {len(costs)}"] if solved < len(costs) or not has_ratio else []
    words = ", ".join(parts) if solved else "never"
    return words if _relation(own, costs) == _LEVEL else f"**{words}**"


def _compared(comparison: Comparison, task: str) -> dict[str, list[RunResult]]:
    """Returns the runs on a task of all other labels with results, by label."""
    found = {
        label: comparison.done(task, label)
        for label in comparison.labels
        if label != REFERENCE and not is_randomised(label)
    }
    return {label: runs for label, runs in found.items() if runs}


def _sentence(
    reference: Sequence[RunResult], others: Mapping[str, Sequence[RunResult]], cost: str
) -> str:
    """Returns how the reference stands beside the other methods, swept settings left out."""
    own = _costs(reference, cost)
    found: dict[str, list[str]] = {_FEWER: [], _LEVEL: [], _MORE: []}
    for label, runs in others.items():
        costs = _costs(runs, cost)
        if "@" not in label and len(costs) and _are_comparable(reference, runs, cost):
            found[_relation(own, costs)].append(f"`{label}`")
    parts = [f"{words} {', '.join(labels)}" for words, labels in found.items() if labels]
    return f"{_COST_NAMES[cost]}: {'; '.join(parts)}." if parts else ""


def has_comparison(comparison: Comparison) -> bool:
    """Returns whether there is a task with results of the reference and of another label."""
    return any(
        comparison.done(task, REFERENCE) and _compared(comparison, task)
        for task in comparison.tasks
    )


def cost_comparison(comparison: Comparison) -> str:
    """Returns sentences for each task, and the table of the figures behind them."""
    sentences, rows = [], []
    for task in comparison.tasks:
        reference, others = comparison.done(task, REFERENCE), _compared(comparison, task)
        if not reference or not others:
            continue
        told = [said for cost in COSTS if (said := _sentence(reference, others, cost))]
        sentences += [f"- **{task}**. {' '.join(told)}"] if told else []
        rows.append([task, f"`{REFERENCE}`", *(_own_cell(reference, cost) for cost in COSTS)])
        for label, runs in others.items():
            cells = [_cell(reference, runs, cost) for cost in COSTS]
            rows.append([task, f"`{label}`", *cells])
    shown = table(["task", "method", *(_COST_HEADS[cost] for cost in COSTS)], rows, left=2)
    lead = [f"What `{REFERENCE}` needs until it solves {THRESHOLD}:", "\n".join(sentences)]
    return "\n\n".join([*(lead if sentences else []), shown])
