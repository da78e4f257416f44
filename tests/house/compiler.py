"""The compiler, as the release build calls it."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import pytest
from layering import ROOT

BUILD = ROOT / "build" / "release"


def command_for(source: str) -> tuple[list[str], Path]:
    """The words of the command that compiles the file whose path ends with `source`, without
    -o OBJECT -c FILE, and the folder to call it in. Skips the test where nothing is configured."""
    commands = BUILD / "compile_commands.json"
    if not commands.is_file():
        pytest.skip("the release build is not configured")
    (entry,) = (one for one in json.loads(commands.read_text()) if one["file"].endswith(source))
    return shlex.split(entry["command"])[:-4], Path(entry["directory"])
