"""Checks whether this processor can run the compiled core of an installed package."""

from __future__ import annotations

import importlib
from pathlib import Path

_NEEDED = {"x86-64-v3": ("avx2", "bmi2", "fma")}  # by what -march was given; flags of Linux


def check() -> None:
    """Raises ImportError if the package was compiled for another processor.

    In a checkout it is compiled for this one.
    """
    try:
        arch = importlib.import_module("rtg.compiled_for").ARCH
    except ModuleNotFoundError:
        return
    text = Path("/proc/cpuinfo").read_text()
    flags = text.partition("flags")[2].partition("\n")[0].split()
    missing = [flag for flag in _NEEDED.get(arch, ()) if flag not in flags]
    if missing:
        raise ImportError(
            f"this build of rtg is for processors with {', '.join(missing)} ({arch}); legal: a "
            "build for any: pip install --no-binary :all: --config-settings="
            "cmake.define.RTG_ARCH= reverse-trajectory-generation"
        )
