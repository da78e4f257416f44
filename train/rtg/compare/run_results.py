"""Reads the results of the runs of a comparison from their folders."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.compare.cells import Cell, Grid
from rtg.compare.estimates import first_reach
from rtg.compare.methods import METHODS, TASKS
from rtg.errors import UserError, fields_of
from rtg.files import versions
from rtg.files.run_folder import SUMMARY_KEYS, read_json, result
from rtg.run import effective_config
from rtg.run.results import learning_curve

Floats = NDArray[np.float64]

COSTS = ("interactions", "pushes", "cpu_s")  # [1], [1], [s]; columns of a curve
THRESHOLD = 0.95  # greedy success that solves a task; the costs "..._to_95" are those to reach it
CURVE_COLUMNS = ("success_rate", "rollout_success", "episode_length_mean", "episode_return_mean")

EVALUATION = "evaluation.json"  # what `./run.sh evaluate` found, in the folder of a run
_TEXTS = ("task", "method", "mode")  # of a summary; its other members are numbers
_ITERATIONS = ("pushing_iterations_median", "pushing_iterations_p90")


def costs(curve: dict[str, Floats], cost: str) -> list[float]:
    """Returns the column `cost` of `curve`: seconds, or else whole numbers. [N]"""
    return (curve[cost] if cost == "cpu_s" else curve[cost].astype(int)).tolist()


@dataclass(frozen=True)
class RunResult:
    """A cell with the state and the results of its run."""

    cell: Cell
    folder: Path
    state: str  # done, failed, generation only, unfinished, not run
    summary: dict[str, Any]  # summary.json; this and the next two are {} unless done
    versions: dict[str, Any]
    # Columns of progress.csv [N]; `pushes` and `cpu_s` are with those of the generation, and
    # without those of evaluations. `cpu_s` is NaN where the run does not know its evaluations'.
    curve: dict[str, Floats]
    train: _core.TrainConfig | None  # None unless the run is done
    evaluation: Sequence[Mapping[str, Any]] = ()  # the rows of evaluation.json, if there is one

    @property
    def done(self) -> bool:
        return self.state == "done"

    @property
    def interacts(self) -> bool:
        """Returns whether the learner interacts with the environment.

        If not, `interactions` of the curve stands for rounds of learning. It is the number of
        interactions of as many rounds with interactions.
        """
        return self.train is not None and self.train.interact

    @property
    def is_planned(self) -> bool:
        """Returns whether nothing is learned: the run searches anew from each start."""
        return self.train is not None and self.train.learner == "planning"

    @property
    def planned_starts(self) -> int:
        """The number of starts that a planner searches from."""
        return self.train.eval_episodes if self.train is not None else 0

    @property
    def budget(self) -> int:
        """The number of interactions, or of rounds of learning, that the run was given."""
        return self.train.interactions if self.train is not None else 0

    @property
    def ended_early(self) -> bool:
        """Returns whether training ended before the budget, as its success was enough."""
        return bool(self.curve) and self.curve["interactions"][-1] < self.budget

    @property
    def commit(self) -> str | None:
        """The commit of the program that finished the run."""
        return versions.commit(self.versions)

    @property
    def commits(self) -> str:
        """All commits of the run in words:

        - `commit`;
        - other commits that worked on the run before it was resumed;
        - the commit that generated the transitions, if it is another one.
        """
        generator = versions.commit(self.versions.get("generator", {}))
        is_other = generator not in (None, self.commit) and self.summary.get("transitions")
        words = [f"`{self.commit}`"]
        words += [f"begun by `{other}`" for other in self.versions.get("begun_by", [])]
        return ", ".join([*words, f"transitions by `{generator}`"] if is_other else words)

    def figures(self) -> dict[str, Any]:
        """Returns the figures of the run that reports have, by name."""
        names = ("success_rate", "episode_length_mean", "rollout_success", "interactions")
        of_generation = ("transitions", "replays", "generate_cpu_s", "generate_wall_s")
        of_learner = ("train_cpu_s", "train_wall_s", "q_rank_correlation")
        return {
            "seed": self.cell.seed,
            **{name: self.summary.get(name) for name in names},
            "success_at_third": self.success_at_third(),
            "interactions_to_70": self.cost_to_reach(0.70),
            **{f"{cost}_to_95": self.cost_to_reach(THRESHOLD, cost) for cost in COSTS},
            **{name: self.summary.get(name) for name in (*of_generation, *of_learner)},
            **{f"whole_{cost}": self.total_cost(cost) for cost in COSTS[1:]},
            "commit": self.commit,
        }

    def total_cost(self, cost: str) -> float | None:
        """Returns the cost of the run until its last evaluation; None without evaluations."""
        return _known(costs(self.curve, cost)[-1]) if self.curve else None

    def success_at_third(self) -> float | None:
        """Returns the success of the last evaluation within the first third of the budget.

        Returns None if there is none. If the run ended within that third, returns the success of
        the final evaluation, because chance success may have ended the run.
        """
        if not self.curve or self.train is None or self.is_planned:
            return None
        third = self.train.interactions / 3
        within = self.curve["interactions"] <= third
        if within.all():
            return float(self.summary["success_rate"])
        known = self.curve["success_rate"][within]
        return float(known[-1]) if len(known) else None

    def cost_to_reach(self, threshold: float, cost: str = COSTS[0]) -> float | None:
        """Returns the cost at the first of two evaluations in a row that reach `threshold`.

        The final evaluation counts as the last one. Returns None if there are no such two, or if
        nothing is learned.
        """
        if not self.curve or self.is_planned:
            return None
        success = np.append(self.curve["success_rate"], self.summary["success_rate"])
        first = first_reach(success, threshold)
        return None if first is None else _known(costs(self.curve, cost)[first])


def _known(value: float) -> float | None:
    return None if np.isnan(value) else value


@dataclass(frozen=True)
class Comparison:
    """All runs of a comparison, in the order in which tables show them."""

    results: tuple[RunResult, ...]

    @property
    def tasks(self) -> list[str]:
        return list(dict.fromkeys(r.cell.task for r in self.results))

    @property
    def labels(self) -> list[str]:
        """The labels of the cells (method with swept settings), in the order of the methods."""
        cells = sorted((r.cell for r in self.results), key=_method_order)
        return list(dict.fromkeys(cell.label for cell in cells))

    def row(self, task: str, label: str) -> list[RunResult]:
        """Returns the runs of all seeds of a label on a task."""
        return [r for r in self.results if (r.cell.task, r.cell.label) == (task, label)]

    def done(self, task: str, label: str) -> list[RunResult]:
        """Returns the runs of row() that have a result."""
        return [r for r in self.row(task, label) if r.done]

    def all_done(self) -> list[RunResult]:
        return [r for r in self.results if r.done]


def _result(run: Path, cell: Cell, failures: Container[str]) -> RunResult:
    summary = result(run)
    if summary:
        with fields_of(run / "summary.json"):
            _check_figures(summary)
            curve = _curve(run / "progress.csv", summary)
        made_with = read_json(run / versions.FILE)
        train = effective_config.load_recorded(run / "config.yaml").train
        tried = read_evaluation(run)
        return RunResult(cell, run, "done", summary, made_with, curve, train, tried)
    state = "failed" if cell.name in failures else _state_without_result(run)
    return RunResult(cell, run, state, {}, {}, {}, None)


def _check_figures(summary: Mapping[str, Any]) -> None:
    """Raises TypeError if a figure of a summary is no number, nor absent."""
    for name in (*SUMMARY_KEYS, *_ITERATIONS):
        value = summary.get(name)
        if name not in _TEXTS and not isinstance(value, int | float | None):
            raise TypeError(f"{name} is {value!r}")


def read_evaluation(run: Path) -> list[dict[str, Any]]:
    """Reads the rows that `./run.sh evaluate` wrote; [] if there are none.

    Raises UserError if the file is damaged.
    """
    file = run / EVALUATION
    if not file.is_file():
        return []
    with fields_of(file):
        found = read_json(file)
        rows = [{"amount": None, "episodes": found["episodes"], **row} for row in found["rows"]]
        for row in rows:
            texts = [row["group"], row["label"]]
            numbers = [row["success"], row["amount"]]
            if not all(isinstance(text, str) for text in texts):
                raise TypeError(f"a row is named {texts!r}")
            is_count = isinstance(row["episodes"], int)
            if not is_count or not all(isinstance(value, int | float | None) for value in numbers):
                raise TypeError(f"{texts} has {numbers!r}")
        return rows


def _state_without_result(run: Path) -> str:
    if not run.is_dir():
        return "not run"
    has_learned = (run / "training_state.json").is_file()
    # A summary without a result is that of --no-train.
    is_whole = (run / "summary.json").is_file() and not has_learned
    return "generation only" if is_whole else "unfinished"


def _curve(progress: Path, summary: dict[str, Any]) -> dict[str, Floats]:
    """Reads progress.csv, adds the costs of the generation, and takes those of evaluations out.

    Returns {} without evaluations. Raises UserError if the file is damaged.
    """
    curve = learning_curve(progress) if progress.is_file() else {}
    if not curve:
        return {}
    if not {*COSTS, *CURVE_COLUMNS} <= curve.keys():
        raise UserError(f"{progress}: lacks columns; legal: the file as the run wrote it")
    learning_cpu = curve["cpu_s"] - curve.get("evaluation_cpu_s", np.nan)
    return curve | {
        "pushes": curve["pushes"] + (summary.get("replays") or 0),
        "cpu_s": learning_cpu + (summary.get("generate_cpu_s") or 0.0),
    }


def _method_order(cell: Cell) -> int:
    return METHODS.index(cell.method) if cell.method in METHODS else len(METHODS)


def read_comparison(folder: Path, grid: Grid) -> Comparison:
    """Reads the results of all cells of the grid, see read_runs()."""
    return read_runs(
        {cell: folder / cell.name for cell in grid.commands_by_cell}, grid.failure_by_name
    )


def read_runs(folders: Mapping[Cell, Path], failures: Container[str]) -> Comparison:
    """Reads the results of cells from their run folders. Raises UserError if a file is damaged.

    The runs are sorted by task, method, settings and seed. Tasks are in the order of TASKS, methods
    in the order of METHODS. Other tasks follow. Other tasks, and the settings, are in the order of
    `folders`. `failures`: the names of the cells that have failed.
    """
    tasks = list(dict.fromkeys((*TASKS, *(cell.task for cell in folders))))
    settings = list(dict.fromkeys(cell.settings for cell in folders))
    cells = sorted(
        folders,
        key=lambda c: (tasks.index(c.task), _method_order(c), settings.index(c.settings), c.seed),
    )
    return Comparison(tuple(_result(folders[cell], cell, failures) for cell in cells))
