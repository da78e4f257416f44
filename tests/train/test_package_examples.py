"""The numbered examples of the package, each run as it is, the long ones with little data."""

import importlib
from pathlib import Path

import pytest
from small_examples import NAMES, SMALL


def test_they_are_numbered() -> None:
    assert [name[:3] for name in NAMES] == [f"{k:02}_" for k in range(1, 12)]


@pytest.mark.parametrize("name", NAMES)
def test_an_example_runs_and_leaves_its_picture(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if name == "11_own_engine":
        pytest.importorskip("pymunk", reason="pymunk is not installed")
    importlib.import_module(f"rtg.examples.{name}").main(tmp_path, **SMALL.get(name, {}))
    pictures = [path for path in tmp_path.iterdir() if path.stem == name]
    assert len(pictures) == 1 and pictures[0].stat().st_size > 5000
    assert capsys.readouterr().out
