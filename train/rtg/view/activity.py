"""Tells whether a run has ended, and whether anybody works on it."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from rtg.files import locks

# These files grow while programs are at work that hold no lock: rtg.train, nodes by hand.
_SIGNS = ("config.yaml", "training_state.json", "progress.csv")
_QUIET = 60.0  # [s] without a change of these, after which only the bus tells of such a run


def is_over(folder: Path) -> bool:
    """Returns whether a run has ended: its last file is written after it has begun or resumed."""
    summarised = any(path.name != locks.GRAPH_LOCK for path in _locks(folder))  # not by graph.sh
    last = ["summary.json"] if summarised else ["summary.json", "training.json"]
    ends = [folder / name for name in last if (folder / name).is_file()]
    began = (folder / "config.yaml").stat().st_mtime_ns
    return any(file.stat().st_mtime_ns >= began for file in ends)


def is_going_on(folder: Path, is_heard: Callable[[], bool] = lambda: False) -> bool:
    """Returns whether a run has not ended and a process works on it, here or elsewhere.

    `is_heard`: whether its bus tells of one. It is asked where neither locks nor files tell.
    """
    if is_over(folder):
        return False
    found = _locks(folder)
    return any(map(locks.is_locked, found)) if found else _age(folder) < _QUIET or is_heard()


def state(folder: Path) -> str:
    """Returns what is known of a run that has not ended, in words."""
    found = _locks(folder)
    if any(map(locks.is_locked, found)):
        return "the run goes on"
    if found:
        return "the run was not finished (it has no summary.json)"
    return f"no news for {_age(folder):.0f} s, and no lock tells whether the run goes on"


def _locks(folder: Path) -> list[Path]:
    return [path for path in locks.of_run(folder) if path.is_file()]


def _age(folder: Path) -> float:
    """Returns the time since a run last gave a sign of life in its files [s]."""
    files = [folder / name for name in _SIGNS]
    return time.time() - max(file.stat().st_mtime for file in files if file.is_file())
