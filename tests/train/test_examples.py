"""The tasks of config/examples, such as a user's own, run from the file to the summary."""

import json
from pathlib import Path

import pytest
from rtg import cli, paths

SMALL = ["--transitions", "600", "--interactions", "400", "--in-process", "--workers", "1"]
SETTINGS = ("search.breadth=8", "search.depth=4")
FILES = sorted((paths.CONFIG / "examples").glob("*.yaml"))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_an_example_runs_from_its_file_to_the_summary(file: Path, tmp_path: Path) -> None:
    out = tmp_path / "run"
    settings = [word for setting in SETTINGS for word in ("--set", setting)]
    assert cli.main([str(file), *SMALL, *settings, "--out", str(out)]) == 0
    summary = json.loads((out / "summary.json").read_text())
    assert summary["task"] == file.stem and summary["transitions"] == 600
    assert summary["interactions"] == 400 and summary["converged"] > 0
    assert summary["contact_share"] > 0.2
    assert (out / "episode.gif").exists()


def test_there_is_an_example() -> None:
    assert FILES
