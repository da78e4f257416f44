"""The numbered examples of the package, each run as it is, the long ones with little data."""

import importlib
import pkgutil
from pathlib import Path

import pytest
import rtg.examples

ALL = (module.name for module in pkgutil.iter_modules(rtg.examples.__path__))
NAMES = sorted(name for name in ALL if name[0].isdigit())
SMALL = {
    "08_own_learner": {"transitions": 1000, "steps": 20},
    "09_train": {"transitions": 500, "interactions": 80},
    "10_own_data": {"transitions": 300, "interactions": 80},
    "11_own_engine": {"transitions": 300},
}


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
