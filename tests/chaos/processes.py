"""What processes use, from /proc, and pauses of them."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from pathlib import Path

_TICKS = os.sysconf("SC_CLK_TCK")
_PAGE = os.sysconf("SC_PAGE_SIZE")


def cpu_seconds(pid: int) -> float:
    """Returns the CPU time of all threads of a process [s]."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / _TICKS


def resident(pid: int | str = "self") -> float:
    """Returns the resident memory of a process [MB]."""
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * _PAGE / 1e6


def is_stopped(pid: int) -> bool:
    """Returns whether a process stands still, or is no more."""
    return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] in "TZ"


def freeze(process: subprocess.Popen[str], seconds: float) -> bool:
    """Stops a process for so long. Returns whether there was one: it may have ended before."""
    if process.poll() is not None:
        return False
    process.send_signal(signal.SIGSTOP)
    time.sleep(seconds)
    assert is_stopped(process.pid)
    process.send_signal(signal.SIGCONT)
    return True
