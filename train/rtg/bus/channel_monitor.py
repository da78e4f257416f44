"""The traffic on the channels: counts, rates, node states. Free of I/O, the clock passed in."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from rtg.bus.bus import decoded
from rtg.bus.messages import type_of
from rtg.bus.node_status import ENDED

STRETCH = 4.0  # [s], over which rates are taken
SILENT = 3.0  # [s] without a status: the node counts as silent
_OF_LCM = "LCM_SELF_TEST"  # channel on which every process tries whether it hears itself


class Rates:
    """Growth per second of a few counts over the last stretch of time."""

    def __init__(self, size: int) -> None:
        self._samples: deque[tuple[float, tuple[float, ...]]] = deque()
        self.per_second = (0.0,) * size

    def sample(self, now: float, *counts: float) -> None:
        """Takes the counts at time `now` [s] in."""
        if self._samples and now <= self._samples[-1][0]:
            return
        self._samples.append((now, counts))
        while len(self._samples) > 2 and now - self._samples[1][0] >= STRETCH:
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
    size: int = 0  # [bytes] in all
    undecodable: int = 0
    rates: Rates = field(default_factory=lambda: Rates(2))


@dataclass
class _Node:
    status: Any  # the last node_status_t
    heard: float
    rates: Rates = field(default_factory=lambda: Rates(2))


class ChannelRow(NamedTuple):
    """A channel, for people."""

    channel: str
    type_name: str
    messages: int
    rate: float  # [1/s]
    bandwidth: float  # [bytes/s]
    undecodable: int


class NodeRow(NamedTuple):
    """A process, for people."""

    name: str
    pid: int
    state: str
    done: int
    rate: float  # of `done` [1/s]
    cpu: float  # share of one core
    counters: str  # those that are not 0


class ChannelMonitor:
    """Counts every message by channel and keeps the last status of every node, of whatever run."""

    def __init__(self) -> None:
        self._channels: dict[str, _Channel] = {}
        self._nodes: dict[tuple[int, str, int], _Node] = {}
        self._progress: Any = None
        self._over: set[int] = set()  # runs whose generation is over
        self._handlers: dict[str, Callable[[Any, float], None]] = {
            "node_status_t": self._on_status,
            "search_progress_t": self._on_progress,
        }

    def on_message(self, channel: str, data: bytes, now: float) -> None:
        """Takes one message in. now [s]."""
        if channel == _OF_LCM:
            return
        stats = self._channels.setdefault(channel, _Channel())
        stats.messages += 1
        stats.size += len(data)
        kind = type_of(data)
        message = None if kind is None else decoded(kind, data)
        if kind is None or isinstance(message, str):
            stats.undecodable += 1
            return
        stats.type_name = kind.__name__
        if kind.__name__ in self._handlers:
            self._handlers[kind.__name__](message, now)

    def sample(self, now: float) -> None:
        """Takes the rates up to `now` [s]; to be called about twice a second."""
        for stats in self._channels.values():
            stats.rates.sample(now, stats.messages, stats.size)
        for node in self._nodes.values():
            node.rates.sample(node.heard, node.status.done, node.status.cpu_s)

    def channels(self) -> list[ChannelRow]:
        """All channels by name."""
        return [_channel_row(name, stats) for name, stats in sorted(self._channels.items())]

    def nodes(self, now: float) -> list[NodeRow]:
        """All nodes heard so far, by name."""
        return [
            _node_row(node, now - node.heard, run in self._over and name != "trainer")
            for (run, name, _), node in sorted(self._nodes.items())
        ]

    def progress(self) -> str:
        """Where the generation stands, in one line; empty if nothing was heard of it."""
        p = self._progress
        if p is None:
            return ""
        layer = f", layer {p.layer}/{p.depth}" if p.depth else ""
        phase = "generation over" if p.leaving else p.phase
        return (
            f"{phase}{layer}: {p.transitions:,} of {p.target:,} transitions, "
            f"contact share {p.contact_share:.2f}, {p.start_region:,} in the start region, "
            f"workers: {p.workers}, jobs open: {p.jobs_open}, "
            f"consumers: {p.consumers}, the slowest at {p.slowest_cursor:,}"
        )

    def _on_status(self, message: Any, now: float) -> None:
        key = (message.header.run, message.node, message.number)
        node = self._nodes.get(key)
        if node is None or node.status.header.sender != message.header.sender:
            node = self._nodes[key] = _Node(message, now)  # a restarted one counts from 0
        node.status, node.heard = message, now

    def _on_progress(self, message: Any, _: float) -> None:
        self._progress = message
        if message.leaving:
            self._over.add(message.header.run)
        else:  # a run resumed
            self._over.discard(message.header.run)


def _channel_row(name: str, stats: _Channel) -> ChannelRow:
    rate, bandwidth = stats.rates.per_second
    kind = stats.type_name or "?"
    return ChannelRow(name, kind, stats.messages, rate, bandwidth, stats.undecodable)


def _node_row(node: _Node, silence: float, over: bool) -> NodeRow:
    status = node.status
    state, (rate, cpu) = status.state, node.rates.per_second
    if state != ENDED and silence >= SILENT:
        state = ENDED if over else f"silent {silence:.0f} s"
    if state == ENDED or silence >= SILENT:
        rate = cpu = 0.0
    counters = zip(status.counter_name, status.counter_value, strict=True)
    return NodeRow(
        f"{status.node} {status.number}",
        status.header.sender,
        state,
        status.done,
        rate,
        cpu,
        ", ".join(f"{name} {value}" for name, value in counters if value),
    )
