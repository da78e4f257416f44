"""What the runs of a comparison came to, read from their folders."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rtg import _core, versions
from rtg.cells import Cell, Grid
from rtg.errors import UserError
from rtg.estimates import first_reach
from rtg.methods import METHODS, TASKS
from rtg.results import learning_curve
from rtg.run_folder import read_json, result

Floats = NDArray[np.float64]

CURVES = ("success_rate", "rollout_success", "episode_length_mean", "episode_return_mean")
_BARS = {"interactions_to_70": 0.70, "interactions_to_95": 0.95}


@dataclass(frozen=True)
class RunResult:
    """One cell and how far it has come."""

    cell: Cell
    folder: Path
    state: str  # done, failed, unfinished, not run
    summary: dict[str, Any]  # summary.json; of a run that is not done, empty like the next two
    versions: dict[str, Any]
    curve: dict[str, Floats]  # columns of progress.csv [N]
    budget: int  # of interactions; 0 of a run that is not done

    @property
    def done(self) -> bool:
        return self.state == "done"

    @property
    def commit(self) -> str | None:
        """Of the program that ended the run."""
        return versions.commit(self.versions)

    @property
    def commits(self) -> str:
        """In words, with others that learned before it was resumed or made the transitions."""
        generator = versions.commit(self.versions.get("generator", {}))
        is_other = generator not in (None, self.commit) and self.summary.get("transitions")
        words = [f"`{self.commit}`"]
        words += [f"begun by `{other}`" for other in self.versions.get("begun_by", [])]
        return ", ".join([*words, f"transitions by `{generator}`"] if is_other else words)

    def figures(self) -> dict[str, Any]:
        """The entry of report.json."""
        names = ("success_rate", "episode_length_mean", "rollout_success", "interactions")
        more = ("transitions", "generate_wall_s", "train_wall_s")
        return {
            "seed": self.cell.seed,
            **{name: self.summary.get(name) for name in names},
            "success_at_third": self.success_at_third(),
            **{name: self.reached(bar) for name, bar in _BARS.items()},
            **{name: self.summary.get(name) for name in more},
            "pushes": self.pushes(),
            "commit": self.commit,
        }

    def pushes(self) -> int:
        """Of the simulator, beside the learner's interactions."""
        return sum(self.summary.get(name) or 0 for name in ("replays", "curriculum_pushes"))

    def success_at_third(self) -> float | None:
        """Of the last evaluation within a third of the budget; of a run that had ended by then the
        final one, as it may have ended because the others went well by chance."""
        if not self.curve:
            return None
        third = self.budget / 3
        if self.summary["interactions"] <= third:
            return float(self.summary["success_rate"])
        known = self.curve["success_rate"][self.curve["interactions"] <= third]
        return float(known[-1]) if len(known) else None

    def reached(self, bar: float) -> int | None:
        """Interactions at the first evaluation with that greedy success; None: never."""
        if not self.curve:
            return None
        return first_reach(self.curve["interactions"], self.curve["success_rate"], bar)


@dataclass(frozen=True)
class Comparison:
    """All runs, in the order in which tables show them."""

    results: tuple[RunResult, ...]

    @property
    def tasks(self) -> list[str]:
        return list(dict.fromkeys(r.cell.task for r in self.results))

    @property
    def labels(self) -> list[str]:
        """Methods, and what was swept of them."""
        cells = sorted((r.cell for r in self.results), key=_place)
        return list(dict.fromkeys(cell.label for cell in cells))

    def row(self, task: str, label: str) -> list[RunResult]:
        """The runs of all seeds."""
        return [r for r in self.results if (r.cell.task, r.cell.label) == (task, label)]

    def done(self, task: str, label: str) -> list[RunResult]:
        """Those of them that have a result."""
        return [r for r in self.row(task, label) if r.done]

    def all_done(self) -> list[RunResult]:
        return [r for r in self.results if r.done]


def _result(folder: Path, cell: Cell, grid: Grid) -> RunResult:
    run = folder / cell.name
    summary = result(run)
    if summary:
        progress = run / "progress.csv"
        curve = learning_curve(progress) if progress.is_file() else {}
        if curve and not {"interactions", *CURVES} <= curve.keys():
            raise UserError(f"{progress}: lacks columns; legal: as the run left it")
        made_with, budget = read_json(run / versions.FILE), _budget(run / "config.yaml")
        return RunResult(cell, run, "done", summary, made_with, curve, budget)
    begun = "unfinished" if run.is_dir() else "not run"
    return RunResult(cell, run, "failed" if cell.name in grid.failed else begun, {}, {}, {}, 0)


def _budget(config: Path) -> int:
    try:
        train = json.loads(_core.Config.from_file(config).json)["train"]
    except _core.ConfigError as error:
        raise UserError(str(error)) from None
    return int(train["interactions"])


def _place(cell: Cell) -> int:
    return METHODS.index(cell.method) if cell.method in METHODS else len(METHODS)


def read_comparison(folder: Path, grid: Grid) -> Comparison:
    """Tasks in the order of TASKS, methods in that of METHODS, what is not among them after them,
    like swept values in the order of the grid; then seeds."""
    tasks = list(dict.fromkeys((*TASKS, *(cell.task for cell in grid.cells))))
    settings = list(dict.fromkeys(cell.settings for cell in grid.cells))
    cells = sorted(
        grid.cells,
        key=lambda c: (tasks.index(c.task), _place(c), settings.index(c.settings), c.seed),
    )
    return Comparison(tuple(_result(folder, cell, grid) for cell in cells))
