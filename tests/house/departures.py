"""Departures from the paper: reads their marks in core/ and nodes/, writes docs/departures.md.

A mark begins with "Departs from the paper:" and ends with the comment. Run as a program, it writes
the page.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "departures.md"
_COMMENT = re.compile(r"(?:^[ \t]*///?(?: .*)?\n)+", re.MULTILINE)
_MARK = "Departs from the paper: "
_INTRODUCTION = """\
# Departures from the paper

Made by `python tests/house/departures.py` from the comments that begin with "Departs from the
paper:". Figures of pushes found are those of `true_pushes --count 100` (100 pushes each of
Gathering, Sorting and ArtManip that Box2D has made). What the preset `paper` does, and with which
constants, is in [paper_mode.md](paper_mode.md).
"""


class Departure(NamedTuple):
    """A mark: the file that has it, as a path from the root, and its text in one line."""

    file: str
    text: str


def _of(file: Path) -> list[Departure]:
    found = []
    for comment in _COMMENT.findall(file.read_text()):
        text = re.sub(r"\s*\n?[ \t]*///?[ \t]?", " ", comment)
        _, mark, departure = text.partition(_MARK)
        if mark:
            sentence = " ".join(departure.split())
            found.append(Departure(str(file.relative_to(ROOT)), sentence[0].upper() + sentence[1:]))
    return found


def departures() -> list[Departure]:
    """All marks, in the order of the files."""
    files = [file for of in ("core", "nodes") for file in sorted((ROOT / of).rglob("*.[hc]pp"))]
    return [one for file in files for one in _of(file)]


def page() -> str:
    """The text of docs/departures.md."""
    lines = [f"- [{one.file}](../{one.file}): {one.text}" for one in departures()]
    return "\n".join([_INTRODUCTION, *lines]) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page())
