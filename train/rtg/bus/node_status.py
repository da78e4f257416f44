"""Publishes state and counters of a process on the channel RTG_STATUS, for displays."""

from __future__ import annotations

import time

from rtg import _core

INTERVAL = 0.5  # [s], between two messages with the same state
ENDED = "ended"  # the last state that a process publishes before it exits


class NodeStatus:
    """Publishes the status of this process, which `node` names."""

    def __init__(self, bus: _core.Bus, node: str) -> None:
        self._bus, self._node = bus, node
        self._published, self._published_at = "", -1e9

    def tick(self, state: str, done: int) -> None:
        """Publishes the status: at once if `state` is new, else at most every INTERVAL.

        `done`: number of completed items of work. May be called at any rate.
        """
        now = time.monotonic()
        if state == self._published and now - self._published_at < INTERVAL:
            return
        self._published, self._published_at = state, now
        counters = self._bus.counters
        self._bus.publish(
            "RTG_STATUS",
            "node_status_t",
            node=self._node,
            state=state,
            done=done,
            cpu_s=time.process_time(),
            counter_name=list(counters),
            counter_value=list(counters.values()),
        )
