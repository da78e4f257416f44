"""Measures a whole run, from the start of its process on."""

from __future__ import annotations

import os
from types import TracebackType
from typing import Self

from rtg.run.clock import process_age
from rtg.run.progress import Display
from rtg.run.run_state import RunState


class RunTimes:
    """A display that also measures how long the run takes to start, and what it uses in all."""

    def __init__(self, display: Display) -> None:
        self._display = display
        self._start: float | None = None

    def __enter__(self) -> Self:
        self._display.__enter__()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._display.__exit__(kind, error, trace)

    def show(self, state: RunState) -> None:
        if self._start is None and (state.transitions or state.interactions):
            self._start = process_age()
        self._display.show(state)

    def note(self, message: str) -> None:
        self._display.note(message)

    def seconds(self) -> dict[str, float | None]:
        """Returns, for summary.json, the seconds so far.

        "start_wall_s": until the first transition or interaction, None before; "run_wall_s" and
        "run_cpu_s": of this process and of those that it started and that have ended.
        """
        used = os.times()
        cpu = used.user + used.system + used.children_user + used.children_system
        return {
            "start_wall_s": None if self._start is None else round(self._start, 2),
            "run_wall_s": round(process_age(), 2),
            "run_cpu_s": round(cpu, 2),
        }
