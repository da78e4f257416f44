"""Checks that this processor can run the compiled core, which is for x86-64-v3 or above."""

from __future__ import annotations

import platform
import sys
from pathlib import Path
from types import TracebackType
from typing import NoReturn

_CPUINFO = Path("/proc/cpuinfo")
_NEEDED = ("avx2", "bmi2", "fma")  # flags of Linux


def check() -> None:
    """Raises ImportError if this processor lacks instructions that every build of the core uses.

    Uncaught, the error ends the program with one line and status 2.
    """
    if platform.machine() != "x86_64":
        return
    flags = _CPUINFO.read_text().partition("flags")[2].partition("\n")[0].split()
    missing = [flag for flag in _NEEDED if flag not in flags]
    if missing:
        sys.excepthook = _tell
        raise ImportError(
            f"this processor lacks {', '.join(missing)}; legal: an x86-64-v3 processor, as most "
            "are since 2013"
        )


def _tell(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> NoReturn:
    print(f"rtg: {error}", file=sys.stderr)
    sys.exit(2)
