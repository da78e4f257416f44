"""The reports of docs/results/ are what `./run.sh plot` makes of the runs there, byte for byte."""

from pathlib import Path

import pytest
from rtg import paths
from rtg.compare import report_files

COMPARISONS = sorted(grid.parent for grid in (paths.ROOT / "docs" / "results").glob("*/grid.json"))
KINDS = (".csv", ".gif", ".json", ".md", ".png")


def made(folder: Path) -> dict[str, bytes]:
    """The files of a report, pictures among them, without what it is made from."""
    given = ("grid.json", "remarks.md")
    found = [path for path in folder.iterdir() if path.suffix in KINDS and path.name not in given]
    return {path.name: path.read_bytes() for path in found}


@pytest.mark.parametrize("folder", COMPARISONS, ids=lambda folder: folder.name)
def test_a_committed_report_is_that_of_its_runs(folder: Path, tmp_path: Path) -> None:
    report_files.write_report(folder, tmp_path)
    again, committed = made(tmp_path), made(folder)
    assert sorted(again) == sorted(committed)
    changed = [name for name in again if again[name] != committed[name]]
    assert not changed, f"made anew by ./run.sh plot {folder.relative_to(paths.ROOT)}"
