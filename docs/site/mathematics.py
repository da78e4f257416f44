"""Formulas in LaTeX as MathML, which browsers draw by themselves."""

from __future__ import annotations

import html
import re

from latex2mathml.converter import convert

# Of the extension arithmatex.
_FORMULA = re.compile(
    r'<(?P<tag>span|div) class="arithmatex">\\[(\[](?P<latex>.*?)\\[)\]]</(?P=tag)>', re.DOTALL
)
_NUMBER = re.compile(r"\\tag\{([^}]*)\}")


def _mathml(match: re.Match[str]) -> str:
    latex = html.unescape(match["latex"]).strip()
    number = _NUMBER.search(latex)
    display = "inline" if match["tag"] == "span" else "block"
    formula: str = convert(_NUMBER.sub("", latex), display=display)
    return f'<span class="tag">({number[1]})</span>{formula}' if number else formula


def drawn(page: str) -> str:
    """Returns the HTML of a page with MathML in the place of LaTeX."""
    return _FORMULA.sub(_mathml, page)
