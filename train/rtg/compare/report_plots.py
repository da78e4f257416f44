"""Plots of a comparison: learning curves, costs, profiles, replay gaps, swept settings."""

from __future__ import annotations

import os
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, LogLocator, MaxNLocator, NullFormatter
from numpy.typing import NDArray

from rtg.compare.estimates import band, carried_forward, profile
from rtg.compare.methods import METHODS
from rtg.compare.report_tables import mean_success
from rtg.compare.run_results import THRESHOLD, Comparison, RunResult
from rtg.pictures import plots

Floats = NDArray[np.float64]

# Colour and line style of each method. Most colours are those of Okabe and Ito, which colour-blind
# people can distinguish. The others differ as clearly from all colours with the same line style.
# Dashed: methods without generated data; dash-dotted: methods without interactions.
_PALETTE = {
    "dqn": ("#b0b0b0", "--"),
    "ddqn": ("#000000", "--"),
    "ddqn_random": ("#8c564b", "-"),
    "ddqn_scatter": ("#6c2273", "-"),
    "ddqn_naive": ("#56b4e9", "-"),
    "ddqn_forward": ("#d55e00", "-"),
    "ddqn_rtg": ("#0072b2", "-"),
    "ddqn_rtg_dr": ("#cc79a7", "-"),
    "her": ("#009e73", "--"),
    "rcg": ("#e69f00", "--"),
    "cql_rtg": ("#5d3a9b", "-."),
    "bc_rtg": ("#00707a", "-."),
    "planner": ("#a50026", "-."),
}
LEVELS = np.arange(1, 101) / 100  # of performance profiles: k / 100 as in successes
_LINE_STYLES = ("-", "--", "-.", ":")
_COSTS = {
    "interactions": "interactions (dash-dotted: rounds of learning)",
    "pushes": "simulator pushes, generation included",
    "cpu_s": "CPU time of the whole run [s]",
}
_PANELS = (
    ("greedy success, held-out starts", "success_rate"),
    ("success of training roll-outs", "rollout_success"),
    ("episode length, greedy [actions]", "episode_length_mean"),
    ("return, greedy, discounted as in learning", "episode_return_mean"),
)
_SHARE_COLUMNS = ("success_rate", "rollout_success")
_MAX_CURVES = len(METHODS)
_THRESHOLD_COLOUR = "#8a8d93"
_RIGHT_ALIGNED: dict[str, Any] = {"ha": "right", "va": "center", "fontsize": 8}


def line_styles(labels: Sequence[str]) -> dict[str, tuple[str, str]]:
    """Returns colour and line style of each label (method with swept settings).

    Each method has its colour. If a method has several labels, all labels get shades instead.
    """
    if len({label.split("@")[0] for label in labels}) == len(labels):
        return {label: _PALETTE.get(label.split("@")[0], ("#000000", "-")) for label in labels}
    shades = plt.get_cmap("viridis")(np.linspace(0.0, 0.9, len(labels)))
    colours = [to_hex(shade) for shade in shades]
    return {
        label: (colours[k], _LINE_STYLES[k % len(_LINE_STYLES)]) for k, label in enumerate(labels)
    }


def split_names(labels: Sequence[str]) -> tuple[str, list[str]]:
    """Splits all labels into their common beginning and the rest of each label.

    The beginning ends with a method or a key.
    """
    shared = os.path.commonprefix(labels)
    end = max(shared.rfind("@"), shared.rfind("=")) + 1
    return shared[:end].rstrip("@=").replace("@", ", "), [label[end:] for label in labels]


def _aligned_curves(runs: Sequence[RunResult], column: str) -> tuple[Floats, Floats]:
    """Returns the interactions of all evaluations [N] and the values there [runs, N].

    A run that ended early keeps its last value.
    """
    grid = np.unique(np.concatenate([run.curve["interactions"] for run in runs]))
    values = [carried_forward(run.curve["interactions"], run.curve[column], grid) for run in runs]
    return grid, np.array(values)


