"""The configuration as the C++ loader resolves it; Python reads no YAML of its own."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rtg import paths
from rtg.errors import RunError, UserError
from rtg.run.run_args import Override


def _rtg_config(file: Path, overrides: Sequence[Override], mode: str) -> str:
    command = [str(paths.program("rtg_config")), str(file)]
    for override in overrides:
        command += ["--set", override.setting]
    done = subprocess.run(  # Ctrl-C is for us
        [*command, mode], capture_output=True, text=True, check=False, start_new_session=True
    )
    if done.returncode == 2:
        message = done.stderr.strip()
        for override in overrides:
            message = message.replace(f"--set {override.setting}", override.typed)
        raise UserError(message)
    if done.returncode != 0:
        raise RunError(f"rtg_config failed: {done.stderr.strip() or done.returncode}")
    return done.stdout


def canonical(file: Path, overrides: Sequence[Override] = ()) -> str:
    """The whole configuration as canonical YAML. Raises UserError on a mistake in it."""
    return _rtg_config(file, overrides, "--print")


def values(file: Path, overrides: Sequence[Override] = ()) -> dict[str, Any]:
    """The same as nested dictionaries."""
    result: dict[str, Any] = json.loads(_rtg_config(file, overrides, "--json"))
    return result


def check_version(file: Path) -> None:
    """Raises UserError unless this version writes the configuration of `file` as it stands there:
    one of another version may lack a setting whose default was different then."""
    found = _settings(file.read_text())
    missing = [line for line in _settings(canonical(file)) if line not in found]
    if missing:
        raise UserError(
            f"{file}: has no line '{missing[0][1]}': another version of RTG wrote it; legal: that "
            "version (git_revision in versions.json), or another --out"
        )


def _settings(text: str) -> list[tuple[str, str]]:
    """The lines without their comments, each with the section that it stands in."""
    found, section = [], ""
    for line in text.splitlines():
        section = section if line.startswith((" ", "#")) else line
        found.append((section, line.split("  #")[0].strip()))
    return found


def check(file: Path) -> str:
    """What a task file says, for people. Raises UserError."""
    return _rtg_config(file, (), "--check")
