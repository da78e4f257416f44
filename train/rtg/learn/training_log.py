"""The log of a training run: progress.csv, and training_state.json for displays."""

from __future__ import annotations

import csv
import io
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rtg.files import best_episode, checked_table
from rtg.files.run_folder import write_json, write_text
from rtg.learn.evaluation import Evaluation
from rtg.learn.log_sinks import LazySinks

COLUMNS = (
    "interactions",  # as schedules count them, see Training.scheduled_interactions
    "gradient_steps",
    "success_rate",  # of the greedy policy from the held-out starts
    "episode_length_mean",
    "episode_return_mean",  # discounted
    "rollout_success",  # of the last 100 training episodes
    "rollout_length_mean",
    "online_successes",
    "epsilon",
    "q_start_max",  # at the nominal start
    "q_offline_mean",
    "q_offline_max",
    "q_online_mean",
    "q_online_max",
    "td_error",
    "clipped_share",  # share of the bootstrap targets outside [0, 1]
    "bound_share",  # share of the targets raised to the bounds of value_bounds.py
    "offline_transitions",
    "pushes",  # simulated for learning: by interactions, a curriculum or planning
    "wall_s",
    "cpu_s",  # of the learner's processes; includes evaluations, as wall_s does
    "evaluation_cpu_s",  # part of it: all evaluations so far
)
DISPLAY_INTERVAL = 0.5  # [s]


class TrainingLog:
    """The log of a training run, with one row per evaluation; its rows also go to `sinks`."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.sinks: LazySinks | None = None
        self.rows: list[dict[str, Any]] = []
        self._shown_at = -1e9

    def add(self, row: Mapping[str, Any]) -> None:
        """Appends a row; missing columns stay empty. Raises KeyError for an unknown column."""
        unknown = set(row) - set(COLUMNS)
        if unknown:
            raise KeyError(f"{sorted(unknown)} are not columns of progress.csv")
        self.rows.append(dict(row))
        self.write()
        if self.sinks is not None:
            self.sinks.add(row, self.rows[:-1])

    def write(self) -> None:
        """Writes all rows to progress.csv, with a column that tells when they were changed."""
        text = io.StringIO()
        table = csv.DictWriter(text, COLUMNS, lineterminator="\n")
        table.writeheader()
        for row in self.rows:
            shown = {k: f"{v:.6g}" if isinstance(v, float) else v for k, v in row.items()}
            table.writerow(shown)
        write_text(self._folder / "progress.csv", checked_table.checked(text.getvalue()))

    def write_result(self, final: Evaluation, figures: Mapping[str, Any]) -> None:
        """Writes best_episode.npz and then training.json."""
        best = final.best()
        best_episode.write(self._folder, final.paths[best], bool(final.success[best]))
        write_json(self._folder / "training.json", dict(figures))

    def display(self, state: Mapping[str, Any], force: bool = False) -> None:
        """Writes training_state.json for displays, at most twice a second unless `force`."""
        now = time.monotonic()
        if force or now - self._shown_at >= DISPLAY_INTERVAL:
            self._shown_at = now
            write_json(self._folder / "training_state.json", dict(state))
