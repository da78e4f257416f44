"""Plots of the figures of a run: learning curve, replay gap, coverage."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, Protocol

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from rtg.files import replay_gaps
from rtg.pictures.draw import (
    INK,
    PAPER,
    ROBOT,
    MarkLike,
    TaskLike,
    mark_colour,
    objects,
    outline,
)

Floats = NDArray[np.float64]

_STYLE: Any = {
    "font.size": 10,
    "figure.dpi": 130,  # text measured in a figure is as wide as in its file
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#8a8d93",
    "axes.labelcolor": "#2b303a",
    "text.color": "#2b303a",
    "xtick.color": "#5a5e66",
    "ytick.color": "#5a5e66",
    "axes.grid": True,
    "grid.color": "#e7e5df",
    "axes.axisbelow": True,
    "figure.facecolor": tuple(c / 255 for c in PAPER),
    "axes.facecolor": tuple(c / 255 for c in PAPER),
    "axes.titlelocation": "left",
    "axes.titlesize": 11,
}
GAP_AXIS = (
    f"replay gap: mean distance between reverse-generated and replayed end\n[{replay_gaps.UNIT}]"
)
_HEADLINE = 11.0  # size of the letters [point]
_INDENT = 0.01  # of a headline, in widths of its figure
_ROOM = 0.35  # above the bars of a histogram, for its legend, in heights of the bars
_BLUE, _ORANGE = "#4a7ebb", "#d9822b"


def _rgb(colour: Sequence[int]) -> tuple[float, ...]:
    return tuple(c / 255 for c in colour)


def style() -> AbstractContextManager[None]:
    """Returns a context manager that applies the style of all plots of RTG."""
    return plt.rc_context(_STYLE)


def written_as(suffix: str) -> AbstractContextManager[None]:
    """Returns a context manager for plots as png, svg or pdf."""
    return plt.rc_context({"savefig.format": suffix})


def renamed(path: Path) -> Path:
    """Returns `path` with the suffix of written_as()."""
    return path.with_suffix(f".{plt.rcParams['savefig.format']}")


def save(figure: Figure, path: Path) -> None:
    """Writes the figure to the file renamed(path), and closes it."""
    figure.savefig(renamed(path))
    plt.close(figure)


def headline(figure: Figure, title: str) -> None:
    """Writes the title of a figure above its panels, as large as fits into its width."""
    words = figure.suptitle(title, x=_INDENT, ha="left", fontsize=_HEADLINE, fontweight="bold")
    room = (1.0 - 2.0 * _INDENT) * figure.bbox.width
    size = _HEADLINE
    while words.get_window_extent().width > room and size > 1.0:
        size *= 0.98
        words.set_fontsize(size)  # widths are not in proportion to sizes


def learning_curve(path: Path, title: str, curve: Mapping[str, Floats], unit: str) -> None:
    """Plots success, episode length and return against interactions.

    `curve` has the columns `interactions`, `success_rate`, `episode_length_mean`,
    `episode_return_mean` and, if known, `rollout_success`. Each has one value per evaluation [N],
    NaN if not measured. `unit` labels the x-axis.
    """
    panels = [
        ("success rate", "success_rate", "rollout_success", (-0.03, 1.03)),
        ("episode length [actions]", "episode_length_mean", "", None),
        ("discounted return", "episode_return_mean", "", None),
    ]
    with style():
        figure, axes = plt.subplots(1, 3, figsize=(10.5, 3.2), layout="constrained")
        thousand = np.asarray(curve["interactions"]) / 1000.0
        for axis, (name, column, extra, limits) in zip(axes, panels, strict=True):
            if extra in curve and np.isfinite(curve[extra]).any():
                axis.plot(
                    thousand,
                    curve[extra],
                    color=_ORANGE,
                    lw=1.0,
                    marker="o",  # for values without neighbours
                    ms=2,
                    zorder=3,  # on the wider line, which shows beside it where both coincide
                    label="training roll-outs",
                )
            known = np.isfinite(curve[column])
            axis.plot(
                thousand[known],
                np.asarray(curve[column])[known],
                color=_BLUE,
                lw=2.4,
                marker="o",
                ms=4.5,
                label="greedy, held-out starts",
            )
            axis.set_title(name)
            axis.set_xlabel(f"{unit} / 1000")
            axis.set_xlim(left=0)
            if limits:
                axis.set_ylim(*limits)
        lines = axes[0].get_lines()
        figure.legend(handles=lines, loc="outside upper right", ncols=len(lines), frameon=False)
        headline(figure, title)
        save(figure, path)


def stages(path: Path, title: str, parts: Mapping[str, Mapping[str, Mapping[str, float]]]) -> None:
    """Plots the wall time and the processor time of each stage of a run.

    `parts`: of "generation" and of "learning", by stage, "wall_s" and, if known, "cpu_s" [s].
    """
    rows = [(part, name, times) for part, found in parts.items() for name, times in found.items()]
    names = [f"{part}: {name.replace('_', ' ')}" for part, name, _ in rows]
    with style():
        height = 1.0 + 0.3 * len(rows)
        figure, axis = plt.subplots(figsize=(7.0, height), layout="constrained")
        at = np.arange(len(rows))
        for offset, key, label, colour in (
            (-0.2, "wall_s", "wall time", _BLUE),
            (0.2, "cpu_s", "processor time", _ORANGE),
        ):
            seconds = [times.get(key, np.nan) for *_, times in rows]
            axis.barh(at + offset, seconds, 0.4, color=colour, label=label)
        axis.set_yticks(at, names)
        axis.invert_yaxis()
        axis.grid(visible=False, axis="y")
        axis.set_xlabel("s")
        figure.legend(loc="outside upper right", ncols=2, frameon=False)
        headline(figure, title)
        save(figure, path)


def _metres(value: float) -> str:
    floor = replay_gaps.EDGES[0]
    return f"≤ {floor:g} m" if value <= floor else f"{value:.2g} m"


def gap_histogram(axis: Axes, counts: Sequence[int], median: float, p90: float) -> None:
    """Draws a histogram of the replay gap. Marks `median` and 90th percentile `p90` [m].

    `counts`: number of gaps in each bin of rtg.files.replay_gaps. [bins]
    """
    bounds, last = replay_gaps.EDGES, int(np.flatnonzero(counts).max(initial=0)) + 1
    axis.bar(bounds[:-1], counts, np.diff(bounds), align="edge", color=_BLUE, alpha=0.85)
    axis.set_xscale("log")
    axis.set_xlim(bounds[0] / 1.1, bounds[last] * 1.1)
    axis.set_ylabel("simulated reverse steps")
    axis.yaxis.set_major_locator(MaxNLocator(integer=True))
    axis.margins(y=_ROOM)
    for words, gap, line_style in (("median", median, "-"), ("90th percentile", p90, "--")):
        at = max(gap, float(bounds[0]))
        label, top = f"{words} {_metres(gap)}", 1.0 / (1.0 + _ROOM)
        axis.axvline(at, ymax=top, color=_ORANGE, lw=1.5, ls=line_style, label=label)
    axis.legend(loc="upper left")


def replay_gap(path: Path, title: str, report: Mapping[str, Any]) -> None:
    """Plots the replay gaps of one run. `report`: the content of generation.json."""
    with style():
        figure, axis = plt.subplots(figsize=(6.4, 3.4), layout="constrained")
        counts = replay_gaps.counts(report["replay_gaps"])
        gap_histogram(axis, counts, report["replay_gap_median"], report["replay_gap_p90"])
        axis.set_xlabel(GAP_AXIS)
        axis.set_title(title)
        save(figure, path)


class RobustnessRow(Protocol):
    """The success of a policy under a variant; None, and a reason, where that is not possible."""

    @property
    def variant(self) -> Any:
        """The difference from the training, with its `group` and `label`."""

    @property
    def success(self) -> float | None: ...
    @property
    def reason(self) -> str | None: ...


def robustness(path: Path, title: str, rows: Sequence[RobustnessRow]) -> None:
    """Plots the success under each variant as a bar, with lines between the groups."""
    with style():
        figure, axis = plt.subplots(figsize=(6.4, 0.9 + 0.19 * len(rows)), layout="constrained")
        places = list(range(len(rows)))
        axis.barh(places, [row.success or 0.0 for row in rows], color=_BLUE, alpha=0.85)
        words = [f"{row.variant.group} {row.variant.label}".strip() for row in rows]
        axis.set_yticks(places, words, fontsize=7)
        for place, row in zip(places, rows, strict=True):
            text = f"{row.reason}" if row.success is None else f"{row.success:.2f}"
            axis.text((row.success or 0.0) + 0.01, place, text, va="center", fontsize=7)
            if place and row.variant.group != rows[place - 1].variant.group:
                axis.axhline(place - 0.5, color="#c9c6bc", lw=0.6)
        axis.invert_yaxis()
        axis.set(xlim=(0.0, 1.12), xlabel="success")
        axis.set_title(title)
        save(figure, path)


def _marks_of(task: TaskLike, body: int) -> list[MarkLike]:
    return [mark for mark in task.goal_marks if mark.kind in ("*", task.kinds[body])]


def _marks_in_words(marks: Sequence[MarkLike]) -> str:
    """Says in a line what the marks of a goal mean; "" if there are none."""
    asked = [mark for mark in marks if not mark.negated]
    words = []
    if any(not mark.target for mark in asked):
        words.append("goal of the centre, or of a mean that includes it")
    if any(mark.target for mark in asked):
        words.append("outline that the object is to have")
    if len(asked) < len(marks):
        words.append("in red, what it is to avoid")
    return f"shaded: {'; '.join(words)}\n" if words else ""


def _draw_scene(axis: Axes, task: TaskLike, body: int, drawn: Container[int]) -> None:
    """Draws the arena, the outlines of bodies at the start, and the goal of `body`.

    The outline of `body` is bold; bodies whose start is `drawn` have none. The goal consists of the
    marks of the terms on the kind of `body`.
    """
    a = task.arena
    for mark in _marks_of(task, body):
        axis.fill(*mark.ring.T, color=_rgb(mark_colour(task, mark)), alpha=0.18, lw=0)
    for other, rings in enumerate(task.outlines):
        if other in drawn:
            continue
        colour = _rgb(ROBOT) if other == 0 else _rgb(INK)
        for ring in rings:
            xy = outline(ring, task.start[other])
            closed = np.vstack([xy, xy[:1]])
            axis.plot(*closed.T, color=colour, lw=1.8 if other == body else 0.7)
    axis.plot([-a, a, a, -a, -a], [-a, -a, a, a, -a], color="#c9c6bc", lw=1)
    axis.set(xlim=(-1.05 * a, 1.05 * a), ylim=(-1.05 * a, 1.05 * a), aspect="equal")
    axis.axis("off")


def _draw_start_region(axis: Axes, ring: Floats) -> None:
    closed = np.vstack([ring, ring[:1]])
    axis.plot(*closed.T, color=_rgb(INK), lw=1.2, ls=(0, (4, 3)), zorder=3)


def coverage(
    path: Path,
    title: str,
    task: TaskLike,
    poses: Floats,
    depth: Floats,
    starts: Floats,
    start_regions: Mapping[int, Floats],
) -> None:
    """Plots, for each object, its positions in all states that the tree search reached.

    poses [N, bodies, 3]: the states. depth [N]: number of actions from each to success, shown as
    colour. starts [T, bodies, 3]: those that the trees grew towards. `start_regions`: by body, the
    outline of the region that its centre starts in, [V, 2]; of those alone whose start is drawn.
    """
    bodies = objects(task)
    columns = min(4, len(bodies))
    rows = -(-len(bodies) // columns)
    order = np.argsort(depth, kind="stable")  # nodes with many actions to success on top
    with style():
        size = (3.1 * columns + 0.9, 3.1 * rows + 0.5)
        figure, axes = plt.subplots(
            rows, columns, figsize=size, layout="constrained", squeeze=False
        )
        for axis in axes.flat[len(bodies) :]:
            axis.set_visible(False)
        for axis, body in zip(axes.flat, bodies, strict=False):
            _draw_scene(axis, task, body, start_regions)
            dots = axis.scatter(
                poses[order, body, 0],
                poses[order, body, 1],
                c=np.asarray(depth)[order],
                s=4,
                alpha=0.55,
                cmap="viridis",
                lw=0,
                rasterized=True,
            )
            axis.scatter(
                *starts[:, body, :2].T, color=_rgb(INK), marker="+", s=60, lw=1.4, zorder=4
            )
            if body in start_regions:
                _draw_start_region(axis, start_regions[body])
            axis.set_title(task.names[body])
        bar = figure.colorbar(ScalarMappable(dots.norm, dots.cmap), ax=axes, shrink=0.85, pad=0.02)
        bar.set_label("actions until success, over all trees")
        bar.locator = MaxNLocator(integer=True)
        in_ranges = "\ndashed: where the centre of the object starts"
        figure.supxlabel(
            "dots: centres of the object in the search's nodes\n"
            "crosses: in the starts that the trees grew towards\noutlines: bodies at the start"
            f"{in_ranges if start_regions.keys() & set(bodies) else ''}\n"
            f"{_marks_in_words([mark for body in bodies for mark in _marks_of(task, body)])}"
            f"frame: arena, {2 * task.arena / task.metre:g} m wide",
            fontsize=8,
        )
        headline(figure, title)
        save(figure, path)
