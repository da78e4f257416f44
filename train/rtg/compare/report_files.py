"""`./run.sh plot`: makes report, tables and pictures of a comparison from its run folders."""

from __future__ import annotations

import contextlib
import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.compare import report_plots, report_robustness
from rtg.compare.collection import check_sources, collect
from rtg.compare.methods import REFERENCE
from rtg.compare.report import report
from rtg.compare.report_tables import pooled_scores
from rtg.compare.run_results import (
    COSTS,
    CURVE_COLUMNS,
    Comparison,
    RunResult,
    costs,
)
from rtg.files import best_episode, locks, run_folder
from rtg.pictures import episode_pictures, plots
from rtg.run import effective_config
from rtg.run.results import episode_title

_OF_A_TASK = ("costs", "curves", "sweep", "strip", "robustness")
_PICTURES = (
    *(f"{name}_*.png" for name in _OF_A_TASK),
    "film_*.gif",
    "replay_gap.png",
    "profiles.png",
)


def write_report(runs: Path, out: Path, suffix: str = "png") -> Path:
    """Writes the report on the comparison `runs`, see write_joint_report()."""
    return write_joint_report([runs], out, suffix)


def write_joint_report(sources: Sequence[Path], out: Path, suffix: str = "png") -> Path:
    """Writes one report on comparisons and single runs to `out`; returns the path of its page.

    Its pictures are PNGs. With another `suffix`, svg or pdf, the plots are also written so. Raises
    UserError.
    """
    check_sources(sources)
    with _writing_to(out):
        # Read after others have written theirs, so that the last report has the runs of all.
        grid, comparison, remarks = collect(sources)
        episodes = {task: _best_episode(comparison, task) for task in comparison.tasks}
        with run_folder.write_errors_as_user_errors(out):
            _draw(out, comparison, episodes, suffix)
            _write_numbers(out, comparison)
            run_folder.write_text(out / "report.md", report(out, grid, comparison, remarks))
    return out / "report.md"


@contextlib.contextmanager
def _writing_to(out: Path) -> Iterator[None]:
    """Makes the folder `out` and keeps other processes from writing a report there meanwhile."""
    with contextlib.ExitStack() as held:
        with run_folder.write_errors_as_user_errors(out):
            out.mkdir(parents=True, exist_ok=True)
            held.enter_context(locks.lock(out / ".report.lock"))
        yield


def _draw(
    out: Path, comparison: Comparison, episodes: Mapping[str, ShownEpisode | None], suffix: str
) -> None:
    _remove_old_pictures(out)
    for task, episode in episodes.items():
        _draw_episode(out, task, episode)
    _draw_plots(out, comparison)
    if suffix != "png":
        with plots.written_as(suffix):
            _draw_plots(out, comparison)


def _draw_plots(out: Path, comparison: Comparison) -> None:
    gaps = {}
    scores = pooled_scores(comparison)
    of_methods = {label: found for label, found in scores.items() if "@" not in label}
    if len(of_methods) > 1:
        report_plots.profiles(out / "profiles.png", of_methods)
    for task in comparison.tasks:
        done = [run for run in comparison.all_done() if run.cell.task == task]
        if report_plots.curve_labels(comparison, task):
            report_plots.costs(out / f"costs_{task}.png", comparison, task)
            report_plots.curves(out / f"curves_{task}.png", comparison, task)
        if report_robustness.is_evaluated(comparison, task):
            report_robustness.robustness(out / f"robustness_{task}.png", comparison, task)
        if any(run.cell.settings for run in done):
            report_plots.sweep(out / f"sweep_{task}.png", comparison, task)
        replayed = _runs_of_reference([run for run in done if "replay_gap_counts" in run.summary])
        if replayed:
            gaps[task] = replayed
    if gaps:
        report_plots.replay_gaps(out / "replay_gap.png", gaps)


def _remove_old_pictures(out: Path) -> None:
    """Removes all pictures that the existing page shows, even if no new picture replaces them."""
    page = out / "report.md"
    text = page.read_text(errors="replace") if page.is_file() else ""
    for picture in (path for pattern in _PICTURES for path in out.glob(pattern)):
        if f"({picture.name})" in text:
            picture.unlink()


