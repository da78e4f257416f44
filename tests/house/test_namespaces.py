"""Each folder has one namespace. The vocabulary of core/math and core/world is rtg's own."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

import pytest
from layering import ROOT, sources

NESTED = ("wire",)  # what only their own folder uses
OPENED = re.compile(r"^namespace (rtg[\w:]*) \{$", re.MULTILINE)


def namespace_of(path: str) -> str:
    """Returns the namespace that the file at `path` is to be in."""
    parts = PurePosixPath(path).parts
    if parts[0] == "tests" and parts[1] in {"support", "bench", "fuzz"}:
        return "rtg::testing" if parts[1] == "support" else f"rtg::{parts[1]}"
    if parts[:2] == ("train", "bindings"):
        return "rtg::bindings"
    room = parts[2 if parts[0] == "tests" else 1]
    return "rtg" if room in {"math", "world"} else f"rtg::{room}"


def fault(path: str, text: str) -> str:
    """Returns what is wrong with the namespaces that `text` opens; empty when nothing is."""
    asked = namespace_of(path)
    within = {f"{asked}::{own}" for own in NESTED}
    if path.startswith("tests/"):
        within.add("rtg::testing")
    wrong = [found for found in OPENED.findall(text) if found not in {asked, *within}]
    return f"{path}: in {wrong[0]} instead of {asked}" if wrong else ""


def test_each_file_is_in_the_namespace_of_its_folder() -> None:
    files = {
        str(path.relative_to(ROOT)): path.read_text()
        for path in sources(".hpp", ".cpp")
        if "msgs" not in path.relative_to(ROOT).parts
    }
    assert sum(bool(OPENED.search(text)) for text in files.values()) > 250
    assert [said for path, text in files.items() if (said := fault(path, text))] == []


@pytest.mark.parametrize(
    ("path", "namespace", "right"),
    [
        ("core/reverse/sqp/a.hpp", "rtg::reverse", True),
        ("core/reverse/sqp/a.hpp", "rtg", False),
        ("core/world/a.hpp", "rtg", True),
        ("core/energy/a.hpp", "rtg::reverse", False),
        ("tests/core/search/a.cpp", "rtg::search", True),
        ("tests/nodes/jobs/a.cpp", "rtg::bus", False),
        ("tests/support/a.hpp", "rtg::testing", True),
        ("nodes/bus/a.hpp", "rtg::bus::wire", True),
        ("nodes/bus/a.hpp", "rtg::testing", False),
        ("core/math/a.hpp", "rtg::search", False),
    ],
)
def test_what_is_in_another_is_found(path: str, namespace: str, right: bool) -> None:
    assert (fault(path, f"namespace {namespace} {{\n") == "") == right
