"""Though some warnings are off that the compiler gets wrong, a plain mistake is an error."""

from pathlib import Path

from compiler import command_for
from time_limit import run

UNINITIALISED = """int f(int a) {
  int x;
  return a + x;
}
"""


def compiled(file: Path, text: str) -> str:
    """Returns what the compiler says to the text, with the flags of the release build; empty if it
    is content."""
    words, folder = command_for("/core/world/push.cpp")
    file.write_text(text)
    command = [*words, "-o", str(file.with_suffix(".o")), "-c", str(file)]
    done = run(*command, cwd=folder)
    assert (done.returncode == 0) == (done.stderr == "")
    return done.stderr


def test_a_variable_without_a_value_is_an_error(tmp_path: Path) -> None:
    file = tmp_path / "uninitialised.cpp"
    assert "uninitialized [-Werror=" in compiled(file, UNINITIALISED)
    assert compiled(file, UNINITIALISED.replace("int x;", "int x = 0;")) == ""
