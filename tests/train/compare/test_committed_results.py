"""The reports of docs/results/ are what `./run.sh plot` makes of the runs there."""

import shutil
from pathlib import Path

import pytest
from rtg import paths
from rtg.compare import report_files

COMPARISONS = sorted(grid.parent for grid in (paths.ROOT / "docs" / "results").glob("*/grid.json"))


@pytest.mark.parametrize("folder", COMPARISONS, ids=lambda folder: folder.name)
def test_a_committed_report_is_that_of_its_runs(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pictures are not compared: other versions of a font library draw them differently."""
    monkeypatch.setattr(report_files, "_draw", lambda *_: None)
    for picture in [*folder.glob("*.png"), *folder.glob("*.gif")]:
        shutil.copy(picture, tmp_path)  # the page shows those that are there
    report_files.write_report(folder, tmp_path)
    for name in ("report.md", "report.json", "runs.csv", "curves.csv"):
        assert (tmp_path / name).read_text() == (folder / name).read_text(), name
