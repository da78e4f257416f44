"""Checks whether this processor can run the compiled core, which says for which it was compiled."""

from __future__ import annotations

import importlib
from pathlib import Path

_NEEDED = {"x86-64-v3": ("avx2", "bmi2", "fma")}  # by what -march was given; flags of Linux
_CPUINFO = Path("/proc/cpuinfo")


def compiled_for() -> str | None:
    """Returns what -march was given for the core; None if that is not known."""
    try:
        return str(importlib.import_module("rtg.compiled_for").PROCESSOR)
    except ModuleNotFoundError:
        return None


def check() -> None:
    """Raises ImportError if this processor lacks instructions for which the core was compiled."""
    processor = compiled_for()
    flags = _CPUINFO.read_text().partition("flags")[2].partition("\n")[0].split()
    missing = [flag for flag in _NEEDED.get(processor or "", ()) if flag not in flags]
    if missing:
        raise ImportError(
            f"rtg is compiled for processors with {', '.join(missing)} ({processor}); legal: a "
            "build for any, which gives the same transitions slowly, with cmake "
            "-DRTG_PROCESSOR=x86-64, or pip install --config-settings="
            "cmake.define.RTG_PROCESSOR=x86-64"
        )
