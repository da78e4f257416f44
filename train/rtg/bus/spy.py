"""`rtg spy`: monitors the channels of all runs on this machine, similar to lcm-spy."""

from __future__ import annotations

import functools
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from typing import ClassVar, NamedTuple, TextIO

from rich.console import (
    Console,
    ConsoleOptions,
    JustifyMethod,
    RenderableType,
    RenderResult,
)
from rich.table import Table
from rich.text import Text
from textual.app import App, ComposeResult
from textual.binding import BindingType
from textual.containers import VerticalScroll
from textual.widgets import Footer, Header, Static

from rtg import _core, paths
from rtg.bus.bus import defect
from rtg.bus.channel_monitor import ChannelMonitor, ChannelRow, NodeRow, RunRow
from rtg.bus.node_status import ENDED
from rtg.errors import RunError
from rtg.files import run_folder

_REFRESH = 0.5  # [s]
_POLL = 0.05  # [s]
_PRINT = 2.0  # [s] between two plain tables
_WIDTH = 200  # maximum width of plain tables in characters
_STATE_STYLES = {"busy": "green", "idle": "dim", ENDED: "dim"}
_NO_MESSAGES = (
    "no message heard: no run is on this bus, or it sends nothing (with --in-process, or where "
    "--resume finds the transitions finished)"
)


def bandwidth(bytes_per_second: float) -> str:
    """Formats a bandwidth, such as "12.3 kB/s"."""
    for unit in ("B/s", "kB/s", "MB/s"):
        if bytes_per_second < 999.95:
            return f"{bytes_per_second:.1f} {unit}"
        bytes_per_second /= 1000.0
    return f"{bytes_per_second:.1f} GB/s"


class _Column(NamedTuple):
    """A column of a table. Where there is no room for all, the last ones by `rank` are left out."""

    name: str
    rank: int = 0
    right: bool = False  # aligned to the right


_GAP = 2  # between columns
_CHANNEL_COLUMNS = (
    _Column("channel"),
    _Column("type", 4),
    _Column("messages", 0, True),
    _Column("rate", 1, True),
    _Column("bandwidth", 2, True),
    _Column("undecodable", 3, True),
)
_NODE_COLUMNS = (
    _Column("node"),
    _Column("pid", 4, True),
    _Column("state"),
    _Column("done", 1, True),
    _Column("rate", 3, True),
    _Column("CPU", 2, True),
)


def _shown(columns: Sequence[_Column], rows: Sequence[Sequence[Text]], width: int) -> list[int]:
    """Returns the indices of the columns for which there is room."""
    wide = [
        max([len(column.name), *(row[k].cell_len for row in rows)]) + _GAP
        for k, column in enumerate(columns)
    ]
    shown = list(range(len(columns)))
    while sum(wide[k] for k in shown) > width + _GAP and max(columns[k].rank for k in shown):
        shown.remove(max(shown, key=lambda k: columns[k].rank))
    return shown


def _table(columns: Sequence[_Column], rows: Sequence[Sequence[Text]], width: int) -> Table:
    """Returns a table of at most `width` characters."""
    table = Table(box=None, pad_edge=False, padding=(0, _GAP, 0, 0), header_style="bold")
    shown = _shown(columns, rows, width)
    for k in shown:
        justify: JustifyMethod = "right" if columns[k].right else "left"
        table.add_column(columns[k].name, justify=justify, no_wrap=True)
    for row in rows:
        table.add_row(*(row[k] for k in shown))
    return table


def channel_table(rows: list[ChannelRow], width: int) -> Table:
    """Returns a table with a line per channel."""
    lines = []
    for row in rows:
        style = "dim" if row.rate == 0.0 else ""
        words = (row.channel, row.type_name, f"{row.messages:,}", f"{row.rate:.1f} Hz")
        bad = Text(f"{row.undecodable:,}", style="bold red" if row.undecodable else style)
        lines.append([*(Text(word, style) for word in (*words, bandwidth(row.bandwidth))), bad])
    # What cannot be decoded is a defect: it has its column even where others have no room.
    is_sound = not any(row.undecodable for row in rows)
    columns = [
        c if is_sound or c.name != "undecodable" else c._replace(rank=0) for c in _CHANNEL_COLUMNS
    ]
    return _table(columns, lines, width)


