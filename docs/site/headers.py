"""The C++ reference: of each header its comments with what they are about, and its text."""

from __future__ import annotations

import re
from pathlib import Path

from sources import ROOT, page_of_folder
from tables import table

# A comment at the left margin, and the declaration under it up to its first brace or semicolon.
_COMMENT = re.compile(r"^((?:///.*\n)+)((?:(?!//)\S.*\n|  .*\n)*?.*[{;].*\n)", re.MULTILINE)


def _escaped(text: str) -> str:
    """Returns a text in which only backticks are markup."""
    parts = text.split("`")
    for k in range(0, len(parts), 2):
        parts[k] = re.sub(r"([\\*_\[\]<>$#|])", r"\\\1", parts[k])
    return "`".join(parts)


def _paragraph(text: str) -> str:
    """Returns a paragraph of a comment; indented ones are lists or formulas."""
    if not text.startswith(" "):
        return _escaped(text)
    lines = text.splitlines()
    if re.match(r" *(-|\d+\.) ", text):
        indent = len(text) - len(text.lstrip())
        return "\n".join(
            _escaped(line[indent:] if re.match(r" *(-|\d+\.) ", line) else "    " + line.strip())
            for line in lines
        )
    return "```text\n" + "\n".join(lines) + "\n```"


def prose(comment: str) -> str:
    """Returns a comment of lines with /// as Markdown."""
    text = re.sub(r"^/// ?", "", comment, flags=re.MULTILINE).rstrip("\n")
    return "\n\n".join(_paragraph(part) for part in re.split(r"\n *\n", text))


def _declaration(text: str) -> str:
    lines = text.rstrip().split("\n")
    return "\n".join(lines).rstrip("{ \n")


def _section(header: Path) -> str:
    text = header.read_text()
    parts = [f"## {header.name} {{ #{header.name} }}"]
    for comment, declaration in _COMMENT.findall(text):
        parts += [f"```cpp\n{_declaration(declaration)}\n```", prose(comment)]
    listing = "".join(f"    {line}\n" for line in text.splitlines())
    where = header.relative_to(ROOT)
    parts.append(f'??? quote "All of {where}"\n\n    ```cpp\n{listing}    ```')
    return "\n\n".join(parts)


def _folders() -> dict[str, list[Path]]:
    found: dict[str, list[Path]] = {}
    for top in ("core", "nodes"):
        for header in sorted((ROOT / top).rglob("*.hpp")):
            found.setdefault(str(header.parent.relative_to(ROOT)), []).append(header)
    return found


def pages() -> dict[str, str]:
    """Returns the pages of the reference by their places in the site."""
    return {
        page_of_folder(folder): f"# {folder}\n\n" + "\n\n".join(map(_section, headers)) + "\n"
        for folder, headers in _folders().items()
    }


def _rooms() -> dict[str, str]:
    """Returns what each folder holds, from the table of CONTRIBUTING.md."""
    rows = re.findall(
        r"^\| (`.*?`) \| (.*?) \|$", (ROOT / "CONTRIBUTING.md").read_text(), re.MULTILINE
    )
    return {name: holds for cell, holds in rows for name in re.findall(r"`([^`]+)/`", cell)}


def index() -> str:
    """Returns a table of the folders."""
    rooms = _rooms()
    rows = [
        [f"[{folder}]({page_of_folder(folder)})", rooms[folder], str(len(headers))]
        for folder, headers in _folders().items()
    ]
    return table(["folder", "holds", "headers"], rows)
