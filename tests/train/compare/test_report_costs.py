"""Checks how a report compares the costs of methods with those of the reference."""

import itertools

import numpy as np
import pytest
from comparison_samples import VERSIONS, finished, write_grid
from rtg.compare.cells import Cell, read_grid
from rtg.compare.estimates import rank_test
from rtg.compare.report_costs import CHANCE, cost_comparison
from rtg.compare.run_results import read_comparison
from rtg.files.run_folder import write_json

# Courses that solve the task after 5, 10, 15, 20 thousand interactions, or never.
SOON, LATER, LATE, LAST = ([0.1] * k + [0.96, 0.97] for k in range(4))
NEVER = [0.1, 0.9, 0.94]
OF_PLANNER = {"every": {"pushes": 6.2e6, "cpu_s": 400.0}, "replays": None, "generate_cpu_s": None}


def compared(folder, courses, **more):
    """The comparison of gathering. courses: of the seeds, by method with its settings."""
    cells = []
    for label, seeds in courses.items():
        method, *settings = label.split("@")
        for seed, course in enumerate(seeds, start=1):
            cells.append(Cell("gathering", method, tuple(settings), seed))
            finished(folder, cells[-1], course, **{"budget": 25_000, **more.get(label, {})})
    write_grid(folder, cells)
    return read_comparison(folder, read_grid(folder))


def row(text, label):
    """The cells of the row of that label: interactions, pushes, CPU seconds."""
    line = next(line for line in text.splitlines() if line.startswith(f"| gathering | `{label}` |"))
    return [cell.strip() for cell in line.strip("|").split("|")][2:]


@pytest.mark.parametrize(
    ("reference", "other", "words"),
    [
        ([SOON, LATER, LATER], [LATE, LATE, LAST], "fewer than"),
        ([LATE, LATE, LAST], [SOON, LATER, LATER], "more than"),
        ([SOON, LATER, LATER], [LATER, LATE, NEVER], "not told apart from"),  # overlap
        ([SOON, SOON, LATER], [NEVER, NEVER, NEVER], "fewer than"),
        ([NEVER, NEVER, NEVER], [NEVER, LATE, NEVER], "not told apart from"),
        ([NEVER, NEVER, NEVER], [NEVER, NEVER, NEVER], "not told apart from"),
        ([SOON, SOON, SOON], [NEVER], "too few seeds to tell from"),
        ([SOON, SOON, SOON], [NEVER, NEVER], "too few seeds to tell from"),
        ([SOON] * 4 + [LATE], [LATER] + [LAST] * 4, "fewer than"),  # of 25 pairs one is lost
    ],
)
def test_a_difference_is_told_if_chance_hardly_makes_one_as_clear(
    tmp_path, reference, other, words
):
    text = cost_comparison(compared(tmp_path, {"ddqn_rtg": reference, "her": other}))
    said = " ".join(f"{c}: {words} `her`." for c in ("Interactions", "Pushes", "CPU seconds"))
    assert text.startswith(
        f"What `ddqn_rtg` needs until it solves 0.95:\n\n- **gathering**. {said}"
    )
    is_bold = [cell.startswith("**") for cell in row(text, "her")]
    assert is_bold == [words in ("fewer than", "more than")] * 3


@pytest.mark.parametrize(("count", "others"), [(3, 3), (5, 5), (5, 3), (2, 8)])
def test_chance_tells_apart_no_more_often_than_the_note_says(count, others):
    """All ways to divide costs that are alike, of which two runs never get there."""
    costs = np.append(np.arange(count + others - 2.0), [np.inf, np.inf])
    told = []
    for chosen in itertools.combinations(range(count + others), count):
        told.append(rank_test(costs[list(chosen)], np.delete(costs, chosen)) <= CHANCE)
    assert 0.0 < np.mean(told) <= CHANCE


