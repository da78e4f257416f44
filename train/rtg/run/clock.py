"""The time since the command was given."""

from __future__ import annotations

import os
import time
from pathlib import Path


def process_age() -> float:
    """Returns the time since this process was started [s], to 0.01 s."""
    fields = Path("/proc/self/stat").read_text().rpartition(")")[2].split()
    started = int(fields[19]) / os.sysconf("SC_CLK_TCK")  # since the boot of the machine
    return time.clock_gettime(time.CLOCK_BOOTTIME) - started


def duration(seconds: float) -> str:
    """Returns a duration as hours, minutes and seconds: "1:02:03", "2:03"."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"
