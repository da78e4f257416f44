"""Checks how the tables of a report put the figures of seeds."""

import pytest
from rtg.compare.report_tables import seed_ranges, spread, table


@pytest.mark.parametrize(
    ("values", "form", "words"),
    [
        ([1.0, 3.0], ".1f", "2.0 ± 1.4"),
        ([2.0], ".1f", "2.0"),
        ([2.0, None], ".1f", "2.0 (1 of 2)"),
        ([None], ".1f", "–"),
        ([9.0, 9.0], "count", "9.0 ± 0.0"),
        ([350.0], "count", "350"),
        ([0.0], "count", "0"),
    ],
)
def test_seeds_are_put_together_in_words(values, form, words):
    assert spread(values, form) == words


def test_seeds_in_a_row_are_written_short():
    assert seed_ranges([3, 1, 2, 7]) == "1-3, 7"


def test_bars_in_cells_do_not_end_them():
    assert table(["method"], [["`ddqn@data=a|b.npz`"]]).splitlines()[2] == (
        "| `ddqn@data=a\\|b.npz` |"
    )
