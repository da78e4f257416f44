"""The end of a run: pictures, summary.json, the last words."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rtg import _core, dataset, episode_pictures, plots, run_folder
from rtg.episodes import best_episode
from rtg.errors import UserError
from rtg.run_plan import RunPlan

Floats = NDArray[np.float64]

_POOR = 0.1  # tree policy below which start and goal are hardly connected by the data


def learning_curve(path: Path) -> dict[str, Floats]:
    """Columns of progress.csv, NaN where a cell is empty, [N] each. Raises UserError."""
    try:
        with path.open(newline="") as file:
            rows = list(csv.DictReader(file, strict=True))
        names = rows[0].keys() if rows else ()
        return {name: np.array([float(row[name] or "nan") for row in rows]) for name in names}
    except (ValueError, TypeError, csv.Error):
        raise UserError(f"{path}: damaged; legal: as the run left it") from None


def _draw_generation(plan: RunPlan, task: _core.Task) -> None:
    report = run_folder.read_json(plan.report_file)
    if report["replay_gaps"]:
        plots.replay_gap(plan.folder / "replay_gap.png", plan.title, report)
    nodes = report["nodes"]
    poses = np.array([node["poses"] for node in nodes]).reshape(-1, task.bodies, 3)
    depth = np.array([node["depth"] for node in nodes], float)
    picture = plan.folder / "coverage.png"
    plots.coverage(picture, plan.title, task, poses, depth)


def _trained(plan: RunPlan) -> bool:
    """Now, or before a `--resume --no-train`."""
    return plan.train or (plan.folder / "training.json").is_file()


def _episode(plan: RunPlan, task: _core.Task) -> Floats | None:
    """States of the learner's best evaluation episode; without a learner, of the data's best, which
    it writes to the same file."""
    path = plan.folder / "best_episode.npz"
    if _trained(plan):
        with np.load(path) as file:
            poses: Floats = file["poses"]
            return poses
    best = best_episode(dataset.read(plan.transitions_file, task.bodies, task.headings))
    if best is not None:
        np.savez(path, poses=best, success=task.succeeded(best[-1:])[0])
    return best


def episode_title(task: str, actions: int, success: bool, trained: bool) -> str:
    """What the pictures of the episode show, and where it comes from."""
    end = "success after" if success else "not solved in"
    origin = "learned policy" if trained else "generated data, no training"
    return f"{task}: {end} {actions} action{'s' if actions != 1 else ''} ({origin})"


def _draw_episode(plan: RunPlan, task: _core.Task) -> None:
    poses = _episode(plan, task)
    if poses is not None:
        success = bool(task.succeeded(poses[-1:])[0])
        title = episode_title(task.name, len(poses) - 1, success, _trained(plan))
        episode_pictures.strip(plan.folder / "episode.png", task, poses, success, title)
        episode_pictures.film(plan.folder / "episode.gif", task, poses, success, title)


def finish(plan: RunPlan, measured: dict[str, Any]) -> dict[str, Any]:
    """Draws all pictures and writes summary.json; returns the summary."""
    task = _core.Config.from_file(plan.config_file).task
    if plan.offline:
        _draw_generation(plan, task)
    if plan.train:
        curve = learning_curve(plan.folder / "progress.csv")
        if curve:  # none of a run resumed with a budget below its first evaluation
            plots.learning_curve(plan.folder / "learning_curve.png", plan.title, curve)
    _draw_episode(plan, task)
    mode = ("in_process" if plan.in_process else "lcm") if plan.offline else None
    summary = run_folder.summary(plan.folder, plan.config, mode, measured)
    run_folder.write_json(plan.folder / "summary.json", summary)
    return summary


def _words_of_generation(s: dict[str, Any]) -> list[str]:
    lines = [
        f"{s['transitions']:,} transitions in {s['generate_wall_s']:.0f} s, "
        f"contact share {s['contact_share']:.2f}"
    ]
    policy = s["tree_policy_success"]
    if policy is None:  # no trees
        return lines
    lines[0] += f", tree policy {policy:.2f}"
    if policy < _POOR:
        lines.append(
            "plans of the data seldom lead from the start to the goal: training may take long or "
            "fail, more transitions may help (--transitions)"
        )
    return lines


def words(plan: RunPlan, summary: dict[str, Any]) -> str:
    """What the run came to, for people."""
    s = summary
    lines = [] if s["transitions"] is None else _words_of_generation(s)
    if plan.train:
        lines.append(
            f"success rate {s['success_rate']:.2f} after {s['interactions']:,} interactions in "
            f"{s['train_wall_s']:.0f} s, {s['episode_length_mean']:.1f} actions per episode"
        )
        if s["interactions"] < plan.interactions:
            train = plan.config["train"]
            bar, count = 100 * train["stop_at_success"], train["stop_evaluations"]
            evaluations = f"{count} evaluations in a row" if count > 1 else "an evaluation"
            lines.append(
                f"{plan.interactions:,} interactions were not needed: {evaluations} had solved "
                f"{bar:g}% or more (train.stop_at_success)"
            )
    return "\n".join([*lines, f"results: {plan.folder}"])
