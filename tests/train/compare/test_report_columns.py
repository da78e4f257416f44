"""Each column of the tables of a report, recomputed from what the runs left."""

from __future__ import annotations

import itertools
import statistics
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from comparison_samples import finished, summary_of, write_grid
from rtg.compare.cells import Cell, read_grid
from rtg.compare.report_tables import cost_table, data_table, results_table, runtime_table
from rtg.compare.run_results import Comparison, read_comparison

COURSES = ([0.1, 0.97, 0.96, 0.93], [0.8, 0.3, 0.95, 0.96], [0.5, 0.97, 0.99, 1.0])
EVERY = {"pushes": 6000.0, "cpu_s": 70.0}
THIRD = 10_000  # of a budget of 30,000

Summary = dict[str, Any]


def summaries() -> list[Summary]:
    """Makes the summaries of three seeds, each with figures of its own."""
    rng = np.random.default_rng(3)

    def other(value: Any) -> Any:
        if isinstance(value, bool) or not isinstance(value, int | float):
            return value
        return type(value)(value * rng.uniform(0.5, 2.0))

    found = [{name: other(v) for name, v in summary_of(seed).items()} for seed in (1, 2, 3)]
    for seed, summary in enumerate(found):
        summary["success_rate"] = 0.5 + 0.1 * seed
        summary["episode_length_mean"] = 20.0 + 3.0 * seed**2
        summary["rollout_success"] = 0.4 + 0.2 * seed
        summary["interactions"] = 20_000 + seed
    return found


@pytest.fixture
def runs(tmp_path: Path) -> tuple[Comparison, list[Summary]]:
    cells, found = [Cell("gathering", "ddqn_rtg", (), seed) for seed in (1, 2, 3)], summaries()
    for cell, course, summary in zip(cells, COURSES, found, strict=True):
        finished(tmp_path, cell, course, budget=3 * THIRD, every=EVERY, **summary)
    write_grid(tmp_path, cells)
    return read_comparison(tmp_path, read_grid(tmp_path)), found


def cells_of(table: str) -> dict[str, str]:
    """The one row of a table, by the heads of its columns, "..." with the head that it goes on."""
    lines = [[c.strip() for c in line.strip("|").split("|")] for line in table.split("\n")]
    heads, _, row, *_ = lines
    found, group = dict[str, str](), ""
    for head, cell in zip(heads, row, strict=True):
        group = head if not head.startswith("...") else group
        found[head if head == group else f"{group} {head}"] = cell
    return found


def words(values: Sequence[float], digits: int | None = None) -> str:
    """Mean and sample deviation; without digits: one below 10, none from there on."""
    mean = statistics.fmean(values)
    digits = (1 if 0 < mean < 10 else 0) if digits is None else digits
    return f"{mean:.{digits}f} ± {statistics.stdev(values):.{digits}f}"


def first(course: Sequence[float], bar: float) -> int:
    """The number of the first of two evaluations in a row that good, counted from 1."""
    return next(k for k, pair in enumerate(itertools.pairwise(course), 1) if min(pair) >= bar)


