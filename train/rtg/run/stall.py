"""Ends a run that does not get on any more."""

from __future__ import annotations

from dataclasses import replace

from rtg.errors import RunError
from rtg.run.run_state import RunState

LIMIT = 1800.0  # [s] without progress; with the preset paper, a layer of the search takes minutes


class Stall:
    """Watches whether the search or the learner of a run gets on. `now`: monotonic time [s]."""

    def __init__(self, now: float) -> None:
        self._at, self._stood_at = now, RunState()

    def check(self, state: RunState, now: float) -> None:
        """Raises RunError if nothing has changed for LIMIT seconds."""
        stands_at = replace(state, workers=0, rate=0.0)
        if stands_at != self._stood_at:
            self._at, self._stood_at = now, stands_at
        elif now - self._at > LIMIT:
            raise RunError(
                f"no progress for {LIMIT / 60:.0f} minutes, so the run ends: "
                f"{state.transitions:,} transitions, {state.workers} workers heard, "
                f"{state.interactions:,} interactions; logs/ of its folder has what its programs "
                "said last, and --resume goes on from there"
            )
