"""Estimates how long a run still takes."""

from __future__ import annotations

from rtg.run.run_state import FINISHED, RateMeter, RunState

_WINDOW = 30.0  # over which the rate of transitions is measured [s]
_USUAL_RATE = 600.0  # of interactions, before any is known [1/s]


class TimeLeft:
    """The remaining time of a run, at most: all work to come at the present rates.

    Training may end before its budget is used up (train.stop_at_success), and over LCM it goes on
    beside the generation.
    """

    def __init__(self) -> None:
        self._transitions = RateMeter(_WINDOW)

    def seconds(self, state: RunState, now: float) -> float | None:
        """Returns the time [s]; None before the first transition. `now`: any clock [s]."""
        left = 0.0
        if state.phase == FINISHED:
            pass  # perhaps with fewer transitions than asked for
        elif state.generates and state.transitions < state.target:
            rate = self._transitions.rate(state.transitions, now)
            if rate <= 0.0:
                return None
            left += (state.target - state.transitions) / rate
        elif state.generates and not state.target:
            return None
        if state.interactions < state.budget:
            left += (state.budget - state.interactions) / (state.rate or _USUAL_RATE)
        return left
