"""Paths of folders in the checkout."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CONFIG = ROOT / "config"
RUNS = ROOT / "runs"
BUILD = ROOT / "build" / "release"


def task_names() -> list[str]:
    """Returns the names of the tasks in config/. The command line takes them without a path."""
    return sorted(path.stem for path in CONFIG.glob("*.yaml"))