def node_table(rows: list[NodeRow], width: int) -> Table:
    """Returns a table with a line per process."""
    lines = []
    for row in rows:
        silent = row.state.startswith("silent")
        state = Text(row.state, style="bold red" if silent else _STATE_STYLES.get(row.state, ""))
        figures = (f"{row.done:,}", f"{row.rate:.1f}/s", f"{100 * row.cpu:.0f} %")
        lines.append([Text(row.name), Text(str(row.pid)), state, *map(Text, figures)])
    return _table(_NODE_COLUMNS, lines, width)


def run_name(key: int) -> str:
    """Returns the folder in runs/ of the run with _core.run_id() `key`, else the key in short."""
    for file in paths.RUNS.glob("**/run_name"):
        if _core.run_id(run_folder.run_name(file.parent)) == key:
            return file.parent.name
    return f"{key % 2**64:016x}"[:8]


class Picture:
    """The display of all data of `monitor` at time `now` [s], as wide as there is room.

    `name`: the name of a run by its _core.run_id().
    """

    def __init__(self, monitor: ChannelMonitor, now: float, name: Callable[[int], str]) -> None:
        self._channels, self._runs, self._name = monitor.channels(), monitor.runs(now), name

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        if not self._channels:
            yield Text(_NO_MESSAGES)
            return
        for row in self._runs:
            yield from self._run(row, options.max_width)
        if self._runs:
            yield Text("channels of all runs", style="bold underline")
        yield channel_table(self._channels, options.max_width)

    def _run(self, row: RunRow, width: int) -> Iterator[RenderableType]:
        yield Text(f"run {self._name(row.run)}", style="dim" if row.is_over else "bold underline")
        if row.progress:
            yield Text(row.progress, style="dim" if row.is_over else "")
        if not row.is_over:
            yield node_table(row.nodes, width)
        for node in row.nodes:
            if node.counters:
                yield Text(f"{node.name}: {node.counters}", style="dim")
        yield ""


class SpyApp(App[None]):
    """A terminal application that shows a Picture twice a second."""

    TITLE = "rtg spy"
    ENABLE_COMMAND_PALETTE = False
    BINDINGS: ClassVar[list[BindingType]] = [("q", "quit", "quit"), ("space", "pause", "pause")]
    CSS = "VerticalScroll { padding: 1 2; }"

    def __init__(self, monitor: ChannelMonitor, seconds: float | None = None) -> None:
        super().__init__()
        self._monitor, self._seconds = monitor, seconds
        self._run_name = functools.cache(run_name)
        self._paused = False

    def compose(self) -> ComposeResult:
        yield Header(show_clock=True, icon="")
        yield VerticalScroll(Static("waiting for messages", id="picture"))
        yield Footer()

    def on_mount(self) -> None:
        self.set_interval(_POLL, self._poll)
        self.set_interval(_REFRESH, self.refresh_picture)
        if self._seconds is not None:
            self.set_timer(self._seconds, self.exit)

    def action_pause(self) -> None:
        """Pauses or resumes the display; counting continues."""
        self._paused = not self._paused
        self.sub_title = "paused" if self._paused else ""

    def refresh_picture(self) -> None:
        """Updates the rates and, unless paused, the display."""
        now = time.monotonic()
        self._monitor.sample(now)
        if not self._paused:
            self.query_one("#picture", Static).update(Picture(self._monitor, now, self._run_name))

    def _poll(self) -> None:
        self._monitor.listen(0.0)


def watch_plainly(monitor: ChannelMonitor, seconds: float | None, out: TextIO) -> None:
    """Prints one Picture after `seconds`. If None, prints one every 2 s without end."""
    console, name = Console(file=out, width=_WIDTH, highlight=False), functools.cache(run_name)
    start = sampled = printed = time.monotonic()
    while seconds is None or time.monotonic() - start < seconds:
        monitor.listen(_POLL)
        now = time.monotonic()
        if now - sampled >= _REFRESH:
            sampled = now
            monitor.sample(now)
        if seconds is None and now - printed >= _PRINT:
            printed = now
            console.print(Picture(monitor, now, name), "")
            out.flush()
    if seconds is not None:
        console.print(Picture(monitor, time.monotonic(), name))


def spy(url: str, seconds: float | None) -> None:
    """Monitors the bus at `url` for `seconds`, or without a limit if None.

    Raises RunError if multicast does not work.
    """
    if why := defect(url):
        raise RunError(f"nothing to be heard: {why}")
    bus = _core.BusMonitor(url)
    monitor = ChannelMonitor(bus)
    if bus.warning:
        print(bus.warning, file=sys.stderr)
    if sys.stdout.isatty():
        SpyApp(monitor, seconds).run()
    else:
        watch_plainly(monitor, seconds, sys.stdout)
