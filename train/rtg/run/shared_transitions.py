"""Shares transitions among runs that differ only in their learner."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path
from typing import Any

from rtg import _core, engines
from rtg.errors import UserError
from rtg.files import versions
from rtg.run import effective_config

_FILES = ("transitions.npz", "generation.json")


def determining_values(config: _core.Config) -> dict[str, Any]:
    """Returns, by "section.key", all values that determine the generated transitions."""
    values = effective_config.values(config)
    found: dict[str, Any] = {"run.seed": config.run.seed}
    for section in ("task", "physics", "forward", "reverse", "search"):
        found.update({f"{section}.{name}": value for name, value in values[section].items()})
    return found


def generation_key(config: _core.Config) -> str | None:
    """Returns a key of the generated transitions, made of the determining_values().

    Runs with equal keys generate equal transitions. Returns None if the run generates none.
    """
    if not config.train.offline:
        return None
    return _key(config, engines.identity(config))


def _key(config: _core.Config, engine: str) -> str:
    return json.dumps({**determining_values(config), versions.ENGINE_KEY: engine})


def is_generated(run: Path) -> bool:
    """Returns whether the generation of the run is complete, and its transitions are sealed."""
    is_whole = all((run / name).is_file() for name in _FILES)
    return is_whole and versions.sealed_digest(run / _FILES[0]) is not None


def find(key: str, folder: Path, name: str) -> Path | None:
    """Finds a run `folder`/*/`name` with complete transitions whose generation_key() is `key`.

    Only transitions of this version of the program count. Returns None if there is no such run.
    """
    for run in sorted(folder.glob(f"*/{name}")):
        if is_generated(run) and _stored_key(run) == key:
            return run
    return None


def _stored_key(run: Path) -> str | None:
    """Returns the generation_key() of the transitions of `run`.

    Returns None if another version of the program made them, or if the folder cannot be read.
    """
    config = run / "config.yaml"
    try:
        made_by = versions.generator(run)
        if made_by.get("core_sha256") != versions.core_digest():
            return None
        return _key(effective_config.load_written(config), str(made_by.get(versions.ENGINE_KEY)))
    except (UserError, OSError):
        return None


def take_over(source: Path, run: Path) -> None:
    """Links the transitions of run `source` into the existing run `run`, or copies them.

    Raises UserError if they were changed.
    """
    versions.check_seal(source / _FILES[0])
    made_by = versions.generator(source)
    versions.write(run, made_by.get(versions.ENGINE_KEY), made_by)
    for name in _FILES:
        draft = run / f".{name}.{os.getpid()}"
        draft.unlink(missing_ok=True)  # of a process that was killed, whose number we have now
        try:
            os.link(source / name, draft)
        except OSError:
            shutil.copyfile(source / name, draft)
        draft.replace(run / name)
