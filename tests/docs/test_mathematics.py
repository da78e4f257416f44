"""Formulas of the pages as MathML."""

import pytest

pytest.importorskip("latex2mathml", reason="a package of the site: docs/requirements.txt")
import mathematics


def test_formulas_become_mathml_in_their_places() -> None:
    page = r'<p>of <span class="arithmatex">\(a_1 &lt; b\)</span></p>'
    drawn = mathematics.drawn(page)
    assert drawn.startswith("<p>of <math") and 'display="inline"' in drawn
    assert "<msub><mi>a</mi><mn>1</mn></msub>" in drawn and "&#x0003C;" in drawn


def test_the_number_of_an_equation_stands_beside_it() -> None:
    drawn = mathematics.drawn('<div class="arithmatex">\\[\nx = 1 \\tag{7}\n\\]</div>')
    assert drawn.startswith('<span class="tag">(7)</span><math') and 'display="block"' in drawn


def test_other_text_stays() -> None:
    assert mathematics.drawn("<code>\\(x\\)</code>") == "<code>\\(x\\)</code>"
