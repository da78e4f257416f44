"""The results of a run: pictures, summary.json and the final output."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rtg import errors
from rtg.errors import UserError
from rtg.files import best_episode, checked_table, dataset, own_data, run_folder
from rtg.files.episodes import replayed_plan
from rtg.pictures import episode_pictures, plots
from rtg.run import diagnosis, start_regions
from rtg.run.effective_config import TREE_GENERATORS
from rtg.run.plan import RunPlan

Floats = NDArray[np.float64]


def learning_curve(path: Path) -> dict[str, Floats]:
    """Reads the columns of progress.csv, [N] each. Empty entries become NaN.

    Raises UserError if the file is damaged, or was changed since the run wrote it.
    """
    text = run_folder.read_text(path)
    try:
        text = checked_table.plain(text)
        rows = list(csv.DictReader(text.splitlines(keepends=True), strict=True))
        names = rows[0].keys() if rows else ()
        return {name: np.array([float(row[name] or "nan") for row in rows]) for name in names}
    except (ValueError, TypeError, csv.Error):
        raise UserError(f"{path}: is damaged; legal: the file as the run wrote it") from None


def draw_generation(plan: RunPlan) -> None:
    """Draws the pictures of a finished generation."""
    report = run_folder.read_json(plan.report_file)
    with errors.fields_of(plan.report_file):
        if report["replay_gaps"]:
            plots.replay_gap(plan.folder / "replay_gap.png", plan.title, report)
        nodes = report["nodes"]
        shape = (-1, plan.config.task.bodies, 3)
        poses = np.array([node["poses"] for node in nodes], float).reshape(shape)
        starts = np.array([start["poses"] for start in report["starts"]], float).reshape(shape)
        depth = np.array([node["depth"] for node in nodes], float)
    if not nodes:  # only a tree search has nodes
        return
    picture = plan.folder / "coverage.png"
    regions = start_regions.rings(plan.config)
    plots.coverage(picture, plan.title, plan.config.task, poses, depth, starts, regions)


def generation_warning(plan: RunPlan) -> str | None:
    """Returns a sentence about what the data of a run lack; None if nothing."""
    words = "these data may not suffice"
    report = run_folder.read_json(plan.report_file)
    with errors.fields_of(plan.report_file):
        found = (
            diagnosis.of_own_data(report["data"])
            if plan.own_data
            else diagnosis.of_search(plan.config, report)
        )
        found = found or diagnosis.undrawn_goals(report)
        if not found and not plan.own_data:
            found = diagnosis.of_starts(plan.config, report)
            words += ", though such data often do"
    return found and f"{words}: {found}"


def _trained(plan: RunPlan) -> bool:
    """Returns whether the run has trained, in this process or before `--resume --no-train`."""
    return plan.train or (plan.folder / "training.json").is_file()


def _episode(plan: RunPlan) -> Floats | None:
    """Returns the states of the learner's best episode in the final evaluation.

    Without a learner, replays a plan from the data and writes it to best_episode.npz. Returns None
    if the data has no plan.
    """
    task = plan.config.task
    if _trained(plan):
        return best_episode.read(plan.folder, task.bodies)[0]
    rows = dataset.read(plan.transitions_file, task)
    found = replayed_plan(plan.config, rows)
    if found is not None:
        best_episode.write(plan.folder, found, bool(task.succeeded(found[-1:])[0]))
    return found


def _origin(plan: RunPlan, start: Floats) -> str:
    """Returns the origin of the episode that begins in the state `start`, in words."""
    if _trained(plan):
        plans = plan.config.train.learner == "planning"
        return "forward search" if plans else "learned policy"
    is_reverse = plan.config.search.generator in TREE_GENERATORS and not plan.own_data
    found = "plan found backwards" if is_reverse else "plan of the data"
    if not plan.config.task.in_start_region(start[None])[0]:
        return f"end of a {found}, which reaches no start"
    return f"{found}, replayed"


def episode_title(task: str, actions: int, success: bool, origin: str) -> str:
    """Returns the title of the pictures of an episode: its result and its origin."""
    end = "success after" if success else "not solved in"
    return f"{task}: {end} {actions} action{'s' if actions != 1 else ''} ({origin})"


def _draw_episode(plan: RunPlan) -> None:
    poses, task = _episode(plan), plan.config.task
    if poses is not None:
        success = bool(task.succeeded(poses[-1:])[0])
        title = episode_title(task.name, len(poses) - 1, success, _origin(plan, poses[0]))
        strip = plots.renamed(plan.folder / "episode.png")
        episode_pictures.strip(strip, task, poses, success, title)
        episode_pictures.film(plan.folder / "episode.gif", task, poses, success, title)


def draw(plan: RunPlan) -> None:
    """Draws the pictures of learning and of an episode."""
    if plan.train:
        curve = learning_curve(plan.folder / "progress.csv")
        if curve:  # empty if a resumed run had a budget below its first evaluation
            unit = (
                "interactions"
                if plan.config.train.interact
                else "rounds of learning, as interactions"
            )
            plots.learning_curve(plan.folder / "learning_curve.png", plan.title, curve, unit)
    _draw_episode(plan)


def finish(plan: RunPlan, measured: dict[str, Any]) -> dict[str, Any]:
    """Writes summary.json and draws stages.png; returns the summary."""
    generated = plan.offline and not plan.own_data
    mode = ("in_process" if plan.in_process else "lcm") if generated else None
    summary = run_folder.summary(plan.folder, plan.config, mode, measured)
    run_folder.write_json(plan.folder / "summary.json", summary)
    _draw_stages(plan, summary)
    return summary


def _draw_stages(plan: RunPlan, summary: dict[str, Any]) -> None:
    with errors.fields_of(plan.folder / "summary.json"):
        times = stage_times(summary)
    if times:
        plots.stages(plan.folder / "stages.png", f"{plan.title}: time", times)


def draw_again(plan: RunPlan) -> None:
    """Draws all pictures of a run that has ended. Raises UserError if it has not."""
    file = plan.folder / "summary.json"
    if not file.is_file():
        raise UserError(f"{plan.folder}: has no {file.name}; legal: the folder of a finished run")
    if plan.report_file.is_file():
        draw_generation(plan)
    draw(plan)
    _draw_stages(plan, run_folder.read_json(file))


def stage_times(summary: dict[str, Any]) -> dict[str, dict[str, dict[str, float]]]:
    """Returns the times of the stages of generation and of learning, by name.

    The last stage of each is the rest of its wall time; the processor time of that is not known.
    """
    parts: dict[str, dict[str, dict[str, float]]] = {}
    if (start := summary.get("start_wall_s")) is not None:
        parts["run"] = {"start": {"wall_s": start}}
    for part, rest, total in (
        ("generation", "bookkeeping", "generate_wall_s"),
        ("learning", "other", "train_wall_s"),
    ):
        found = summary.get(f"{part}_stages")
        if found:
            left = summary[total] - sum(times["wall_s"] for times in found.values())
            parts[part] = {**found, rest: {"wall_s": max(0.0, left)}}
    return parts


def _generation_text(s: dict[str, Any]) -> str:
    begin = (
        own_data.words(s["data"])
        if s.get("data")
        else f"{s['transitions']:,} transitions in {s['generate_wall_s']:.0f} s"
    )
    return (
        f"{begin}, contact share {s['contact_share']:.2f}, {s['headings_per_state']:.1f} headings "
        "per state"
    )


def _learning_text(plan: RunPlan, s: dict[str, Any]) -> list[str]:
    lines = [
        f"success rate {s['success_rate']:.2f} after {s['interactions']:,} interactions in "
        f"{s['train_wall_s']:.0f} s, {s['episode_length_mean']:.1f} actions per episode"
    ]
    if s["q_rank_correlation"] is not None:
        ranked = f"{s['q_rank_correlation']:.2f}"
        lines.append(f"rank correlation of Q with the simulator, over all headings: {ranked}")
    train = plan.config.train
    if train.interact and s["interactions"] < plan.interactions:
        bar, count = 100 * train.stop_at_success, train.stop_evaluations
        evaluations = f"{count} evaluations in a row" if count > 1 else "an evaluation"
        lines.append(
            f"{plan.interactions - s['interactions']:,} of {plan.interactions:,} interactions were "
            f"not needed: {evaluations} had solved "
            f"{bar:g}% or more (train.stop_at_success)"
        )
    return lines


def summary_text(plan: RunPlan, summary: dict[str, Any]) -> str:
    """Returns the results of the run in human-readable text."""
    generated = summary["transitions"] is not None
    lines = [_generation_text(summary)] if generated else []
    lines += _learning_text(plan, summary) if plan.train else []
    report = run_folder.read_json(plan.report_file) if generated else {}
    with errors.fields_of(plan.report_file):
        found = diagnosis.bottleneck(plan.config, summary, report)
    if (words := diagnosis.undrawn_goals(summary)) and "bottleneck: goal" not in (found or ""):
        lines.append(words)
    if dropped := summary.get("journal_bytes_dropped"):
        file = plan.folder / run_folder.JOURNAL_FILE
        lines.append(
            f"{file}: {dropped:,} bytes were torn, damaged or of other settings; what they held "
            "was computed again"
        )
    if found:
        lines.append(found)
    return "\n".join([*lines, f"results: {plan.folder}"])
