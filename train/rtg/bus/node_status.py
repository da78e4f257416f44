"""Tells people what a process does and what it has counted: RTG_STATUS."""

from __future__ import annotations

import time

from rtg.bus.bus import Bus
from rtg.bus.messages import message_type

INTERVAL = 0.5  # [s]
ENDED = "ended"  # the last state of a process that says good-bye


class NodeStatus:
    """The voice of one process of the graph."""

    def __init__(self, bus: Bus, node: str, number: int = 0) -> None:
        self._bus, self._node, self._number = bus, node, number
        self._said, self._said_at = "", -1e9

    def tick(self, state: str, done: int) -> None:
        """Sends a new state at once, the same one twice a second; call it as often as you like."""
        now = time.monotonic()
        if state == self._said and now - self._said_at < INTERVAL:
            return
        self._said, self._said_at = state, now
        message = message_type("node_status_t")()
        message.node, message.number = self._node, self._number
        message.state, message.done = state, done
        message.cpu_s = time.process_time()
        message.counter_name = list(self._bus.counters)
        message.counter_value = list(self._bus.counters.values())
        message.n = len(message.counter_name)
        self._bus.publish("RTG_STATUS", message)
