"""Estimates how long a run still takes."""

from __future__ import annotations

from rtg import _core
from rtg.run.clock import duration
from rtg.run.run_state import FINISHED, RateMeter, RunState

_WINDOW = 30.0  # over which the rate of transitions is measured [s]
_GRADIENT_STEPS = 140.0  # of learning, the median of docs/results/tasks [1/s]
_RESULTS = 20.0  # for the last evaluation and pictures, 8 s in the middle there [s]
_PICTURES = 4.0  # of a run without training [s]


def usual_rate(train: _core.TrainConfig) -> float:
    """Returns how fast learning usually is, for as long as its own rate is not known.

    In interactions per second.
    """
    return _GRADIENT_STEPS * train.train_frequency / train.gradient_steps


class TimeLeft:
    """The remaining time of a run: all work to come at the present rates, then the results.

    Training may end before its budget is used up (train.stop_at_success), and over LCM it goes on
    beside the generation. `usual_rate`: of interactions, before theirs is known [1/s].
    """

    def __init__(self, usual_rate: float) -> None:
        self._transitions = RateMeter(_WINDOW)
        self._usual_rate = usual_rate

    def seconds(self, state: RunState, now: float) -> float | None:
        """Returns the time [s]; None before the first transition. `now`: any clock [s].

        0 once transitions and interactions are there, and only the results are to come.
        """
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
            left += (state.budget - state.interactions) / (state.rate or self._usual_rate)
        return left and left + (_RESULTS if state.budget else _PICTURES)


def words(seconds: float | None, state: RunState) -> str:
    """Returns the time left of class TimeLeft in words; "" if it is not known."""
    if seconds is None:
        return ""
    if not seconds:
        return "results to come"
    return f"{'at most' if state.budget else 'about'} {duration(seconds)} left"
