"""Though some warnings are off that the compiler gets wrong, a plain mistake is an error."""

import json
import shlex
import subprocess
from pathlib import Path

import pytest
from layering import ROOT

COMMANDS = ROOT / "build" / "release" / "compile_commands.json"
UNINITIALISED = """int f(int a) {
  int x;
  return a + x;
}
"""


def compiled(file: Path, text: str) -> str:
    """What the compiler says to the text, with the flags of the release build; empty if it is
    content."""
    if not COMMANDS.is_file():
        pytest.skip("the release build is not configured")
    file.write_text(text)
    every = json.loads(COMMANDS.read_text())
    (entry,) = (one for one in every if one["file"].endswith("/core/world/push.cpp"))
    flags = shlex.split(entry["command"])[:-4]  # without -o OBJECT -c FILE
    command = [*flags, "-o", str(file.with_suffix(".o")), "-c", str(file)]
    done = subprocess.run(command, cwd=entry["directory"], capture_output=True, text=True)
    assert (done.returncode == 0) == (done.stderr == "")
    return done.stderr


def test_a_variable_without_a_value_is_an_error(tmp_path: Path) -> None:
    file = tmp_path / "uninitialised.cpp"
    assert "uninitialized [-Werror=" in compiled(file, UNINITIALISED)
    assert compiled(file, UNINITIALISED.replace("int x;", "int x = 0;")) == ""
