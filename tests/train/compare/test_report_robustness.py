"""What a report says of policies where they were not trained."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from comparison_samples import finished, table_row, write_grid
from rtg.compare.cells import Cell
from rtg.compare.report_files import write_report
from rtg.errors import UserError
from rtg.files.run_folder import write_json

CELLS = [Cell("gathering", "ddqn_rtg", (), seed) for seed in (1, 2, 3)]


def row(group: Any, label: Any, amount: Any, success: Any) -> dict[str, Any]:
    return {"group": group, "label": label, "amount": amount, "success": success}


def evaluation(success: float) -> list[dict[str, Any]]:
    """Rows in another order than that of the amounts, one of which is not possible."""
    return [
        row("as trained", "", None, success),
        row("friction", "x 0.7", 0.7, success - 0.1),
        row("friction", "x 1.3", 1.3, success - 0.2),
        row("objects moved", "by up to 2 m", 2.0, 0.5),
        row("objects moved", "by up to 1 m", 1.0, 0.75),
        row("objects moved", "by up to 0 m", 0.0, 1.0),
        row("objects turned", "by up to 1 rad", 1.0, None),
    ]


def written(folder: Path) -> None:
    """Two of three runs have been evaluated."""
    for cell in CELLS:
        finished(folder, cell, [0.5, 0.9])
    for cell, success in zip(CELLS, (1.0, 0.8), strict=False):
        rows = {"episodes": 100, "rows": evaluation(success)}
        write_json(folder / cell.name / "evaluation.json", rows)
    write_grid(folder, CELLS)


def section(page: str) -> str:
    return page.split("## Where it was not trained")[1]


def test_a_row_has_mean_and_deviation_of_the_runs_that_were_evaluated(tmp_path: Path) -> None:
    written(tmp_path)
    lines = section(write_report(tmp_path, tmp_path / "out").read_text()).splitlines()
    assert "| gathering |  | `ddqn_rtg` (2 × 100) |" in lines
    assert "| as trained |  | 0.90 ± 0.14 |" in lines
    assert "| friction | x 1.3 | 0.70 ± 0.14 |" in lines
    assert "| objects turned | by up to 1 rad | not possible |" in lines
    assert "![Success on gathering where it was not trained](robustness_gathering.png)" in lines


def test_lines_go_through_what_was_trained_in_the_order_of_the_amounts(
    tmp_path: Path, figures: list[Any]
) -> None:
    written(tmp_path)
    write_report(tmp_path, tmp_path / "out")
    (figure,) = (f for f in figures if f.axes[0].get_xlabel() == "objects moved by up to [m]")
    moved, turned, _, friction, *_ = [axis.get_lines()[0] for axis in figure.axes]
    assert moved.get_xydata().tolist() == [[0.0, 1.0], [1.0, 0.75], [2.0, 0.5]]
    assert turned.get_xydata().tolist() == [[0.0, 0.9]]
    assert np.allclose(friction.get_xydata(), [[0.7, 0.8], [1.0, 0.9], [1.3, 0.7]])


def test_a_run_without_a_variant_is_told_and_has_no_point(
    tmp_path: Path, figures: list[Any]
) -> None:
    written(tmp_path)
    few = {"episodes": 100, "rows": [r for r in evaluation(0.8) if r["amount"] != 1.3]}
    write_json(tmp_path / CELLS[1].name / "evaluation.json", few)
    page = write_report(tmp_path, tmp_path / "out").read_text()
    assert "| friction | x 1.3 | 0.80 (1 of 2) |" in section(page)
    (figure,) = (f for f in figures if f.axes[0].get_xlabel() == "objects moved by up to [m]")
    assert figure.axes[3].get_lines()[0].get_xdata().tolist() == [0.7, 1.0]


def test_a_variant_that_nobody_tried_is_not_said_to_be_impossible(tmp_path: Path) -> None:
    written(tmp_path)
    other = Cell("gathering", "her", (), 1)
    finished(tmp_path, other, [0.5, 0.9])
    few = {"episodes": 20, "rows": [r for r in evaluation(0.8) if r["group"] == "as trained"]}
    write_json(tmp_path / other.name / "evaluation.json", few)
    write_grid(tmp_path, [*CELLS, other])
    lines = section(write_report(tmp_path, tmp_path / "out").read_text()).splitlines()
    assert "| gathering |  | `ddqn_rtg` (2 × 100) | `her` (1 × 20) |" in lines
    assert "| objects turned | by up to 1 rad | not possible | – |" in lines


def test_evaluations_that_do_not_say_their_number_are_named(tmp_path: Path) -> None:
    written(tmp_path)
    file = tmp_path / CELLS[0].name / "evaluation.json"
    write_json(file, {"episodes": None, "rows": evaluation(1.0)})
    with pytest.raises(UserError, match=re.escape(str(file))):
        write_report(tmp_path, tmp_path / "out")


@pytest.mark.parametrize(
    "wrong",
    [row("friction", "x 2", 2.0, "0.9"), row("friction", "x 2", [2.0], 0.9), row("", 3, 2.0, 0.9)],
    ids=["success", "amount", "label"],
)
def test_figures_of_another_kind_are_named(tmp_path: Path, wrong: dict[str, Any]) -> None:
    written(tmp_path)
    file = tmp_path / CELLS[0].name / "evaluation.json"
    write_json(file, {"episodes": 100, "rows": [*evaluation(1.0), wrong]})
    with pytest.raises(UserError, match=re.escape(str(file))):
        write_report(tmp_path, tmp_path / "out")


def test_an_evaluation_of_before_there_were_amounts_has_its_rows(tmp_path: Path) -> None:
    written(tmp_path)
    for cell in CELLS[:2]:
        rows = [{k: v for k, v in r.items() if k != "amount"} for r in evaluation(1.0)]
        write_json(tmp_path / cell.name / "evaluation.json", {"episodes": 100, "rows": rows})
    page = write_report(tmp_path, tmp_path / "out").read_text()
    assert "| friction | x 1.3 | 0.80 ± 0.00 |" in section(page)


def test_runs_that_nobody_evaluated_have_no_such_section(tmp_path: Path) -> None:
    for cell in CELLS:
        finished(tmp_path, cell, [0.5, 0.9])
    write_grid(tmp_path, CELLS)
    page = write_report(tmp_path, tmp_path / "out").read_text()
    assert "not trained" not in page and table_row(page, "ddqn_rtg")
    assert not (tmp_path / "out" / "robustness_gathering.png").exists()
