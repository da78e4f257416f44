"""What a report says of methods over all tasks, and against the reference."""

from comparison_samples import finished, table_row, write_grid
from rtg.cells import Cell
from rtg.report_files import write_report

POOLED = "## All tasks together"
GOOD, BAD = [0.2, 0.8, 0.96], [0.0, 0.5, 0.6, 0.7]
OF_RIVALS = "the learner has as much to go on.\n\n"


def report(folder, courses):
    """courses: of the seeds, by task and method."""
    cells = []
    for (task, method), seeds in courses.items():
        for seed, course in enumerate(seeds, start=1):
            cells.append(Cell(task, method, (), seed))
            finished(folder, cells[-1], course)
    write_grid(folder, cells)
    return write_report(folder, folder).read_text()


def test_methods_are_pooled_over_the_tasks_that_more_than_one_was_run_on(tmp_path):
    """Pairs are of one task, and each task counts alike however many its seeds."""
    page = report(
        tmp_path,
        {
            ("gathering", "ddqn_rtg"): ([0.9], [0.7]),
            ("gathering", "her"): ([0.8],),
            ("sorting", "ddqn_rtg"): ([0.2],),
            ("sorting", "her"): ([0.3], [0.4], [0.5]),
            ("art_manip", "ddqn_rtg"): ([0.0],),
        },
    )
    reference, her = (table_row(page, label, POOLED) for label in ("ddqn_rtg", "her"))
    assert reference[:2] == ["2", "3"] and reference[2].startswith("0.60 [")
    # Of 0.3 to 0.8 the middle half; 0.5 on gathering, 1 on sorting.
    assert her[2].startswith("0.45 [") and her[3].startswith("0.75 [")


def test_single_seeds_have_no_interval(tmp_path):
    page = report(tmp_path, {("gathering", "ddqn_rtg"): ([0.9],), ("gathering", "her"): ([0.5],)})
    assert table_row(page, "her", POOLED) == ["1", "1", "0.50", "0.00"]


def test_a_method_that_is_no_worse_than_the_reference_is_named(tmp_path):
    naive, reference = ("gathering", "ddqn_naive"), ("gathering", "ddqn_rtg")
    worse = report(tmp_path / "worse", {naive: (BAD, BAD), reference: (GOOD, GOOD)})
    assert f"{OF_RIVALS}None.\n" in worse
    page = report(tmp_path / "better", {naive: (GOOD, GOOD), reference: (BAD, BAD)})
    plans = "tree policy 0.85 ± 0.00"
    good, bad = f"0.96 ± 0.00, 0.95 after 15 ± 0, {plans}", f"0.70 ± 0.00, never at 0.95, {plans}"
    assert f"{OF_RIVALS}- gathering, `ddqn_naive`: {good}; `ddqn_rtg`: {bad}\n\n" in page


def test_domain_randomisation_is_compared_with_nothing(tmp_path):
    of = {("gathering", name): (GOOD,) for name in ("ddqn_rtg", "ddqn_rtg_dr")}
    page = report(tmp_path, of)
    assert table_row(page, "ddqn_rtg_dr", POOLED)[-1] == "–"
    assert f"{OF_RIVALS}Nothing to compare yet.\n" in page
