"""Transitions that several runs have in common: what changes only the learner leaves them alone."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

from rtg import _core
from rtg.errors import UserError
from rtg.files import versions
from rtg.run import effective_config

_FILES = ("transitions.npz", "generation.json")


def kind(config: _core.Config) -> str | None:
    """All that decides what a run generates, equal for equal transitions; None if it generates
    nothing."""
    if not config.train.offline:
        return None
    values = effective_config.values(config)
    parts = [values[section] for section in ("task", "physics", "reverse", "search")]
    return json.dumps([*parts, config.run.seed])


def are_there(run: Path) -> bool:
    """Says whether the generation of the run is complete."""
    return all((run / name).is_file() for name in _FILES)


def find(wanted: str, folder: Path, name: str) -> Path | None:
    """A run folder/*/name whose transitions are there and of that kind, made by this program."""
    for run in sorted(folder.glob(f"*/{name}")):
        if are_there(run) and _made_kind(run) == wanted:
            return run
    return None


def _made_kind(run: Path) -> str | None:
    """The kind of what this program has made there. What was made by another one, or cannot be
    read, is nothing to take over, whatever it may be to others."""
    config = run / "config.yaml"
    try:
        if versions.generator(run).get("core_sha256") != versions.core_digest():
            return None
        return kind(effective_config.written(config))
    except (UserError, OSError):
        return None


def take_over(source: Path, run: Path) -> None:
    """Into the folder of a run that has begun, without a copy where the disk allows that."""
    versions.note(run, versions.generator(source))
    for name in _FILES:
        draft = run / f".{name}.{os.getpid()}"
        try:
            os.link(source / name, draft)
        except OSError:
            shutil.copyfile(source / name, draft)
        draft.replace(run / name)
