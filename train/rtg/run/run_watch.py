"""Follows the progress of a run by the messages of its processes."""

from __future__ import annotations

import time
from dataclasses import fields, replace
from typing import Any

from rtg import _core
from rtg.run.run_state import RunState

_MOST_PROCESSES = 4096  # whose counters are kept: those of a run started again and again


class RunWatch:
    """Receives the newest state of the run and the counters of all its processes."""

    def __init__(self, bus: _core.Bus, state: RunState) -> None:
        self.state = state
        self.heard_at = float("-inf")  # when the newest message came, by time.monotonic() [s]
        self._counters: dict[tuple[str, int, int], dict[str, int]] = {}
        bus.subscribe("RTG_PROGRESS", "search_progress_t", self._on_progress)
        bus.subscribe("RTG_STATUS", "node_status_t", self._on_status)

    def counters(self) -> dict[str, int]:
        """Returns the counters of all processes, summed by name."""
        total: dict[str, int] = {}
        for counted in self._counters.values():
            for name, value in counted.items():
                total[name] = total.get(name, 0) + value
        return dict(sorted(total.items()))

    def _on_progress(self, message: Any) -> None:
        self.heard_at = time.monotonic()
        shown = {f.name for f in fields(RunState)} & set(vars(message))
        self.state = replace(self.state, **{name: getattr(message, name) for name in shown})

    def _on_status(self, message: Any) -> None:
        self.heard_at = time.monotonic()
        key = (message.node, message.number, message.sender)
        if key not in self._counters and len(self._counters) >= _MOST_PROCESSES:
            return
        self._counters[key] = dict(
            zip(message.counter_name, message.counter_value.tolist(), strict=True)
        )
