"""Paths of folders and programs in the checkout."""

from __future__ import annotations

from pathlib import Path

from rtg.errors import RunError

ROOT = Path(__file__).resolve().parents[2]
CONFIG = ROOT / "config"
RUNS = ROOT / "runs"
BUILD = ROOT / "build" / "release"


def program(name: str) -> Path:
    """Returns the path of a C++ program of RTG.

    Raises RunError, which names the remedy, if the program is not built.
    """
    path = BUILD / "nodes" / name
    if not path.is_file():
        raise RunError(f"{path} is not built: start through ./run.sh, which builds it")
    return path


def task_names() -> list[str]:
    """Returns the names of the tasks in config/. The command line takes them without a path."""
    return sorted(path.stem for path in CONFIG.glob("*.yaml"))
