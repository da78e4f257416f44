"""Two types of one name in one namespace break the one-definition rule, and the linker takes
whichever it meets first."""

from __future__ import annotations

import re
from collections import defaultdict

import pytest
from layering import ROOT, sources

# Our formatter begins nothing but a namespace and what is directly in one at the first column.
SCOPE = re.compile(r"^(?:namespace (?P<opened>[\w:]*) ?\{|\}  // namespace ?(?P<closed>[\w:]*))$")
TYPE = re.compile(
    r"^(?:struct|class|enum(?: class)?|union) (?:alignas\([^)]*\) |\[\[.*?\]\] )*"
    r"(?P<name>\w+)(?: final)?(?: : [^;]*)? \{"
)
ALIAS = re.compile(r"^using (?P<name>\w+) =")


def types(text: str) -> list[str]:
    """Names of the types that a file defines for the whole program: none of those without linkage
    beyond the file."""
    found, scopes = [], list[str]()
    for line in text.splitlines():
        if scope := SCOPE.match(line):
            if scope["opened"] is not None:
                scopes.append(scope["opened"])
            else:
                scopes.pop()
        elif (named := TYPE.match(line) or ALIAS.match(line)) and "" not in scopes:
            found.append("::".join([*scopes, named["name"]]))
    return found


def doubles(files: dict[str, str]) -> list[str]:
    """Types that more than one of the files defines, with these files."""
    places = defaultdict(list)
    for path, text in sorted(files.items()):
        for name in dict.fromkeys(types(text)):
            places[name].append(path)
    return [f"{name}: {', '.join(where)}" for name, where in places.items() if len(where) > 1]


def test_no_two_types_share_a_name() -> None:
    files = {
        str(path.relative_to(ROOT)): path.read_text()
        for path in sources(".hpp", ".cpp")
        if not path.is_relative_to(ROOT / "tests") or path.suffix == ".hpp"
    }
    assert sum(len(types(text)) for text in files.values()) > 100
    assert doubles(files) == []


@pytest.mark.parametrize(
    "kind", ["struct Twin {", "class [[nodiscard]] alignas(64) Twin {", "enum class Twin { kOne };"]
)
def test_a_second_type_of_one_name_is_found(kind: str) -> None:
    body = f"namespace rtg {{\n\n{kind}\n\n}}  // namespace rtg\n"
    assert doubles({"a.hpp": body, "b.cpp": body}) == ["rtg::Twin: a.hpp, b.cpp"]


@pytest.mark.parametrize(
    "body",
    [
        "namespace rtg {\nnamespace {\n\nstruct Twin {\n};\n\n}  // namespace\n}  // namespace rtg",
        "namespace rtg {\n\nstruct Twin;\n\n}  // namespace rtg",
        "namespace rtg::testing {\n\nstruct Twin {\n};\n\n}  // namespace rtg::testing",
        "namespace rtg {\n\nstruct Outer {\n  struct Twin {\n  };\n};\n\n}  // namespace rtg",
    ],
)
def test_what_is_no_other_type_of_that_name_is_none(body: str) -> None:
    twin = "namespace rtg {\n\nstruct Twin {\n};\n\n}  // namespace rtg\n"
    assert doubles({"a.hpp": twin, "b.hpp": body}) == []
