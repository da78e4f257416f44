"""Loads configurations through the C++ loader. No Python code parses YAML."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rtg import _core, engines
from rtg.errors import UserError
from rtg.files import run_folder
from rtg.run.run_args import Override

Values = dict[str, dict[str, Any]]  # section -> key -> value

TREE_GENERATORS = ("rrbs", "naive")  # values of search.generator that grow trees, backwards


def load(file: Path, overrides: Sequence[Override] = ()) -> _core.Config:
    """Loads `file` with `overrides`. Raises UserError for a mistake; it quotes the typed flags."""
    try:
        return _core.Config.from_file(file, [override.setting for override in overrides])
    except _core.ConfigError as error:
        message = str(error)
        for override in overrides:
            message = message.replace(f"--set {override.setting}", override.typed)
        raise UserError(message) from None


def values(config: _core.Config) -> Values:
    """Returns all values of `config`, to compare them with those of another configuration."""
    result: Values = json.loads(config.json)
    return result


def as_typed(value: Any) -> str:
    """Returns a value of values() as a user writes it after `--set KEY=`."""
    return value if isinstance(value, str) else json.dumps(value)


def load_written(file: Path) -> _core.Config:
    """Loads `file`, a configuration that this version of RTG must have written.

    Raises UserError if `file` was changed, or lacks a line that this version would write. The
    version that wrote it may have had another default for that setting.
    """
    found = _settings(run_folder.read_config(file))
    config = load(file)
    missing = [line for line in _settings(config.yaml) if line not in found]
    if missing:
        raise UserError(
            f"{file}: has no line '{missing[0][1]}': another version of RTG wrote it; legal: that "
            "version (git_revision in versions.json), or another --out"
        )
    return config


def load_recorded(file: Path) -> _core.Config:
    """Loads `file`, a configuration that some version of RTG wrote, for a report on its run.

    Leaves out settings that this version no longer has. Raises UserError for other defects.
    """
    lines = run_folder.read_config(file).splitlines()
    while True:
        try:
            return _core.Config.from_text("\n".join(lines), str(file))
        except _core.ConfigError as error:
            gone = re.match(re.escape(str(file)) + r":(\d+): key '[\w.]+': no such key", str(error))
            if not gone or not lines[int(gone[1]) - 1]:
                raise UserError(str(error)) from None
            lines[int(gone[1]) - 1] = ""


def _settings(text: str) -> list[tuple[str, str]]:
    """Returns (section, line without comment) for each line."""
    found, section = [], ""
    for line in text.splitlines():
        section = section if line.startswith((" ", "#")) else line
        found.append((section, line.split("  #")[0].strip()))
    return found


def check(file: Path, overrides: Sequence[Override] = ()) -> str:
    """Checks a task file and its forward simulator; returns their content in words.

    Raises UserError, or EngineError if the simulator cannot be made.
    """
    config = load(file, overrides)
    simulator = f"forward simulator: {engines.identity(config)}"
    return f"{file}: legal\n{config.description}{simulator}\n"
