"""Where things are in the checkout."""

from __future__ import annotations

from pathlib import Path

from rtg.errors import RunError

ROOT = Path(__file__).resolve().parents[2]
CONFIG = ROOT / "config"
RUNS = ROOT / "runs"
BUILD = ROOT / "build" / "release"


def program(name: str) -> Path:
    """The path of a C++ program of ours. Raises RunError with the remedy if it is not built."""
    path = BUILD / "nodes" / name
    if not path.is_file():
        raise RunError(f"{path} is not built: start through ./run.sh, which builds it")
    return path


def task_names() -> list[str]:
    """Tasks that can be named without a path."""
    return sorted(path.stem for path in CONFIG.glob("*.yaml"))
