"""`./run.sh evaluate RUN...`: success of a run's policy against what it was not trained for."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import torch as th

from rtg import _core, errors
from rtg.compare.report_tables import table
from rtg.compare.run_results import EVALUATION, read_evaluation
from rtg.files import run_folder
from rtg.learn import policy_file, robustness
from rtg.learn.robustness import Row, Variant
from rtg.pictures import plots
from rtg.run import effective_config


def _policy(config: _core.Config) -> str:
    if not config.train.leave_loops:
        return "Greedy policy"
    return (
        "Policy: the best push; in a state to which the episode returns, the best one not yet "
        "tried there"
    )


def _table(rows: list[Row], config: _core.Config, episodes: int) -> str:
    lines = [
        f"# {_title(config)}",
        "",
        f"{_policy(config)}. {episodes} held-out starts each.",
        "",
        table(["", "", "success", "actions per episode"], map(_cells, rows), left=2),
    ]
    return "\n".join(lines) + "\n"


def _cells(row: Row) -> list[str]:
    known = row.success is not None
    figures = [f"{row.success:.2f}", f"{row.length:.1f}"] if known else [f"{row.reason}", ""]
    return [row.variant.group, row.variant.label, *figures]


def _title(config: _core.Config) -> str:
    return f"{config.task.name}, {config.run.method}, seed {config.run.seed}"


def evaluate(run: Path, episodes: int) -> str:
    """Writes evaluation.md, .json and .png into the folder of a run; returns the table.

    Raises UserError if the folder has no policy.
    """
    file, model = run_folder.policy_files(run)
    config: _core.Config = effective_config.load_written(file)
    values = policy_file.read(model, config.task)
    th.set_num_threads(1)

    def row_of(variant: Variant) -> Row:
        return robustness.evaluate_variant(file, config, values, variant, episodes)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        rows = list(pool.map(row_of, robustness.variants(config)))
    text = _table(rows, config, episodes)
    with run_folder.write_errors_as_user_errors(run):
        run_folder.write_text(run / "evaluation.md", text)
        found = [
            {
                "group": row.variant.group,
                "label": row.variant.label,
                "amount": row.variant.amount,
                "success": row.success,
                "episode_length": row.length,
                "reason": row.reason,
            }
            for row in rows
        ]
        run_folder.write_json(run / EVALUATION, {"episodes": episodes, "rows": found})
        plots.robustness(run / "evaluation.png", _title(config), rows)
    return text


def draw_again(run: Path) -> None:
    """Draws the picture of the last evaluate() anew, if there was one.

    Raises UserError if its file is damaged.
    """
    found = read_evaluation(run)
    if not found:
        return
    with errors.fields_of(run / EVALUATION):
        rows = [
            Row(
                Variant(row["group"], row["label"]),
                row["success"],
                row["episode_length"],
                row["reason"],
            )
            for row in found
        ]
    title = _title(effective_config.load_written(run / "config.yaml"))
    plots.robustness(run / "evaluation.png", title, rows)