def _runs_of_reference(done: Sequence[RunResult]) -> list[RunResult]:
    """Returns the runs of the reference method, or those of the first method if there are none."""
    labels = {run.cell.label for run in done}
    label = REFERENCE if REFERENCE in labels else next((run.cell.label for run in done), "")
    return [run for run in done if run.cell.label == label]


@dataclass(frozen=True)
class ShownEpisode:
    """An episode to show in the report."""

    task: _core.Task
    label: str  # method and swept settings of the run
    poses: NDArray[np.float64]  # [states, bodies, 3]
    success: bool


def _read_episode(run: RunResult) -> ShownEpisode | None:
    """Reads the best episode of the run's final evaluation; None if there is no file.

    Raises UserError if the file is damaged.
    """
    if not (run.folder / best_episode.FILE).is_file():
        return None
    task = effective_config.load_recorded(run.folder / "config.yaml").task
    return ShownEpisode(task, run.cell.label, *best_episode.read(run.folder, task.bodies))


def _best_episode(comparison: Comparison, task: str) -> ShownEpisode | None:
    """Returns the best episode of the final evaluations of a task; None if there is none.

    The criteria, in this order: success, reference method, small length.
    """
    runs = [run for run in comparison.all_done() if run.cell.task == task]
    found = [episode for run in runs if (episode := _read_episode(run))]
    return min(
        found,
        key=lambda one: (not one.success, one.label.split("@")[0] != REFERENCE, len(one.poses)),
        default=None,
    )


def _draw_episode(out: Path, task: str, episode: ShownEpisode | None) -> None:
    if episode is not None:
        words = episode_title(task, len(episode.poses) - 1, episode.success, episode.label)
        what = episode.task, episode.poses, episode.success, words
        episode_pictures.strip(out / f"strip_{task}.png", *what)
        episode_pictures.film(out / f"film_{task}.gif", *what)


def _write_numbers(out: Path, comparison: Comparison) -> None:
    _write_csv(out / "runs.csv", _run_rows(comparison))
    _write_csv(
        out / "curves.csv", [row for run in comparison.all_done() for row in _curve_rows(run)]
    )


def _run_keys(run: RunResult) -> dict[str, Any]:
    return {"task": run.cell.task, "method": run.cell.label, "seed": run.cell.seed}


def _run_rows(comparison: Comparison) -> list[dict[str, Any]]:
    """Returns a row for each run, with all its figures that are single numbers or words."""
    more = [
        name
        for run in comparison.all_done()
        for name, value in run.summary.items()
        if not isinstance(value, (dict, list))
    ]
    names = list(dict.fromkeys((*run_folder.SUMMARY_KEYS, *more)))
    return [
        {
            **{name: run.summary.get(name) for name in names},
            **_run_keys(run),
            "state": run.state,
            **run.figures(),
        }
        for run in comparison.results
    ]


def _curve_rows(run: RunResult) -> list[dict[str, Any]]:
    """Returns a row for each evaluation of the run."""
    if not run.curve:
        return []
    columns = {name: costs(run.curve, name) for name in COSTS}
    columns |= {name: run.curve[name].tolist() for name in CURVE_COLUMNS}
    return [
        {**_run_keys(run), **dict(zip(columns, values, strict=True))}
        for values in zip(*columns.values(), strict=True)
    ]


def _write_csv(path: Path, rows: Sequence[Mapping[str, Any]]) -> None:
    """Writes `rows` as CSV, with fractions to six digits. Missing values stay empty."""
    text = io.StringIO()
    table = csv.DictWriter(text, list(rows[0]) if rows else [], lineterminator="\n")
    table.writeheader()
    for row in rows:
        table.writerow({name: _csv_value(value) for name, value in row.items()})
    run_folder.write_text(path, text.getvalue())


def _csv_value(value: Any) -> Any:
    if isinstance(value, float):
        return "" if np.isnan(value) else f"{value:.6g}"
    return value
