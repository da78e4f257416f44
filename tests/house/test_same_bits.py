"""What transitions depend on calls no function that rounds otherwise on another processor."""

from __future__ import annotations

import re

from layering import ROOT

# Those of the C library that are not exact; core/math/elementary.hpp has others in their place.
INEXACT = re.compile(
    r"\bstd::(a?(sin|cos|tan)h?|atan2|exp|exp2|expm1|log|log2|log10|log1p|pow|cbrt|hypot)\("
)
LEARNER = ROOT / "core" / "learn"


def test_the_core_calls_no_inexact_function_of_the_c_library() -> None:
    files = [
        path
        for path in (ROOT / "core").rglob("*.?pp")
        if path.is_file() and LEARNER not in path.parents
    ]
    assert len(files) > 100
    found = [
        f"{path.relative_to(ROOT)}: {call[0]}"
        for path in files
        for call in INEXACT.finditer(path.read_text())
    ]
    assert found == []


def test_such_a_call_is_found() -> None:
    assert all(INEXACT.search(f"x = std::{name}(y);") for name in ("sin", "atan2", "log1p", "tanh"))
    assert not INEXACT.search("std::sqrt(x) + exponential(x) + std::remainder(x, y)")
