"""Run folders of a comparison that nobody ran: plausible figures, made up."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from rtg import _core, paths
from rtg.compare.cells import Cell, Grid
from rtg.files import replay_gaps
from rtg.files.run_folder import write_json
from rtg.learn.training_log import TrainingLog

CONFIG = paths.CONFIG / "gathering.yaml"
VERSIONS = {"git_revision": "abc", "git_modified": False, "processor": "Z80"}


def row(interactions: int, success: float) -> dict[str, Any]:
    """An evaluation."""
    return {
        "interactions": interactions,
        "pushes": interactions,
        "cpu_s": interactions / 100.0,
        "evaluation_cpu_s": 0.0,
        "success_rate": success,
        "rollout_success": 0.9 * success,
        "episode_length_mean": 60.0 - 40.0 * success,
        "episode_return_mean": 0.2 * success,
    }


def summary_of(seed: int) -> dict[str, Any]:
    """Returns what a run came to, but for its success."""
    rng = np.random.default_rng(seed)
    gaps = np.exp(rng.normal(-5.0, 1.0, size=500)).tolist()
    return {
        "transitions": 120_000,
        "generate_wall_s": 50.0,
        "generate_cpu_s": 60.0,
        "train_wall_s": 100.0,
        "train_cpu_s": 90.0,
        "candidates": 2000,
        "pruned": 1000,
        "converged": 990,
        "pushing_converged": 220,
        "pushing_iterations_median": 31,
        "pushing_iterations_p90": 53,
        "reverse_cpu_s": 2.0,
        "replay_cpu_s": 60.0,
        "replays": 300_000,
        "replay_gap_median": 0.006,
        "replay_gap_p90": 0.026,
        "contact_share": 0.5,
        "tree_transitions": 24_000,
        "branch_transitions": 96_000,
        "headings_per_state": 4.9,
        "trees": 12,
        "device": "cpu",
        "precision": "float32",
        "runs_in_process": 1,
        "final_episodes": 1000,
        "q_rank_correlation": 0.75,
        "q_error": 0.02,
        "q_spread": 0.07,
        "defects": [],
        "replay_gap_counts": replay_gaps.counts(gaps),
    }


def finished(
    folder: Path,
    cell: Cell,
    course: Sequence[float],
    *,
    budget: int = 0,
    every: Mapping[str, float] | None = None,
    **more: Any,
) -> None:
    """The folder of a run that evaluated every 5,000 interactions, with these successes, and used
    its budget up if none is given. every: other costs of 5,000 interactions; more: other values of
    summary.json."""
    run = folder / cell.name
    run.mkdir(parents=True)
    log = TrainingLog(run)
    for at, success in enumerate(course, start=1):
        costs = {cost: at * value for cost, value in (every or {}).items()}
        log.add({**row(5000 * at, success), **costs})
    summary = {
        **summary_of(cell.seed),
        "success_rate": course[-1],
        "episode_length_mean": 60.0 - 40.0 * course[-1],
        "rollout_success": 0.9 * course[-1],
        "interactions": 5000 * len(course),
        **more,
    }
    write_json(run / "summary.json", summary)
    write_json(run / "versions.json", VERSIONS)
    budget = budget or 5000 * len(course)
    settings = [f"run.method={cell.method}", f"train.interactions={budget}"]
    config = _core.Config.from_file(CONFIG, overrides=settings)
    (run / "config.yaml").write_text(config.yaml)
    start = _core.Config.from_file(CONFIG).task.start
    np.savez(run / "best_episode.npz", poses=np.stack([start, start]), success=course[-1] > 0.5)


def course(rng: np.random.Generator, middle: float, end: float, length: int) -> list[float]:
    """A noisy rise to `end`, half of it at the share `middle` of the length."""
    x = np.linspace(0.0, 1.0, length)
    rise = end / (1.0 + np.exp(-(x - middle) / 0.06))
    return np.clip(rise + rng.normal(0.0, 0.03, length), 0.0, 1.0).round(2).tolist()


def write_grid(folder: Path, cells: Sequence[Cell], failed: dict[str, str] | None = None) -> None:
    grid = Grid({}, failed or {})
    grid.add("./run.sh reproduce gathering", cells)
    grid.write(folder)


def table_row(page: str, label: str, after: str = "## gathering") -> list[str]:
    """Cells of the row of a method in the first table behind that heading."""
    lines = page.split(after)[1].splitlines()
    line = next(line for line in lines if line.startswith(f"| `{label}` |"))
    return [cell.strip() for cell in line.strip("|").split("|")][1:]