def draw_curve(
    axis: Axes,
    curve: tuple[Floats, Floats],
    is_share: bool,
    style: tuple[str, str],
    end: float | None = None,
) -> None:
    """Draws mean and standard deviation over the seeds, at points where all seeds have a value.

    A dot is where the curve stops, or at the value `end` there.
    """
    grid, values = curve
    known = np.isfinite(values).all(axis=0)
    if not known.any():
        return
    grid, values = grid[known], values[:, known]
    mean = values.mean(axis=0)
    colour, line_style = style
    axis.plot(grid, mean, color=colour, ls=line_style, lw=2.0)
    last = mean[-1] if end is None else end
    axis.plot(grid[[-1, -1]], [mean[-1], last], color=colour, marker="o", markevery=[1], lw=0.8)
    if len(values) > 1:
        spread = values.std(axis=0, ddof=1)
        low, high = mean - spread, mean + spread
        if is_share:
            low, high = np.clip(low, 0.0, 1.0), np.clip(high, 0.0, 1.0)
        axis.fill_between(grid, low, high, color=colour, alpha=0.18, lw=0)
        if len(grid) == 1:  # of one point the area is empty
            axis.vlines(grid, low, high, color=colour, alpha=0.4, lw=2.0)


def curve_labels(comparison: Comparison, task: str) -> list[str]:
    """Returns the labels (methods with swept settings) that have learning curves.

    If there are too many to tell apart, leaves out labels with swept settings.
    """
    found = [
        label
        for label in comparison.labels
        if any(run.curve for run in comparison.done(task, label))
    ]
    few = len(found) <= _MAX_CURVES
    return found if few else [label for label in found if "@" not in label]


RunsByLabel = Mapping[str, Sequence[RunResult]]  # by label


def _runs_with_curves(comparison: Comparison, task: str) -> RunsByLabel:
    labels = curve_labels(comparison, task)
    return {label: [r for r in comparison.done(task, label) if r.curve] for label in labels}


def _wrapped(words: str, width: int) -> str:
    """Wraps words of names, which may be broken before a setting alone."""
    return textwrap.fill(
        words.replace("@", " @"), width, break_long_words=False, break_on_hyphens=False
    )


def add_legend(figure: Figure, runs_by_label: RunsByLabel, title: str, columns: int = 4) -> None:
    """Adds the title above the panels and the legend below them.

    The legend shows the mean final success and the number of seeds of each label, in `columns` or
    as many as fit.
    """
    styles = line_styles(list(runs_by_label))
    handles = [
        plt.Line2D([], [], color=styles[label][0], ls=styles[label][1], lw=2)
        for label in runs_by_label
    ]
    shared, names = split_names(list(runs_by_label))
    words = [
        _wrapped(f"{name}: {mean_success(runs):.2f} ({len(runs)})", 60)
        for name, runs in zip(names, runs_by_label.values(), strict=True)
    ]
    for count in range(columns, 0, -1):
        legend = figure.legend(
            handles,
            words,
            loc="outside lower left",
            ncols=count,
            frameon=False,
            handlelength=3.0,
            title=f"{shared or 'method'}: final success (seeds)",
            alignment="left",
        )
        if count == 1 or legend.get_window_extent().width <= figure.bbox.width:
            break
        legend.remove()
    plots.headline(figure, title)


def _name_hidden(axis: Axes, runs_by_label: RunsByLabel) -> None:
    """Names below the panel the labels whose lines hide each other, with a success of 0."""
    at_zero = [
        label
        for label, runs in runs_by_label.items()
        if all(np.nanmax(run.curve["success_rate"], initial=0.0) == 0.0 for run in runs)
    ]
    if len(at_zero) > 1:
        words = _wrapped(f"always 0: {', '.join(split_names(at_zero)[1])}", 70)
        axis.set_xlabel(words, loc="right", fontsize=8)


