"""Checks how a report compares the costs of methods with those of the reference."""

import pytest
from comparison_samples import finished, write_grid
from rtg.compare.cells import Cell, read_grid
from rtg.compare.report_costs import cost_comparison, has_comparison
from rtg.compare.run_results import read_comparison
from rtg.files.run_folder import write_json

# Courses that solve the task after 5, 10, 15, 20 thousand interactions, or never.
SOON, LATER, LATE, LAST = ([0.1] * k + [0.96, 0.97] for k in range(4))
NEVER = [0.1, 0.9, 0.94]


def compared(folder, courses, **more):
    """The comparison of gathering. courses: of the seeds, by method with its settings."""
    cells = []
    for label, seeds in courses.items():
        method, *settings = label.split("@")
        for seed, course in enumerate(seeds, start=1):
            cells.append(Cell("gathering", method, tuple(settings), seed))
            finished(folder, cells[-1], course, **more.get(method, {}))
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
        ([SOON, SOON, SOON], [NEVER], "not told apart from"),  # one seed against three
        ([SOON, SOON, SOON], [NEVER, NEVER], "not told apart from"),
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
    assert is_bold == [words != "not told apart from"] * 3


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
    assert row(text, "ddqn_rtg") == ["12 ± 8", "312 ± 8", "177 ± 76"]
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
    of_planner = {"final_episodes": 100, "every": {"pushes": 6.2e6, "cpu_s": 400.0}}
    of_planner |= {"replays": None, "generate_cpu_s": None}
    text = cost_comparison(compared(tmp_path, courses, planner=of_planner))
    assert row(text, "planner") == ["–", "62 a start (5)", "4 a start (40)"]
    assert "`planner`" not in text.split("|")[0]


def test_cpu_seconds_of_other_processors_are_not_compared(tmp_path):
    comparison = compared(tmp_path, {"ddqn_rtg": [SOON] * 3, "her": [LATER] * 3})
    write_json(comparison.row("gathering", "her")[0].folder / "versions.json", {"processor": "Z80"})
    text = cost_comparison(read_comparison(tmp_path, read_grid(tmp_path)))
    assert row(text, "her") == ["**2.00 ×**", "**1.02 ×**", "other processor"]
    assert "CPU seconds" not in text


def test_without_the_reference_or_another_method_there_is_nothing_to_say(tmp_path):
    for name, courses in {
        "alone": {"ddqn_rtg": [SOON]},
        "randomised": {"ddqn_rtg": [SOON], "ddqn_rtg_dr": [SOON]},
        "others": {"her": [SOON], "rcg": [SOON]},
    }.items():
        assert not has_comparison(compared(tmp_path / name, courses)), name
    assert has_comparison(compared(tmp_path / "both", {"ddqn_rtg": [SOON], "her": [SOON]}))
