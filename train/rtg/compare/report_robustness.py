"""The part of a report on policies where they were not trained, from `./run.sh evaluate`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from rtg.compare import report_plots
from rtg.compare.report_tables import NO_VALUE, spread, table
from rtg.compare.run_results import Comparison, RunResult
from rtg.learn.robustness import AS_TRAINED
from rtg.pictures import plots

NOTE = """\
Success of the final policies (`./run.sh evaluate`), means ± standard deviations over the seeds
(in brackets how many, and of how many episodes each): from other starts, with Gaussian noise on
the poses that the policy sees, with friction of all bodies, masses of the objects or strides
multiplied, with bodies that coast after a push, in other simulators, if these are installed and
have what the task needs. Objects that are not moved have one start in most tasks, so that a seed
has 0 or 1 there. Starts outside the arena, or in which bodies overlap, are drawn anew.
`ddqn_rtg_dr` has its own, wider starts in all rows but those of moved objects."""
_Name = tuple[str, str]  # group and label of a variant
# Groups of variants that the picture shows, with the name of their axis, and the amount as trained.
PANELS = (
    ("objects moved", "objects moved by up to [m]", None),
    ("objects turned", "objects turned by up to [rad]", 0.0),
    ("noise of poses", "noise of poses, standard deviation [m]", 0.0),
    ("friction", "friction of all bodies, factor", 1.0),
    ("mass of objects", "mass of objects, factor", 1.0),
    ("stride", "stride, factor", 1.0),
)


def _evaluated(comparison: Comparison, task: str) -> dict[str, list[RunResult]]:
    """Returns the runs that have been evaluated, by label."""
    found = {
        label: [run for run in comparison.done(task, label) if run.evaluation]
        for label in comparison.labels
    }
    return {label: runs for label, runs in found.items() if runs}


def is_evaluated(comparison: Comparison, task: str) -> bool:
    return bool(_evaluated(comparison, task))


def _by_variant(run: RunResult) -> dict[_Name, float | None]:
    """Returns the success of a run by group and label of the variant; None if not possible."""
    return {(row["group"], row["label"]): row["success"] for row in run.evaluation}


def robustness_table(comparison: Comparison, task: str) -> str:
    """Returns a table with a row for each variant and a column for each label."""
    found = {
        label: [_by_variant(run) for run in runs]
        for label, runs in _evaluated(comparison, task).items()
    }
    variants = dict.fromkeys(variant for runs in found.values() for run in runs for variant in run)
    rows = [[*variant, *(_cell(runs, variant) for runs in found.values())] for variant in variants]
    heads = [_head(label, runs) for label, runs in _evaluated(comparison, task).items()]
    return table([task, "", *heads], rows, left=2)


def _cell(runs: Sequence[Mapping[_Name, float | None]], variant: _Name) -> str:
    words = spread([run.get(variant) for run in runs], ".2f")
    was_tried = any(variant in run for run in runs)
    return "not possible" if words == NO_VALUE and was_tried else words


def _head(label: str, runs: Sequence[RunResult]) -> str:
    episodes = sorted({row["episodes"] for run in runs for row in run.evaluation})
    return f"`{label}` ({len(runs)} × {' or '.join(map(str, episodes))})"


def _line(rows: Sequence[Mapping[str, Any]], group: str, trained: float | None) -> dict[float, Any]:
    """Returns the success of one run by the amount of a group of variants."""
    amounts = {group: None, AS_TRAINED: trained}
    shown = [row for row in rows if row["group"] in amounts]
    by_amount = {
        amounts[row["group"]] if row["amount"] is None else row["amount"]: row["success"]
        for row in shown
    }
    return {amount: success for amount, success in by_amount.items() if amount is not None}


def robustness(path: Path, comparison: Comparison, task: str) -> None:
    """Plots the success over the amount of each group of variants, a line per label."""
    runs_by_label = _evaluated(comparison, task)
    styles = report_plots.line_styles(list(runs_by_label))
    with plots.style():
        figure, axes = plt.subplots(2, 3, figsize=(9.6, 6.2), layout="constrained", sharey=True)
        for axis, (group, name, trained) in zip(axes.flat, PANELS, strict=True):
            for label, runs in runs_by_label.items():
                lines = [_line(run.evaluation, group, trained) for run in runs]
                grid = sorted(set().union(*lines))
                values = np.array([[line.get(by) for by in grid] for line in lines], float)
                report_plots.draw_curve(axis, (np.array(grid), values), True, styles[label])
            axis.set(xlabel=name, ylim=(-0.03, 1.03))
        for axis in axes[:, 0]:
            axis.set_ylabel("success")
        title = f"{task}: success where it was not trained, mean ± standard deviation of the seeds"
        report_plots.add_legend(figure, runs_by_label, title)
        plots.save(figure, path)
