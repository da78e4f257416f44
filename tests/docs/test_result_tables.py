"""The figures of the README and of docs/results/index.md are those of the committed reports."""

import csv
import functools
import re
import statistics

from rtg import paths

PAGE = paths.ROOT / "docs" / "results" / "index.md"
TABLE = re.compile(r"<!-- from: (\w+) -->\n\n((?:\|.*\n)+)")
Run = dict[str, str]


@functools.cache
def runs_of(report: str) -> list[Run]:
    with (paths.ROOT / "docs" / "results" / report / "runs.csv").open() as file:
        return [run for run in csv.DictReader(file) if run["state"] == "done"]


def success(runs: list[Run]) -> str:
    return f"{statistics.mean(float(run['success_rate']) for run in runs):.2f}"


def thousands_to_95(runs: list[Run]) -> str:
    """Returns the mean of the interactions to 0.95 in words, in thousands."""
    known = [float(to) / 1000.0 for run in runs if (to := run["interactions_to_95"])]
    if not known:
        return "never"
    few = "" if len(known) == len(runs) else f" ({len(known)} of {len(runs)})"
    return f"{statistics.mean(known):.0f}{few}"


def cell(report: str, names: set[str]) -> str:
    """Returns success and thousand interactions to 0.95, means over the seeds; – if there are none.

    `names`: task and method of the runs. A planner has no interactions.
    """
    runs = [run for run in runs_of(report) if {run["task"], run["method"]} == names]
    if not runs:
        return "–"
    planned = runs[0]["method"].startswith("planner")
    return success(runs) if planned else f"{success(runs)}, {thousands_to_95(runs)}"


def cells_of(line: str) -> list[str]:
    return [text.strip() for text in line.strip().strip("|").split("|")]


def test_the_tables_of_the_page_are_those_of_the_reports() -> None:
    tables = TABLE.findall(PAGE.read_text())
    assert {report for report, _ in tables} >= {"whole", "tasks"}
    for report, text in tables:
        head, rule, *rows = text.splitlines()
        columns = [name.strip("`") for name in cells_of(head)[1:]]
        named = {*columns, *(cells_of(row)[0].strip("`") for row in rows)}
        assert named >= {run["task"] for run in runs_of(report)}, f"table from {report}"
        expected = [head, rule]
        for row in rows:
            name = cells_of(row)[0]
            found = [cell(report, {name.strip("`"), column}) for column in columns]
            expected.append(f"| {' | '.join([name, *found])} |")
        assert text.splitlines() == expected, f"table from {report}"


def test_the_table_of_the_readme_is_that_of_the_reports() -> None:
    rows = re.findall(r"^\| `(\w+)` \|(.*)\|$", (paths.ROOT / "README.md").read_text(), re.M)
    written = {task: ", ".join(cells_of(cells)[-2:]) for task, cells in rows}
    reports = {run["task"]: report for report in ("tasks", "whole") for run in runs_of(report)}
    assert written == {task: cell(of, {task, "ddqn_rtg"}) for task, of in reports.items()}
