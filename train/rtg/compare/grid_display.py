"""Displays of a comparison: a row for each run on a terminal, else a line for each change."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, Self, TextIO

from rich.console import Console
from rich.live import Live
from rich.table import Table
from rich.text import Text

from rtg.run.progress import ScreenContext, TimedLines

_REDRAW = 0.5  # [s]
_MARKS = {"waiting": " ", "running": "▸", "elsewhere": "▹", "done": "✓", "failed": "✗"}
_STYLES = {"waiting": "dim", "running": "", "elsewhere": "dim", "done": "green", "failed": "red"}
_PRIORITY = (
    "running",
    "failed",
    "elsewhere",
    "waiting",
    "done",
)  # phases by priority on a small terminal


@dataclass(frozen=True)
class Row:
    """The display of one run: its name, phase and further words."""

    name: str
    phase: str = "waiting"  # or running, elsewhere (by another process), done, failed
    words: str = ""


def counts(rows: Sequence[Row]) -> str:
    """Counts the runs by phase, in one line of text."""
    total = {phase: sum(row.phase == phase for row in rows) for phase in _MARKS}
    failed = f", {total['failed']} failed" if total["failed"] else ""
    elsewhere = f", {total['elsewhere']} elsewhere" if total["elsewhere"] else ""
    running = f", {total['running']} running"
    return f"{total['done']} of {len(rows)} runs done{failed}{running}{elsewhere}"


class GridDisplay(ScreenContext, Protocol):
    """A display of all runs of a comparison, one Row each."""

    def show(self, rows: Sequence[Row]) -> None:
        """Shows the newest state of all runs; may be called at any rate."""


class PlainGrid(TimedLines):
    """Prints a line when a run begins or ends."""

    def __init__(self, out: TextIO) -> None:
        super().__init__(out)
        self._phases: dict[str, str] = {}

    def show(self, rows: Sequence[Row]) -> None:
        for row in rows:
            if self._phases.get(row.name, "waiting") != row.phase:
                words = f" ({row.words})" if row.words else ""
                self.note(f"{row.name}: {row.phase}{words}")
            self._phases[row.name] = row.phase


class LiveGrid:
    """Shows rows that change in place. If not all of them fit, it shows the most urgent ones."""

    def __init__(self, console: Console) -> None:
        self._console = console
        # Without a refresh thread, because this process forks child processes.
        self._live = Live(console=console, auto_refresh=False)
        self._start = time.monotonic()
        self._drawn = 0.0
        self._rows: Sequence[Row] = ()

    def __enter__(self) -> Self:
        self._live.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._live.update(self._table(), refresh=True)
        self._live.stop()

    def show(self, rows: Sequence[Row]) -> None:
        self._rows = rows
        now = time.monotonic()
        if now - self._drawn >= _REDRAW:
            self._drawn = now
            self._live.update(self._table(), refresh=True)

    def _table(self) -> Table:
        rows = visible(self._rows, self._console.height - 3)
        table = Table.grid(padding=(0, 1))
        table.add_column(no_wrap=True)
        table.add_column(no_wrap=True)
        table.add_column(no_wrap=True, overflow="ellipsis")
        for row in rows:
            style = _STYLES[row.phase]
            last = (row.words.splitlines() or [row.phase])[-1]
            cells = (_MARKS[row.phase], row.name, last)
            table.add_row(*(Text(cell, style=style) for cell in cells))
        minutes, seconds = divmod(int(time.monotonic() - self._start), 60)
        table.add_row("", f"{minutes}:{seconds:02d}", counts(self._rows))
        return table


def visible(rows: Sequence[Row], room: int) -> list[Row]:
    """Selects the `room` most urgent rows, at least one, and returns them in their order."""
    ranked = sorted(range(len(rows)), key=lambda k: _PRIORITY.index(rows[k].phase))
    return [rows[k] for k in sorted(ranked[: max(room, 1)])]


def display(out: TextIO) -> GridDisplay:
    """Returns a LiveGrid if `out` is a terminal, else a PlainGrid."""
    console = Console(file=out)
    return LiveGrid(console) if console.is_terminal else PlainGrid(out)
