"""Paths of what the package goes with: in a checkout, or installed."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from pathlib import Path

from rtg import _core
from rtg.errors import UserError

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


def task_file(task: str, also: str = "", others: Sequence[str] = ()) -> Path:
    """Returns the file of `task`, which is a name or a path. Raises UserError if there is none.

    `also`: text for the message with further values that the caller accepts; `others`: such of them
    as may have been misspelt.
    """
    names = task_names()
    if task in names:
        return CONFIG / f"{task}.yaml"
    path, is_folder = Path(task), False
    with contextlib.suppress(OSError, ValueError):  # a name too long, or with a NUL
        if path.is_file():
            return path
        is_folder = path.is_dir()
    wrong = "no such task file"
    if path.suffix not in {".yaml", ".yml"} and not is_folder:
        wrong = f"no task of that name{_core.suggestion(task, [*names, *others])}"
    legal = f"{', '.join(names)}, the path of a FILE.yaml{also}"
    raise UserError(f"{task or repr(task)}: {wrong}; legal: {legal}")
