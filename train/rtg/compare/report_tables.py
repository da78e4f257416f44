"""The tables of a comparison's report, in Markdown."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from rtg.compare import estimates
from rtg.compare.methods import METHODS, RANDOMISED, REFERENCE
from rtg.compare.run_results import THRESHOLD, Comparison, RunResult

Floats = NDArray[np.float64]
NO_VALUE = "–"


def table(head: Sequence[str], rows: Iterable[Sequence[str]], left: int = 1) -> str:
    """Returns a Markdown table, first `left` columns left-aligned. Escapes "|" in cells."""
    lines = [head, ["---"] * left + ["---:"] * (len(head) - left), *rows]
    escaped = ([cell.replace("|", "\\|") for cell in line] for line in lines)
    return "\n".join("| " + " | ".join(line) + " |" for line in escaped)


def spread(values: Sequence[float | None], form: str) -> str:
    """Returns mean ± standard deviation of the values that are not None, as text.

    If some are None, the text ends with "(k of n)". `form` is a format specification or "count".
    The form "count" has one decimal for means between 0 and 10, else none.
    """
    known = [value for value in values if value is not None]
    if not known:
        return NO_VALUE
    mean, std = estimates.mean_std(known)
    if form == "count":
        form = ".1f" if 0.0 < mean < 10.0 else ".0f"
    words = format(mean, form) + ("" if std is None else f" ± {format(std, form)}")
    return words if len(known) == len(values) else f"{words} ({len(known)} of {len(values)})"


def seed_ranges(numbers: Sequence[int]) -> str:
    """Writes seeds as ranges: 1, 2, 3, 5 -> 1-3, 5."""
    parts: list[list[int]] = []
    for number in sorted(numbers):
        if parts and number == parts[-1][-1] + 1:
            parts[-1].append(number)
        else:
            parts.append([number])
    return ", ".join(f"{p[0]}-{p[-1]}" if len(p) > 1 else f"{p[0]}" for p in parts)


def seeds_by_state(runs: Sequence[RunResult]) -> str:
    """Returns the seeds, grouped by the state of their runs."""
    found = []
    for state in dict.fromkeys(run.state for run in runs):
        numbers = seed_ranges([run.cell.seed for run in runs if run.state == state])
        found.append(numbers if state == "done" else f"{numbers} {state}")
    return "; ".join(found) or "not run"


def run_names(runs: Sequence[RunResult]) -> str:
    """Returns tasks, labels and seeds of `runs` in words.

    `runs` must be in the order of Comparison.
    """
    rows: dict[tuple[str, str], list[int]] = {}
    for run in runs:
        rows.setdefault((run.cell.task, run.cell.label), []).append(run.cell.seed)
    return "; ".join(
        f"{task} `{label}` {seed_ranges(of_row)}" for (task, label), of_row in rows.items()
    )


def thousands(value: float | None) -> float | None:
    return None if value is None else value / 1000.0


def _unchanged(value: float | None) -> float | None:
    return value


Column = tuple[str, str, str, Callable[[float | None], float | None]]
# Head, key of RunResult.figures(), `form` of spread(), conversion to the unit of the column.
_RESULT_COLUMNS: tuple[Column, ...] = (
    ("success", "success_rate", ".3f", _unchanged),
    ("length", "episode_length_mean", ".1f", _unchanged),
    ("roll-outs", "rollout_success", ".2f", _unchanged),
    ("at ⅓", "success_at_third", ".2f", _unchanged),
    ("to 0.70", "interactions_to_70", "count", thousands),
    (f"to {THRESHOLD}", "interactions_to_95", "count", thousands),
    (f"pushes to {THRESHOLD}", "pushes_to_95", "count", thousands),
    (f"CPU s to {THRESHOLD}", "cpu_s_to_95", "count", _unchanged),
)
_COST_COLUMNS: tuple[Column, ...] = (
    ("transitions", "transitions", "count", thousands),
    ("generation: pushes", "replays", "count", thousands),
    ("... CPU [s]", "generate_cpu_s", "count", _unchanged),
    ("... wall [s]", "generate_wall_s", "count", _unchanged),
    ("learning: interactions", "interactions", "count", thousands),
    ("... CPU [s]", "train_cpu_s", "count", _unchanged),
    ("... wall [s]", "train_wall_s", "count", _unchanged),
    ("all: pushes", "whole_pushes", "count", thousands),
    ("... CPU [s]", "whole_cpu_s", "count", _unchanged),
)


def _cell(done: Sequence[RunResult], column: Column) -> str:
    _, name, form, unit = column
    values = [unit(run.figures()[name]) for run in done]
    return "never" if "_to_" in name and _never_reach(done, name) else spread(values, form)


def _never_reach(done: Sequence[RunResult], cost: str) -> bool:
    """Returns whether no run that learns reaches the success that `cost` ends with."""
    reached = f"interactions_to_{cost.rpartition('_')[2]}"
    learners = [run.figures()[reached] for run in done if not run.is_planned]
    return bool(learners) and all(value is None for value in learners)


def _task_table(comparison: Comparison, task: str, columns: Sequence[Column]) -> str:
    """Returns a table with a row for each method, even without a result.

    Swept settings have one on the tasks that they were asked for on.
    """
    rows = []
    for label in comparison.labels:
        runs = comparison.row(task, label)
        if not runs and "@" in label:
            continue
        done = [run for run in runs if run.done]
        rows.append(
            [f"`{label}`", seeds_by_state(runs), *(_cell(done, column) for column in columns)]
        )
    return table(["method", "seeds", *(head for head, *_ in columns)], rows)


def results_table(comparison: Comparison, task: str) -> str:
    """Returns the table of the learning results of all labels on one task."""
    return _task_table(comparison, task, _RESULT_COLUMNS)


def cost_table(comparison: Comparison, task: str) -> str:
    """Returns the table of the costs of all labels on one task, in generation and learning."""
    return _task_table(comparison, task, _COST_COLUMNS)


def _shared_tasks(comparison: Comparison) -> list[str]:
    """Returns the tasks on which several labels have results; all tasks if there are none."""
    rows = {
        task: [bool(comparison.done(task, label)) for label in comparison.labels]
        for task in comparison.tasks
    }
    return [task for task in rows if sum(rows[task]) > 1] or comparison.tasks


def _scores(comparison: Comparison, tasks: Sequence[str], label: str) -> dict[str, Floats]:
    """Returns the final success of each seed by task, [seeds], for tasks with results."""
    found = {task: comparison.done(task, label) for task in tasks}
    return {
        task: np.array([run.summary["success_rate"] for run in runs])
        for task, runs in found.items()
        if runs
    }


def _with_interval(value: float, interval: tuple[float, float] | None) -> str:
    return f"{value:.3f}" + (f" [{interval[0]:.3f}, {interval[1]:.3f}]" if interval else "")


def is_randomised(label: str) -> bool:
    return label.split("@")[0] == RANDOMISED


def pooled_scores(comparison: Comparison) -> dict[str, dict[str, Floats]]:
    """Returns the final successes by label and task, [seeds], over the _shared_tasks()."""
    tasks = _shared_tasks(comparison)
    found = {label: _scores(comparison, tasks, label) for label in comparison.labels}
    return {label: scores for label, scores in found.items() if scores}


def pooled_table(comparison: Comparison) -> str:
    """Returns the table of statistics over all seeds of the _shared_tasks()."""
    head = [
        "method",
        "tasks",
        "IQM of the success",
        "mean",
        "lowest",
        f"runs of {THRESHOLD} or more",
        f"probability of a better run than `{REFERENCE}`",
    ]
    of_labels = pooled_scores(comparison)
    reference, rows = of_labels.get(REFERENCE, {}), []
    for label, scores in of_labels.items():
        values = list(scores.values())
        comparable = label != REFERENCE and not is_randomised(label)
        common = [task for task in scores if task in reference and comparable]
        pair = [scores[task] for task in common], [reference[task] for task in common]
        better = NO_VALUE
        if common:
            chance = estimates.probability_of_improvement(*pair)
            better = _with_interval(chance, estimates.improvement_interval(*pair))
        every = np.concatenate(values)
        rows.append(
            [
                f"`{label}`",
                str(len(scores)),
                *(
                    _with_interval(of(values), estimates.interval(of, values))
                    for of in (estimates.interquartile_mean, estimates.task_mean)
                ),
                f"{every.min():.3f}",
                f"{int((every >= THRESHOLD).sum())} of {len(every)}",
                better,
            ]
        )
    return table(head, rows)


def mean_success(runs: Sequence[RunResult]) -> float:
    """Returns the mean success of the final greedy policies."""
    return estimates.mean_std([run.summary["success_rate"] for run in runs])[0]


def _ratio(
    above: str, below: Callable[[RunResult], float], scale: float
) -> Callable[[RunResult], float | None]:
    """Returns the function run -> `scale` * summary[`above`] / `below`(run).

    The function returns None if the summary lacks `above` or if `below`(run) is 0.
    """

    def of(run: RunResult) -> float | None:
        value, count = run.summary.get(above), below(run)
        return None if value is None or not count else scale * value / count

    return of


def _count(name: str) -> Callable[[RunResult], float]:
    return lambda run: float(run.summary.get(name) or 0)


def _solve_count(run: RunResult) -> float:
    return _count("candidates")(run) - _count("pruned")(run)


def _summary_value(name: str) -> Callable[[RunResult], float | None]:
    return lambda run: run.summary.get(name)


_RUNTIME_COLUMNS: tuple[tuple[str, Callable[[RunResult], float | None], str], ...] = (
    ("backward action [ms]", _ratio("reverse_cpu_s", _solve_count, 1e3), ".2f"),
    ("forward action [ms]", _ratio("replay_cpu_s", _count("replays"), 1e3), ".3f"),
    ("solves [1000]", lambda run: _solve_count(run) / 1000.0, "count"),
    ("pushes [1000]", lambda run: thousands(run.summary.get("replays")), "count"),
    ("converged", _ratio("converged", _solve_count, 1.0), ".3f"),
    ("of these, moving an object", _ratio("pushing_converged", _count("converged"), 1.0), ".2f"),
    ("iterations, median", _summary_value("pushing_iterations_median"), ".0f"),
    ("90th percentile", _summary_value("pushing_iterations_p90"), ".0f"),
)
_DATA_COLUMNS: tuple[tuple[str, Callable[[RunResult], float | None], str], ...] = (
    ("transitions [1000]", lambda run: thousands(run.summary.get("transitions")), "count"),
    ("tree rows", lambda run: thousands(run.summary.get("tree_transitions")), "count"),
    ("branches", lambda run: thousands(run.summary.get("branch_transitions")), "count"),
    ("headings per state", _summary_value("headings_per_state"), ".1f"),
    ("contact share", _summary_value("contact_share"), ".2f"),
    ("trees", _summary_value("trees"), "count"),
    ("replay gap, median [m]", _summary_value("replay_gap_median"), ".4f"),
    ("90th percentile [m]", _summary_value("replay_gap_p90"), ".4f"),
    ("rank correlation of Q", _summary_value("q_rank_correlation"), ".2f"),
    ("error", _summary_value("q_error"), ".3f"),
    ("spread", _summary_value("q_spread"), ".3f"),
)


def _method_table(
    comparison: Comparison,
    made: str,
    columns: Sequence[tuple[str, Callable[[RunResult], float | None], str]],
    more: Sequence[Sequence[str]] = (),
) -> str:
    """Returns a table with a row for each task and label, and the rows `more` if it has any.

    Runs whose summary has no count `made` above 0 have no figures. If no run has, there is no row.
    """
    rows = []
    for task in comparison.tasks:
        for label in comparison.labels:
            done = comparison.done(task, label)
            has_figures = [bool(run.summary.get(made)) for run in done]
            if not any(has_figures):
                continue
            cells = []
            for _, of, form in columns:
                found = zip(done, has_figures, strict=True)
                cells.append(spread([of(run) if has else None for run, has in found], form))
            rows.append([task, f"`{label}`", *cells])
    heads = ["task", "method", *(name for name, _, _ in columns)]
    shown = [[*row, *([""] * (len(heads) - len(row)))] for row in more] if rows else []
    return table(heads, [*rows, *shown], left=2)


_OF_THE_PAPER = (
    ("tasks with joints", "the paper", "51.0", "1.07"),
    ("tasks without joints", "the paper", "39.6", "1.07"),
)


def runtime_table(comparison: Comparison) -> str:
    """Returns the table of computing times per reverse solve and per push (Appendix E)."""
    return _method_table(comparison, "candidates", _RUNTIME_COLUMNS, _OF_THE_PAPER)


def data_table(comparison: Comparison) -> str:
    """Returns the table on the data: amount, coverage, replay gap (Appendix F), accuracy of Q."""
    return _method_table(comparison, "transitions", _DATA_COLUMNS)


def not_run(comparison: Comparison) -> list[str]:
    """Returns the methods that are not part of the comparison."""
    asked = {run.cell.method for run in comparison.results}
    return [method for method in METHODS if method not in asked]
