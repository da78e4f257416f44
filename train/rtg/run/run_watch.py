"""Follows the progress of a run by the messages of its processes."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

from rtg.bus.bus import Bus
from rtg.bus.messages import message_type
from rtg.run.run_state import RunState


class RunWatch:
    """Receives the newest state of the run and the counters of all its processes."""

    def __init__(self, bus: Bus, state: RunState) -> None:
        self.state = state
        self._counters: dict[tuple[str, int, int], dict[str, int]] = {}
        bus.subscribe("RTG_PROGRESS", message_type("search_progress_t"), self._on_progress)
        bus.subscribe("RTG_STATUS", message_type("node_status_t"), self._on_status)

    def counters(self) -> dict[str, int]:
        """Returns the counters of all processes, summed by name."""
        total: dict[str, int] = {}
        for counted in self._counters.values():
            for name, value in counted.items():
                total[name] = total.get(name, 0) + value
        return dict(sorted(total.items()))

    def _on_progress(self, message: Any) -> None:
        shown = {f.name for f in fields(RunState)} & set(message.__slots__)
        self.state = replace(self.state, **{name: getattr(message, name) for name in shown})

    def _on_status(self, message: Any) -> None:
        key = (message.node, message.number, message.header.sender)
        self._counters[key] = dict(zip(message.counter_name, message.counter_value, strict=True))
