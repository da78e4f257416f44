"""Paths of what the package goes with: in a checkout, or installed."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent
ROOT = _PACKAGE.parents[1]  # of a checkout
IN_CHECKOUT = (ROOT / "run.sh").is_file() and (ROOT / "train" / "rtg") == _PACKAGE

CONFIG = ROOT / "config" if IN_CHECKOUT else _PACKAGE / "config"
RUNS = (ROOT if IN_CHECKOUT else Path.cwd()) / "runs"
BUILD = ROOT / "build" / "release"
PROGRAMS = BUILD / "nodes" if IN_CHECKOUT else _PACKAGE / "programs"
GRAPH = ROOT / "graph.sh" if IN_CHECKOUT else PROGRAMS / "graph.sh"
DISTRIBUTION = "reverse-trajectory-generation"  # as it is installed
COMMAND = "./run.sh" if IN_CHECKOUT else "rtg"  # as people type it


def task_names() -> list[str]:
    """Returns the names of the tasks in config/. The command line takes them without a path."""
    return sorted(path.stem for path in CONFIG.glob("*.yaml"))
