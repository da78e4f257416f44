"""Statistics of all channels: message counts, rates, and states of nodes (processes of a run).

Whoever sends on the bus can make up channels, runs and nodes. So there is a limit to each; what is
beyond is counted together.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol

from rtg.bus.node_status import ENDED

RATE_WINDOW = 4.0  # [s], period of time that rates cover
SILENCE_LIMIT = 3.0  # [s] without a status after which a node counts as silent
MOST_CHANNELS = 64
MOST_NODES = 512  # of all runs
OTHERS = "(others)"  # stands for the channels beyond that
# On which LCM and the bus test whether a process receives its own messages.
_TEST_CHANNELS = ("LCM_SELF_TEST", "RTG_ECHO")


class Source(Protocol):
    """Where messages come from, such as _core.BusMonitor."""

    def spin(self, timeout: float, handler: Callable[[str, int, str, Any], None]) -> int:
        """Waits up to `timeout` s, then passes on channel, size, type and message of each."""


class Rates:
    """The rates of change of several counters [1/s] over the last RATE_WINDOW seconds."""

    def __init__(self, size: int) -> None:
        self._samples: deque[tuple[float, tuple[float, ...]]] = deque()
        self.per_second = (0.0,) * size

    def sample(self, now: float, *counts: float) -> None:
        """Adds the values `counts` of the counters at time `now` [s].

        Ignores them if `now` is not later than the previous time.
        """
        if self._samples and now <= self._samples[-1][0]:
            return
        self._samples.append((now, counts))
        while len(self._samples) > 2 and now - self._samples[1][0] >= RATE_WINDOW:
            self._samples.popleft()
        first_time, first = self._samples[0]
        if now > first_time:
            self.per_second = tuple(
                (new - old) / (now - first_time) for new, old in zip(counts, first, strict=True)
            )


@dataclass
class _Channel:
    type_name: str = ""
    messages: int = 0
    size: int = 0  # [bytes], sum over all messages
    undecodable: int = 0
    rates: Rates = field(default_factory=lambda: Rates(2))


@dataclass
class _Node:
    status: Any  # the last node_status_t
    arrived_at: float  # [s], when `status` arrived
    rates: Rates = field(default_factory=lambda: Rates(2))


class ChannelRow(NamedTuple):
    """The values that a display shows for a channel."""

    channel: str
    type_name: str
    messages: int
    rate: float  # [1/s]
    bandwidth: float  # [bytes/s]
    undecodable: int


class NodeRow(NamedTuple):
    """The values that a display shows for a process."""

    name: str
    pid: int
    state: str
    done: int
    rate: float  # [1/s], increase of `done`
    cpu: float  # share of one core
    counters: str  # names and values of the counters that are not 0


class RunRow(NamedTuple):
    """The values that a display shows for a run."""

    run: int  # _core.run_id() of its name
    progress: str  # of its data generation, in one line; "" before any message on it
    nodes: list[NodeRow]  # sorted by name
    is_over: bool  # all of its processes have ended


class ChannelMonitor:
    """Counts the messages on each channel and keeps the last status of each node, of all runs."""

    def __init__(self, source: Source | None = None) -> None:
        self._source = source
        self._channels: dict[str, _Channel] = {}
        self._nodes: dict[tuple[int, str, int], _Node] = {}
        self._progress: dict[int, Any] = {}  # the last search_progress_t of each run
        self._finished_runs: set[int] = set()  # of the runs whose data generation is over
        self._handlers: dict[str, Callable[[Any, float], None]] = {
            "node_status_t": self._on_status,
            "search_progress_t": self._on_progress,
        }

    def listen(self, timeout: float) -> None:
        """Waits up to `timeout` s for messages of the source and counts them."""

        def heard(channel: str, size: int, kind: str, message: Any) -> None:
            self.on_message(channel, size, kind, message, time.monotonic())

        if self._source is not None:
            self._source.spin(timeout, heard)

    def on_message(self, channel: str, size: int, kind: str, message: Any, now: float) -> None:
        """Counts a message of `size` bytes that arrived at time `now` [s].

        `kind`: the name of its type; "" if it is none of RTG's. `message` is then None.
        """
        if channel in _TEST_CHANNELS:
            return
        if channel not in self._channels and len(self._channels) >= MOST_CHANNELS:
            channel = OTHERS
        stats = self._channels.setdefault(channel, _Channel())
        stats.messages += 1
        stats.size += size
        if not kind:
            stats.undecodable += 1
            return
        stats.type_name = kind
        if kind in self._handlers:
            self._handlers[kind](message, now)

    def sample(self, now: float) -> None:
        """Updates the rates at time `now` [s]; to be called about twice a second."""
        for stats in self._channels.values():
            stats.rates.sample(now, stats.messages, stats.size)
        for node in self._nodes.values():
            node.rates.sample(node.arrived_at, node.status.done, node.status.cpu_s)

    def channels(self) -> list[ChannelRow]:
        """Returns all channels, sorted by name."""
        return [_channel_row(name, stats) for name, stats in sorted(self._channels.items())]

    def runs(self, now: float) -> list[RunRow]:
        """Returns the states of all runs at time `now` [s]: first those that are not over."""
        keys = dict.fromkeys([*(run for run, _, _ in self._nodes), *self._progress])
        return sorted((self._run_row(run, now) for run in keys), key=lambda row: row.is_over)

    def _run_row(self, run: int, now: float) -> RunRow:
        over = run in self._finished_runs
        nodes = [
            _node_row(node, now - node.arrived_at, over and name != "trainer")
            for (of, name, _), node in sorted(self._nodes.items())
            if of == run
        ]
        is_over = over and all(row.state == ENDED for row in nodes)
        return RunRow(run, _progress_text(self._progress.get(run)), nodes, is_over)

    def _on_status(self, message: Any, now: float) -> None:
        key = (message.run, message.node, message.number)
        node = self._nodes.get(key)
        if node is None and len(self._nodes) >= MOST_NODES:
            return
        if node is None or node.status.sender != message.sender:
            node = self._nodes[key] = _Node(message, now)  # a restarted node counts from 0
        node.status, node.arrived_at = message, now

    def _on_progress(self, message: Any, _: float) -> None:
        if message.run not in self._progress and len(self._progress) >= MOST_NODES:
            return
        self._progress[message.run] = message
        if message.leaving:
            self._finished_runs.add(message.run)
        else:  # a resumed run
            self._finished_runs.discard(message.run)


def _progress_text(p: Any) -> str:
    """Describes a search_progress_t in one line; "" if it is None."""
    if p is None:
        return ""
    layer = f", layer {p.layer}/{p.depth}" if p.depth else ""
    phase = "generation over" if p.leaving else p.phase
    return (
        f"{phase}{layer}: {p.transitions:,} of {p.target:,} transitions, "
        f"contact share {p.contact_share:.2f}, starts reached: {p.starts_reached:,}, "
        f"workers: {p.workers}, jobs open: {p.jobs_open}, "
        f"consumers: {p.consumers}, the slowest at {p.slowest_cursor:,}"
    )


def _channel_row(name: str, stats: _Channel) -> ChannelRow:
    rate, bandwidth = stats.rates.per_second
    kind = stats.type_name or "?"
    return ChannelRow(name, kind, stats.messages, rate, bandwidth, stats.undecodable)


def _node_row(node: _Node, silence: float, over: bool) -> NodeRow:
    status = node.status
    state, (rate, cpu) = status.state, node.rates.per_second
    if state != ENDED and silence >= SILENCE_LIMIT:
        state = ENDED if over else f"silent {silence:.0f} s"
    if state == ENDED or silence >= SILENCE_LIMIT:
        rate = cpu = 0.0
    counters = zip(status.counter_name, status.counter_value, strict=True)
    return NodeRow(
        f"{status.node} {status.number}",
        status.sender,
        state,
        status.done,
        rate,
        cpu,
        ", ".join(f"{name} {value}" for name, value in counters if value),
    )
