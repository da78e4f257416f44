"""A program that hangs fails its test: whoever waits for one says how long."""

import ast
from collections.abc import Iterator

import pytest
from layering import ROOT

FOLDERS = ("docs", "house", "nodes", "support", "system", "train")  # of tests/


def endless(text: str) -> Iterator[int]:
    """Yields the lines of calls that wait for a program without a limit."""
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute):
            continue
        name, words = node.func.attr, {word.arg for word in node.keywords}
        of_module = isinstance(node.func.value, ast.Name) and node.func.value.id == "subprocess"
        starts = of_module and name != "Popen" and name[0].islower()
        waits = name == "communicate" or (name == "wait" and not node.args)
        if (starts or waits) and not words & {"timeout", None}:
            yield node.lineno


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("subprocess.run(['true'])", [1]),
        ("subprocess.run(['true'], timeout=1.0)", []),
        ("subprocess.check_output(['true'])", [1]),
        ("subprocess.Popen(['true'])", []),
        ("process.wait()", [1]),
        ("process.wait(1.0)", []),
        ("process.communicate()", [1]),
        ("process.communicate(timeout=1.0)", []),
    ],
)
def test_a_call_without_a_limit_is_found(line: str, found: list[int]) -> None:
    assert list(endless(line)) == found


def test_every_wait_for_a_program_has_a_limit() -> None:
    files = [path for folder in FOLDERS for path in (ROOT / "tests" / folder).rglob("*.py")]
    assert len(files) > 100
    found = [f"{path}:{line}" for path in files for line in endless(path.read_text())]
    assert found == []
