"""`rtg spy`: monitors the channels of all runs on this machine, similar to lcm-spy."""

from __future__ import annotations

import sys
import time
from typing import ClassVar, TextIO

from rich.console import Console, Group, RenderableType
from rich.table import Table
from rich.text import Text
from textual.app import App, ComposeResult
from textual.binding import BindingType
from textual.containers import VerticalScroll
from textual.widgets import Footer, Header, Static

from rtg.bus import multicast
from rtg.bus.bus import Bus
from rtg.bus.channel_monitor import ChannelMonitor, ChannelRow, NodeRow
from rtg.bus.node_status import ENDED
from rtg.errors import RunError

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


def _table(*columns: str) -> Table:
    """Returns an empty table with `columns`. A ">" before a name aligns the column to the right."""
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="bold")
    for column in columns:
        right = column.startswith(">")
        table.add_column(column.lstrip(">"), justify="right" if right else "left", no_wrap=True)
    return table


def channel_table(rows: list[ChannelRow]) -> Table:
    """Returns a table with a line per channel."""
    table = _table("channel", "type", ">messages", ">rate", ">bandwidth", ">undecodable")
    for row in rows:
        table.add_row(
            row.channel,
            row.type_name,
            f"{row.messages:,}",
            f"{row.rate:.1f} Hz",
            bandwidth(row.bandwidth),
            Text(f"{row.undecodable:,}", style="bold red" if row.undecodable else ""),
            style="dim" if row.rate == 0.0 else "",
        )
    return table


def node_table(rows: list[NodeRow]) -> Table:
    """Returns a table with a line per process."""
    table = _table("node", ">pid", "state", ">done", ">rate", ">CPU", "counters")
    for row in rows:
        silent = row.state.startswith("silent")
        table.add_row(
            row.name,
            str(row.pid),
            Text(row.state, style="bold red" if silent else _STATE_STYLES.get(row.state, "")),
            f"{row.done:,}",
            f"{row.rate:.1f}/s",
            f"{100 * row.cpu:.0f} %",
            row.counters,
        )
    return table


def picture(monitor: ChannelMonitor, now: float) -> RenderableType:
    """Returns the display of all data of `monitor` at time `now` [s]."""
    channels, nodes = monitor.channels(), monitor.nodes(now)
    if not channels:
        return Text(_NO_MESSAGES)
    parts: list[RenderableType] = [channel_table(channels)]
    if nodes:
        parts += ["", node_table(nodes)]
    if monitor.progress():
        parts += ["", Text(monitor.progress())]
    return Group(*parts)


class SpyApp(App[None]):
    """A terminal application that shows picture() twice a second."""

    TITLE = "rtg spy"
    ENABLE_COMMAND_PALETTE = False
    BINDINGS: ClassVar[list[BindingType]] = [("q", "quit", "quit"), ("space", "pause", "pause")]
    CSS = "VerticalScroll { padding: 1 2; }"

    def __init__(self, bus: Bus, monitor: ChannelMonitor, seconds: float | None = None) -> None:
        super().__init__()
        self._bus, self._monitor, self._seconds = bus, monitor, seconds
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
            self.query_one("#picture", Static).update(picture(self._monitor, now))

    def _poll(self) -> None:
        self._bus.spin(0.0)


def watch_plainly(bus: Bus, monitor: ChannelMonitor, seconds: float | None, out: TextIO) -> None:
    """Prints one picture() after `seconds`. If None, prints one every 2 s without end."""
    console = Console(file=out, width=_WIDTH, highlight=False)
    start = sampled = printed = time.monotonic()
    while seconds is None or time.monotonic() - start < seconds:
        bus.spin(_POLL)
        now = time.monotonic()
        if now - sampled >= _REFRESH:
            sampled = now
            monitor.sample(now)
        if seconds is None and now - printed >= _PRINT:
            printed = now
            console.print(picture(monitor, now), "")
            out.flush()
    if seconds is not None:
        console.print(picture(monitor, time.monotonic()))


def spy(url: str, seconds: float | None) -> None:
    """Monitors the bus at `url` for `seconds`, or without a limit if None.

    Raises RunError if multicast does not work.
    """
    if why := multicast.defect(url):
        raise RunError(f"nothing to be heard: {why}")
    monitor = ChannelMonitor()
    bus = Bus(url, "rtg spy")
    bus.watch(".*", lambda channel, data: monitor.on_message(channel, data, time.monotonic()))
    if bus.warning:
        print(bus.warning, file=sys.stderr)
    if sys.stdout.isatty():
        SpyApp(bus, monitor, seconds).run()
    else:
        watch_plainly(bus, monitor, seconds, sys.stdout)