def test_what_was_learned(runs: tuple[Comparison, list[Summary]]) -> None:
    comparison, found = runs
    at_95 = [first(course, 0.95) for course in COURSES]
    of = {name: [s[name] for s in found] for name in found[0]}
    assert cells_of(results_table(comparison, "gathering")) == {
        "method": "`ddqn_rtg`",
        "seeds": "1-3",
        "success": words(of["success_rate"], 3),
        "length": words(of["episode_length_mean"], 1),
        "roll-outs": words(of["rollout_success"], 2),
        "at ⅓": words([course[THIRD // 5000 - 1] for course in COURSES], 2),
        "to 0.70": words([5 * first(course, 0.70) for course in COURSES]),
        "to 0.95": words([5 * at for at in at_95]),
        "pushes to 0.95": words(
            [(6000 * at + int(r)) / 1000 for at, r in zip(at_95, of["replays"], strict=True)]
        ),
        "CPU s to 0.95": words(
            [70 * at + s for at, s in zip(at_95, of["generate_cpu_s"], strict=True)]
        ),
    }


def test_what_the_runs_cost(runs: tuple[Comparison, list[Summary]]) -> None:
    comparison, found = runs
    of = {name: [s[name] for s in found] for name in found[0]}
    thousands = {name: [v / 1000 for v in of[name]] for name in ("transitions", "replays")}
    assert cells_of(cost_table(comparison, "gathering")) == {
        "method": "`ddqn_rtg`",
        "seeds": "1-3",
        "transitions": words(thousands["transitions"]),
        "generation: pushes": words(thousands["replays"]),
        "generation: pushes ... CPU [s]": words(of["generate_cpu_s"]),
        "generation: pushes ... wall [s]": words(of["generate_wall_s"]),
        "learning: interactions": words([v / 1000 for v in of["interactions"]]),
        "learning: interactions ... CPU [s]": words(of["train_cpu_s"]),
        "learning: interactions ... wall [s]": words(of["train_wall_s"]),
        "all: pushes": words([24 + v for v in thousands["replays"]]),
        "all: pushes ... CPU [s]": words([280 + v for v in of["generate_cpu_s"]]),
    }


def per_run(found: list[Summary], of: Callable[[Summary], float], digits: int | None) -> str:
    return words([of(summary) for summary in found], digits)


def test_run_time(runs: tuple[Comparison, list[Summary]]) -> None:
    comparison, found = runs
    columns: dict[str, tuple[Callable[[Summary], float], int | None]] = {
        "backward action [ms]": (
            lambda s: 1000 * s["reverse_cpu_s"] / (s["candidates"] - s["pruned"]),
            2,
        ),
        "forward action [ms]": (lambda s: 1000 * s["replay_cpu_s"] / s["replays"], 3),
        "solves [1000]": (lambda s: (s["candidates"] - s["pruned"]) / 1000, None),
        "pushes [1000]": (lambda s: s["replays"] / 1000, None),
        "converged": (lambda s: s["converged"] / (s["candidates"] - s["pruned"]), 3),
        "of these, moving an object": (lambda s: s["pushing_converged"] / s["converged"], 2),
        "iterations, median": (lambda s: s["pushing_iterations_median"], 0),
        "90th percentile": (lambda s: s["pushing_iterations_p90"], 0),
    }
    expected = {name: per_run(found, *column) for name, column in columns.items()}
    named = {"task": "gathering", "method": "`ddqn_rtg`"}
    assert cells_of(runtime_table(comparison)) == {**named, **expected}


def test_the_data(runs: tuple[Comparison, list[Summary]]) -> None:
    comparison, found = runs
    columns: dict[str, tuple[str, float, int | None]] = {
        "transitions [1000]": ("transitions", 1000, None),
        "tree rows": ("tree_transitions", 1000, None),
        "branches": ("branch_transitions", 1000, None),
        "headings per state": ("headings_per_state", 1, 1),
        "contact share": ("contact_share", 1, 2),
        "trees": ("trees", 1, None),
        "replay gap, median [m]": ("replay_gap_median", 1, 4),
        "90th percentile [m]": ("replay_gap_p90", 1, 4),
        "rank correlation of Q": ("q_rank_correlation", 1, 2),
        "error": ("q_error", 1, 3),
        "spread": ("q_spread", 1, 3),
    }
    expected = {
        name: words([s[key] / unit for s in found], digits)
        for name, (key, unit, digits) in columns.items()
    }
    named = {"task": "gathering", "method": "`ddqn_rtg`"}
    assert cells_of(data_table(comparison)) == {**named, **expected}


def test_runs_without_transitions_have_no_figures_but_are_counted(tmp_path: Path) -> None:
    cells = [Cell("gathering", "ddqn_naive", (), seed) for seed in (1, 2, 3)]
    for cell, count in zip(cells, (0, 1000, 3000), strict=True):
        finished(tmp_path, cell, [0.5], transitions=count)
    write_grid(tmp_path, cells)
    table = data_table(read_comparison(tmp_path, read_grid(tmp_path)))
    assert "| gathering | `ddqn_naive` | 2.0 ± 1.4 (2 of 3) |" in table
    assert "| 0.50 ± 0.00 (2 of 3) |" in table


def test_evaluations_are_no_part_of_the_cost(tmp_path: Path) -> None:
    cell = Cell("gathering", "ddqn_rtg", (), 1)
    every = {"cpu_s": 70.0, "evaluation_cpu_s": 30.0}
    finished(tmp_path, cell, [0.2, 0.96, 0.97], every=every, generate_cpu_s=5.0)
    write_grid(tmp_path, [cell])
    comparison = read_comparison(tmp_path, read_grid(tmp_path))
    (run,) = comparison.results
    assert run.cost_to_reach(0.95, "cpu_s") == 2 * (70.0 - 30.0) + 5.0
    assert run.total_cost("cpu_s") == 3 * (70.0 - 30.0) + 5.0


def test_a_planner_learns_nothing_that_could_take_time(tmp_path: Path) -> None:
    cell = Cell("gathering", "planner", (), 1)
    finished(tmp_path, cell, [0.97], replays=None, generate_cpu_s=None)
    write_grid(tmp_path, [cell])
    row = cells_of(results_table(read_comparison(tmp_path, read_grid(tmp_path)), "gathering"))
    of_time = ("at ⅓", "to 0.70", "to 0.95", "pushes to 0.95", "CPU s to 0.95")
    assert [row[name] for name in of_time] == ["–"] * 5


def test_who_does_not_know_the_cost_is_not_said_never_to_get_there(tmp_path: Path) -> None:
    cell = Cell("gathering", "ddqn_rtg", (), 1)
    finished(tmp_path, cell, [0.96, 0.97], every={"evaluation_cpu_s": float("nan")})
    write_grid(tmp_path, [cell])
    row = cells_of(results_table(read_comparison(tmp_path, read_grid(tmp_path)), "gathering"))
    assert (row["to 0.95"], row["CPU s to 0.95"]) == ("5.0", "–")
