"""Reads the log of a program while the program writes it."""

from __future__ import annotations

import os
from pathlib import Path
from typing import BinaryIO

_BLOCK = 4096  # [bytes] that hold the last lines of most logs


class ProgramLog:
    """Reads what is appended to a log file from now on; the file may not exist yet."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._start = self._read = path.stat().st_size if path.exists() else 0

    def tail(self, lines: int = 8) -> str:
        """Returns the last `lines` lines. Reads the end of the file alone."""
        if not self.path.exists():
            return ""
        with self.path.open("rb") as log:
            end = _end(log, self._start, lines)
        return "\n".join(end.decode(errors="replace").splitlines()[-lines:])

    def new_lines(self) -> list[str]:
        """Returns the lines that were completed since the last call of this method."""
        if not self.path.exists():
            return []
        with self.path.open("rb") as log:
            log.seek(self._read)
            whole, end, _ = log.read().rpartition(b"\n")
        self._read += len(whole) + len(end)
        return whole.decode(errors="replace").splitlines()


def _end(log: BinaryIO, start: int, lines: int) -> bytes:
    """Reads the end of a file with `lines` whole lines, or all from `start` on if it has fewer."""
    size, block = log.seek(0, os.SEEK_END), _BLOCK
    while True:
        begin = min(max(start, size - block), size)
        log.seek(begin)
        found = log.read(size - begin)
        if begin <= start or found[:-1].count(b"\n") >= lines:
            return found
        block *= 4
