"""The page of the examples: text, output and picture of each program."""

from __future__ import annotations

import ast
from pathlib import Path

from sources import ROOT

_EXAMPLES = ROOT / "train" / "rtg" / "examples"
_FIGURES = ROOT / "docs" / "figures"


def _section(program: Path) -> str:
    text = program.read_text()
    said = ast.get_docstring(ast.parse(text)) or ""
    (picture,) = (
        path for path in _FIGURES.glob(f"{program.stem}.*") if path.suffix in (".png", ".gif")
    )
    output = (_FIGURES / f"{program.stem}.txt").read_text().rstrip()
    listing = "".join(f"    {line}\n" for line in text.splitlines())
    return "\n\n".join(
        [
            f"## {program.stem}",
            said,
            f'??? example "train/rtg/examples/{program.name}"\n\n    ```python\n{listing}    ```',
            f"```text\n{output}\n```",
            f"![The picture of the example {program.stem}](figures/{picture.name})",
        ]
    )


def reference() -> str:
    """Returns a section for each example."""
    return "\n\n".join(map(_section, sorted(_EXAMPLES.glob("[0-9]*.py")))) + "\n"
