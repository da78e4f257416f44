"""Reads the log of a program while the program writes it."""

from __future__ import annotations

from pathlib import Path


class ProgramLog:
    """What is appended to a log file from now on; the file may not exist yet."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._start = self._read = path.stat().st_size if path.exists() else 0

    def tail(self, lines: int = 8) -> str:
        """Returns the last `lines` lines."""
        logged = self.path.read_bytes()[self._start :] if self.path.exists() else b""
        return "\n".join(logged.decode(errors="replace").splitlines()[-lines:])

    def new_lines(self) -> list[str]:
        """Returns the lines that were completed since the last call of this method."""
        if not self.path.exists():
            return []
        with self.path.open("rb") as log:
            log.seek(self._read)
            whole, end, _ = log.read().rpartition(b"\n")
        self._read += len(whole) + len(end)
        return whole.decode(errors="replace").splitlines()
