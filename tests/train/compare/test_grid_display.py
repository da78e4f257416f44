"""Checks how a comparison shows where its runs stand."""

import io

import pytest
from rich.console import Console
from rtg.compare.grid_display import LiveGrid, PlainGrid, Row, counts, display, visible

ROWS = [Row("a", "done", "success 1.00"), Row("b", "running", "round 1"), Row("c")]


def test_a_pipe_gets_a_line_per_change():
    out = io.StringIO()
    with display(out) as shown:
        assert isinstance(shown, PlainGrid)
        for rows in (ROWS, ROWS, [*ROWS[:2], Row("c", "failed", "killed")]):
            shown.show(rows)
    lines = [line.split("] ")[1] for line in out.getvalue().splitlines()]
    assert lines == ["a: done (success 1.00)", "b: running (round 1)", "c: failed (killed)"]


def test_a_terminal_gets_a_row_per_run_with_its_last_line():
    out = io.StringIO()
    console = Console(file=out, force_terminal=True, width=80, height=20)
    with LiveGrid(console) as shown:
        shown.show([*ROWS, Row("d", "failed", "killed\nMemoryError")])
    last = out.getvalue()
    assert "success 1.00" in last and "waiting" in last and "MemoryError" in last
    assert "killed" not in last
    assert "1 of 4 runs done, 1 failed, 1 running" in last


@pytest.mark.parametrize(("room", "names"), [(9, "abc"), (2, "bc"), (1, "b"), (-2, "b")])
def test_a_small_terminal_shows_what_is_at_work(room, names):
    assert "".join(row.name for row in visible(ROWS, room)) == names


def test_counts_name_failures_and_other_processes_only_if_there_are_any():
    assert counts(ROWS) == "1 of 3 runs done, 1 running"
    assert counts([Row("x", "failed")]) == "0 of 1 runs done, 1 failed, 0 running"
    assert counts([Row("x", "elsewhere")]) == "0 of 1 runs done, 0 running, 1 elsewhere"