def curves(path: Path, comparison: Comparison, task: str) -> None:
    """Plots success, episode length and return over interactions, a line per label.

    Leaves out methods without interactions.
    """
    runs_by_label = {
        name: runs
        for name, runs in _runs_with_curves(comparison, task).items()
        if runs[0].interacts
    }
    styles = line_styles(list(runs_by_label))
    with plots.style():
        figure, axes = plt.subplots(2, 2, figsize=(9.6, 6.8), layout="constrained", sharex=True)
        for axis, (name, column) in zip(axes.flat, _PANELS, strict=True):
            for label, runs in runs_by_label.items():
                grid, values = _aligned_curves(runs, column)
                end = mean_success(runs) if column == "success_rate" else None
                curve = grid / 1000.0, values
                draw_curve(axis, curve, column in _SHARE_COLUMNS, styles[label], end)
            axis.set_title(name)
            if column in _SHARE_COLUMNS:
                axis.set_ylim(-0.03, 1.03)
            else:
                axis.set_ylim(bottom=0.0)
        _name_hidden(axes[0, 0], runs_by_label)
        for axis in axes[-1]:
            axis.set_xlabel("interactions / 1000")
            axis.set_xlim(left=0.0)
        title = (
            f"{task}: mean ± standard deviation of the seeds; dots of greedy success: final one, "
            "from other starts"
        )
        add_legend(figure, runs_by_label, title)
        plots.save(figure, path)


def scale_cost(axis: Axes) -> None:
    """Makes the x-axis logarithmic, with some labels that do not overlap, whatever its range."""
    axis.set_xscale("log")
    low, high = axis.get_xlim()
    is_wide = high >= 10.0 * low
    few = LogLocator(subs=(1.0, 3.0)) if is_wide else MaxNLocator(4, steps=[1, 2, 5, 10])
    axis.xaxis.set_major_locator(few)
    axis.xaxis.set_major_formatter(EngFormatter(sep=""))
    axis.xaxis.set_minor_formatter(NullFormatter())


def costs(path: Path, comparison: Comparison, task: str) -> None:
    """Plots greedy success over each cost, on a logarithmic axis, with a line per label.

    Success and cost are means over the seeds after the same number of interactions.
    """
    runs_by_label = _runs_with_curves(comparison, task)
    styles = line_styles(list(runs_by_label))
    with plots.style():
        figure, axes = plt.subplots(1, 3, figsize=(12.6, 5.0), layout="constrained", sharey=True)
        for axis, (cost, name) in zip(axes, _COSTS.items(), strict=True):
            for label, runs in runs_by_label.items():
                mean_cost = _aligned_curves(runs, cost)[1].mean(axis=0)
                values = _aligned_curves(runs, "success_rate")[1]
                shown = mean_cost > 0.0
                curve = mean_cost[shown], values[:, shown]
                draw_curve(axis, curve, True, styles[label], mean_success(runs))
            axis.axhline(THRESHOLD, color=_THRESHOLD_COLOUR, lw=0.8, zorder=0)
            axis.set(xlabel=name, ylim=(-0.03, 1.03))
            scale_cost(axis)
        axes[0].set_ylabel("greedy success, held-out starts")
        title = (
            f"{task}: success against the mean cost, mean ± standard deviation of the seeds; dots: "
            "final success, from other starts"
        )
        add_legend(figure, runs_by_label, title, columns=5)
        plots.save(figure, path)


def replay_gaps(path: Path, of_tasks: Mapping[str, Sequence[RunResult]]) -> None:
    """Plots a histogram of the replay gap for each task, over its runs in `of_tasks`.

    The marked median and 90th percentile are means over the runs.
    """
    with plots.style():
        size = (6.4, 3.0 * len(of_tasks) + 0.3)
        figure, axes = plt.subplots(
            len(of_tasks), 1, figsize=size, layout="constrained", sharex=True, squeeze=False
        )
        highest = 0.0
        for axis, (task, runs) in zip(axes.flat, of_tasks.items(), strict=True):
            counts = np.sum([run.summary["replay_gap_counts"] for run in runs], axis=0)
            names = ("replay_gap_median", "replay_gap_p90")
            marks = [float(np.mean([run.summary[name] for run in runs])) for name in names]
            plots.gap_histogram(axis, counts, *marks)
            axis.set_title(f"{task}: {counts.sum():,} simulated reverse steps")
            highest = max(highest, axis.get_xlim()[1])
        axes[-1, 0].set_xlim(right=highest)
        axes[-1, 0].set_xlabel(plots.GAP_AXIS)
        plots.save(figure, path)


