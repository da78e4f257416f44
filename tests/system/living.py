"""Finds out which processes of a run are alive."""

from __future__ import annotations

import contextlib
import os
import time
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


def wait_until_all_are_gone(folder: Path, patience: float) -> None:
    """Waits until processes_of(folder) is empty; fails after so many seconds."""
    deadline = time.monotonic() + patience
    while left := processes_of(folder):
        assert time.monotonic() < deadline, left
        time.sleep(0.02)
