"""Tells people what a process does and what it has counted, twice a second: RTG_STATUS."""

from __future__ import annotations

import time

from rtg.bus import Bus
from rtg.messages import message_type

INTERVAL = 0.5  # [s]


class NodeStatus:
    """The voice of one process of the graph."""

    def __init__(self, bus: Bus, node: str, number: int = 0) -> None:
        self._bus, self._node, self._number = bus, node, number
        self._said_at = -1e9

    def tick(self, state: str, done: int) -> None:
        """To be called as often as one likes."""
        now = time.monotonic()
        if now - self._said_at < INTERVAL:
            return
        self._said_at = now
        message = message_type("node_status_t")()
        message.node, message.number = self._node, self._number
        message.state, message.done = state, done
        message.cpu_s = time.process_time()
        message.counter_name = list(self._bus.counters)
        message.counter_value = list(self._bus.counters.values())
        message.n = len(message.counter_name)
        self._bus.publish("RTG_STATUS", message)