def profiles(path: Path, scores_by_label: Mapping[str, Mapping[str, Floats]]) -> None:
    """Plots the performance profiles of estimates.profile(), with their band over the seeds.

    `scores_by_label`: by label and task, see report_tables.pooled_scores().
    """
    style_of = line_styles(list(scores_by_label))
    with plots.style():
        figure, axis = plt.subplots(figsize=(8.6, 4.8), layout="constrained")
        for label, by_task in scores_by_label.items():
            scores = list(by_task.values())
            colour, line_style = style_of[label]
            count = sum(map(len, scores))
            words = f"{label} ({count} runs, {len(scores)} tasks)"
            profile_of = profile(scores, LEVELS)
            axis.step(LEVELS, profile_of, color=colour, ls=line_style, lw=2.0, label=words)
            found = band(lambda drawn: profile(drawn, LEVELS), scores)
            if found is not None:
                axis.fill_between(LEVELS, *found, step="pre", color=colour, alpha=0.18, lw=0)
        axis.set(xlim=(0.0, 1.0), ylim=(-0.03, 1.03))
        axis.set(xlabel="final success of at least", ylabel="share of the runs")
        figure.legend(loc="outside right upper", frameon=False)
        plots.headline(figure, "performance profiles, 95 % intervals of the seeds")
        plots.save(figure, path)


def _swept(comparison: Comparison, task: str) -> dict[str, Sequence[RunResult]]:
    """Returns, by short name, the runs of methods with swept settings and without them."""
    labels = [label for label in comparison.labels if comparison.row(task, label)]
    methods = {label.split("@")[0] for label in labels if "@" in label}
    shown = [label for label in labels if label.split("@")[0] in methods]
    names = [label.replace("@", "\n") for label in shown]
    if len(methods) == 1:
        names = [name.partition("\n")[2] or f"{name} as it is" for name in names]
    return {name: comparison.done(task, label) for name, label in zip(names, shown, strict=True)}


def sweep(path: Path, comparison: Comparison, task: str) -> None:
    """Plots the final success and the interactions to THRESHOLD for each swept setting.

    A dot is a run, a bar the mean.
    """
    rows = _swept(comparison, task)
    with plots.style():
        size = (9.6, 1.2 + 0.16 * sum(2 + name.count("\n") for name in rows))
        figure, axes = plt.subplots(1, 2, figsize=size, layout="constrained", sharey=True)
        for axis, column in zip(axes, ("success_rate", "interactions_to_95"), strict=True):
            for at, runs in enumerate(rows.values()):
                found = [run.figures()[column] for run in runs]
                values = np.array([value for value in found if value is not None], float)
                values = values if column == "success_rate" else values / 1000.0
                axis.plot(values, np.full(len(values), at), "o", color="#56b4e9", ms=5)
                if len(values):
                    axis.plot(values.mean(), at, "|", color="#0072b2", ms=14, mew=2.5)
                if len(values) < len(found):
                    words = f"{len(found) - len(values)} never"
                    axis.annotate(
                        words, (0.99, at), xycoords=axis.get_yaxis_transform(), **_RIGHT_ALIGNED
                    )
            axis.grid(axis="y", alpha=0.3)
        axes[0].set_yticks(range(len(rows)), list(rows), fontsize=8)
        axes[0].set(title="greedy success at the end", xlim=(-0.03, 1.03))
        axes[0].set_ylim(len(rows) - 0.5, -0.5)
        axes[1].set_title(f"interactions / 1000 to {THRESHOLD}")
        latest = axes[1].dataLim.xmax
        if np.isfinite(latest):
            axes[1].set_xlim(0.0, 1.15 * latest)  # with room for the words at the right
        else:
            axes[1].set_xticks([])
        title = f"{task}: a dot per seed, a bar for their mean"
        plots.headline(figure, title)
        plots.save(figure, path)
