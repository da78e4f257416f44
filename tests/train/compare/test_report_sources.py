"""Checks what a report says of reverse simulation and the other sources of data."""

import pytest
from comparison_samples import CONFIG, finished, write_grid
from rtg import _core
from rtg.compare.cells import Cell, read_grid
from rtg.compare.report_sources import NOTE, better_source
from rtg.compare.run_results import read_comparison

SOON, LATER, NEVER = [0.2, 0.96], [0.2, 0.8, 0.8, 0.96], [0.1, 0.9]
FIRST = "- **gathering**: reverse simulation is "


def said(folder, courses, task="gathering", **of_planner):
    """The text for one task. courses: of the seeds, by method."""
    cells = []
    for method, seeds in courses.items():
        for seed, course in enumerate(seeds, start=1):
            cells.append(Cell(task, method, (), seed))
            finished(folder, cells[-1], course, **(of_planner if method == "planner" else {}))
    write_grid(folder, cells)
    return better_source(read_comparison(folder, read_grid(folder)))


def row(text, head):
    """The cells of the row of that cost, behind the task and the cost."""
    line = next(line for line in text.splitlines() if line.startswith(f"| gathering | {head}"))
    return [cell.strip() for cell in line.strip("|").split("|")][2:]


@pytest.mark.parametrize(
    ("reference", "forward", "words", "cell"),
    [
        ([SOON, SOON], [LATER, NEVER], "better {} than {}", "better than {}"),
        ([SOON, NEVER], [NEVER, NEVER], "better {} than {}", "better than {}"),
        ([LATER, NEVER], [SOON, SOON], "not better {} than {}", "not better than {}"),
        ([SOON, LATER], [SOON, NEVER], "level {} with {}", "level with {}"),
        ([SOON, NEVER], [LATER, NEVER], "level {} with {}", "level with {}"),
    ],
)
def test_one_source_is_better_if_every_seed_of_it_is(tmp_path, reference, forward, words, cell):
    text = said(tmp_path, {"ddqn_rtg": reference, "ddqn_forward": forward})
    costs = "by interactions, pushes and CPU seconds"
    assert text.startswith(f"{FIRST}{words.format(costs, '`ddqn_forward`')}.\n\n")
    expected = cell.format("`ddqn_forward`")
    assert all(row(text, head)[-1] == expected for head in ("interactions", "pushes", "CPU"))


def test_none_may_get_there(tmp_path):
    text = said(tmp_path, {"ddqn_rtg": [NEVER, NEVER], "ddqn_scatter": [NEVER]})
    verdict = "unable to reach 0.95 in any seed, like `ddqn_scatter`"
    assert text.startswith(f"{FIRST}{verdict}.\n\n")
    assert row(text, "CPU")[-1] == verdict


def test_the_sources_compared_are_named(tmp_path):
    courses = {"ddqn_rtg": [SOON], "ddqn_naive": [NEVER], "ddqn_forward": [LATER]}
    text = said(tmp_path, courses)
    assert " than `ddqn_naive`, `ddqn_forward`.\n" in text


def test_one_better_source_is_enough_for_reverse_simulation_not_to_be(tmp_path):
    courses = {"ddqn_rtg": [LATER], "ddqn_naive": [SOON], "ddqn_forward": [NEVER]}
    text = said(tmp_path, courses)
    expected = "not better by interactions, pushes and CPU seconds than `ddqn_naive`"
    assert text.startswith(f"{FIRST}{expected}")
    assert row(text, "interactions")[-1] == "not better than `ddqn_naive`"


def test_costs_may_disagree(tmp_path):
    cells = [Cell("gathering", method, (), 1) for method in ("ddqn_rtg", "ddqn_forward")]
    finished(tmp_path, cells[0], SOON, replays=300_000, generate_cpu_s=200.0)
    finished(tmp_path, cells[1], LATER, replays=900_000, generate_cpu_s=10.0)
    write_grid(tmp_path, cells)
    text = better_source(read_comparison(tmp_path, read_grid(tmp_path)))
    sentence = "better by interactions and pushes than `ddqn_forward`; not better by CPU seconds "
    assert text.startswith(f"{FIRST}{sentence}than `ddqn_forward`.\n")


def test_the_figures_behind_it_are_means_and_their_ratios(tmp_path):
    courses = {
        "ddqn_naive": [SOON, NEVER],  # not all of its seeds get there
        "ddqn_forward": [LATER],
        "ddqn_rtg": [SOON, LATER],
        "ddqn_rtg_dr": [[0.96]],
        "cql_rtg": [[0.96]],
        "planner": [[0.97]],
    }
    text = said(tmp_path, courses, replays=None, generate_cpu_s=None, every={"pushes": 6.3e6})
    fewest, own, *ratios = row(text, "interactions")
    assert fewest == "`ddqn_rtg`: 15 ± 7" and own == "15 ± 7"
    assert ratios[:3] == ["1.33 ×", "1 of 2", "–"], "a planner makes no interactions"
    fewest, own, *ratios = row(text, "pushes")
    assert fewest == "`cql_rtg`: 305" and own == "315 ± 7"
    assert ratios[:3] == ["1.02 ×", "1 of 2", "20.00 ×"]
    assert row(text, "CPU")[:2] == ["`planner`: 50", "210 ± 71"]


def test_without_another_source_nothing_is_said(tmp_path):
    text = said(tmp_path, {"ddqn_rtg": [SOON], "her": [NEVER]})
    assert text.startswith("- **gathering**: not known, as `ddqn_rtg` or any other source is ")
    assert row(text, "CPU") == ["`ddqn_rtg`: 160", "160", "–", "–", "–", "–"]


def test_a_success_at_once_costs_nothing_but_is_no_never(tmp_path):
    text = said(tmp_path, {"ddqn_rtg": [NEVER], "planner": [[0.97]]}, every={"cpu_s": 0.0})
    assert row(text, "pushes")[1] == "never"
    assert row(text, "CPU")[4] == "1 of 1"


def test_the_note_says_that_a_planner_costs_the_sum_over_its_starts():
    words = " ".join(NOTE.split())
    expected = "`planner` searches anew from every start: its costs are the sum over all held-out"
    episodes = _core.Config.from_file(CONFIG).train.eval_episodes
    assert f"{expected} starts of the evaluation (`train.eval_episodes`, {episodes} by " in words
