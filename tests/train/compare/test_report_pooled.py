"""Checks what a report says of methods over all tasks."""

from comparison_samples import finished, table_row, write_grid
from rtg.compare.cells import Cell
from rtg.compare.report_files import write_report

POOLED = "## All tasks together"
GOOD = [0.2, 0.8, 0.96]


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
    assert reference[0] == "2" and reference[1].startswith("0.600 [")
    assert reference[2].startswith("0.500 [") and reference[3:5] == ["0.200", "0 of 3"]
    # Of 0.3 to 0.8 the middle half; the mean of 0.8 and 0.4; 0.5 on gathering, 1 on sorting.
    assert her[1].startswith("0.450 [") and her[2].startswith("0.600 [")
    assert her[3:5] == ["0.300", "0 of 4"] and her[5].startswith("0.750 [")


def test_single_seeds_have_no_interval(tmp_path):
    page = report(tmp_path, {("gathering", "ddqn_rtg"): ([0.9],), ("gathering", "her"): ([0.5],)})
    assert table_row(page, "her", POOLED) == ["1", "0.500", "0.500", "0.500", "0 of 1", "0.000"]


def test_domain_randomisation_is_compared_with_nothing(tmp_path):
    of = {("gathering", name): (GOOD,) for name in ("ddqn_rtg", "ddqn_rtg_dr")}
    page = report(tmp_path, of)
    assert table_row(page, "ddqn_rtg_dr", POOLED)[-1] == "–"
