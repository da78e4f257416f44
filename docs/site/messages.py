"""The message types, from the comments and fields of msgs/*.lcm."""

from __future__ import annotations

import re

from sources import ROOT
from tables import table

_STRUCT = re.compile(r"((?://.*\n)+)struct (\w+)\n\{\n(.*?)\n\}", re.DOTALL)
_FIELD = re.compile(r"((?:    //.*\n)*)    (\w+) (\w+(?:\[\w+\])?);")


def _words(comment: str) -> str:
    return " ".join(re.sub(r"^ *// ?", "", comment, flags=re.MULTILINE).split())


def _sentences(comment: str) -> str:
    """Returns a comment on a type: a paragraph, and a line for each "Channel ...", "Lost: ..."."""
    text = re.sub(r"^// ?", "", comment, flags=re.MULTILINE).strip()
    return re.sub(r"\n(?=(?:Channel\b|[A-Z][a-z]+:))", "\n\n", text)


def _type(text: str, name: str) -> str:
    match = _STRUCT.search(text)
    if not match or match[2] != name:
        raise ValueError(f"msgs/{name}.lcm: no struct {name} with a comment")
    rows = [
        [f"`{field}`", f"`{kind}`", _words(comment)]
        for comment, kind, field in _FIELD.findall(match[3] + "\n")
    ]
    if len(rows) != len(re.findall(r"^(?! *//).*;", match[3], re.MULTILINE)):
        raise ValueError(f"msgs/{name}.lcm: a field that is not understood")
    return f"## `{name}`\n\n{_sentences(match[1])}\n\n{table(['field', 'type', 'meaning'], rows)}"


def reference() -> str:
    """Returns a section for each type, header_t first."""
    files = sorted((ROOT / "msgs").glob("*.lcm"), key=lambda file: (file.stem != "header_t", file))
    return "\n".join(_type(file.read_text(), file.stem) for file in files)