def test_the_figures_are_multiples_of_the_medians(tmp_path):
    text = cost_comparison(
        compared(
            tmp_path,
            {
                "ddqn_rtg": [SOON, LATER, LAST],
                "ddqn_naive": [LATE, LATE, NEVER],
                "her": [NEVER, NEVER, LATER],
                "rcg": [NEVER, NEVER, NEVER],
            },
            her={"replays": None, "generate_cpu_s": None},
        )
    )
    assert row(text, "ddqn_rtg") == ["10 (5–20)", "310 (305–320)", "160 (110–260)"]
    assert row(text, "ddqn_naive") == ["1.50 ×, 2 of 3", "1.02 ×, 2 of 3", "1.31 ×, 2 of 3"]
    assert row(text, "her") == ["1 of 3"] * 3
    assert row(text, "rcg") == ["**never**"] * 3


def test_methods_without_interactions_are_compared_by_the_other_costs(tmp_path):
    courses = {"ddqn_rtg": [SOON] * 3, "bc_rtg": [LATER] * 3}
    text = cost_comparison(compared(tmp_path, courses))
    assert row(text, "bc_rtg")[0] == "–" and row(text, "bc_rtg")[1] == "**1.02 ×**"
    assert "Interactions" not in text and "Pushes: fewer than `bc_rtg`." in text


def test_swept_settings_have_a_row_and_no_sentence(tmp_path):
    courses = {"ddqn_rtg": [SOON] * 3, "ddqn_rtg@train.batch=8": [LATER] * 3}
    text = cost_comparison(compared(tmp_path, courses))
    assert row(text, "ddqn_rtg@train.batch=8") == ["**2.00 ×**", "**1.02 ×**", "**1.45 ×**"]
    assert text.startswith("| task | method |")


def test_a_planner_has_the_costs_of_one_start_and_is_not_ranked(tmp_path):
    courses = {"ddqn_rtg": [SOON, LATER, LATER], "planner": [[0.97]]}
    text = cost_comparison(compared(tmp_path, courses, planner=OF_PLANNER))
    assert row(text, "planner") == ["–", "62 a start (5)", "4 a start (40)"]
    assert "`planner`" not in text.split("|")[0]


def test_a_planner_that_fails_has_costs_but_no_start_from_which_learning_pays(tmp_path):
    courses = {"ddqn_rtg": [SOON, LATER, LATER], "planner": [[0.4]]}
    text = cost_comparison(compared(tmp_path, courses, planner=OF_PLANNER))
    assert row(text, "planner") == ["–", "62 a start", "4 a start"]


@pytest.mark.parametrize(
    ("versions", "more"),
    [
        ({**VERSIONS, "processor": "Z81"}, {}),
        ({**VERSIONS, "processor": None}, {}),
        (VERSIONS, {"device": "cuda"}),
        (VERSIONS, {"precision": "bfloat16"}),
        (VERSIONS, {"runs_in_process": 2}),
        (VERSIONS, {"every": {"evaluation_cpu_s": float("nan")}}),
    ],
)
def test_cpu_seconds_of_other_kinds_are_not_compared(tmp_path, versions, more):
    comparison = compared(tmp_path, {"ddqn_rtg": [SOON] * 3, "her": [LATER] * 3}, her=more)
    for run in comparison.row("gathering", "her"):
        write_json(run.folder / "versions.json", versions)
    text = cost_comparison(read_comparison(tmp_path, read_grid(tmp_path)))
    assert row(text, "her") == ["**2.00 ×**", "**1.02 ×**", "not comparable"]
    assert "CPU seconds" not in text


def test_other_budgets_are_not_compared(tmp_path):
    label = "ddqn_rtg@train.interactions=15000"
    courses = {"ddqn_rtg": [LATE] * 3, label: [NEVER] * 3}
    text = cost_comparison(compared(tmp_path, courses, **{label: {"budget": 15_000}}))
    assert row(text, label) == ["other budget"] * 3


def test_without_the_reference_or_another_method_there_is_nothing_to_say(tmp_path):
    for name, courses in {
        "alone": {"ddqn_rtg": [SOON]},
        "randomised": {"ddqn_rtg": [SOON], "ddqn_rtg_dr": [SOON]},
        "others": {"her": [SOON], "rcg": [SOON]},
    }.items():
        assert cost_comparison(compared(tmp_path / name, courses)) == ""
    assert cost_comparison(compared(tmp_path / "both", {"ddqn_rtg": [SOON], "her": [SOON]}))
