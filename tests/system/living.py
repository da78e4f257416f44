"""Which processes of a run are alive."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path


def processes_of(folder: Path) -> dict[int, str]:
    """Words of all living processes that were started with the folder among them, by id."""
    found = {}
    for entry in os.listdir("/proc"):
        with contextlib.suppress(OSError):
            if entry.isdigit() and int(entry) != os.getpid():
                words = Path(f"/proc/{entry}/cmdline").read_bytes().decode(errors="replace")
                if str(folder) in words:
                    found[int(entry)] = words
    return found
