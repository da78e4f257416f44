"""The tasks and methods that are compared, and how a run is told its method."""

from __future__ import annotations

from rtg import _core

TASKS = ("gathering", "sorting", "art_manip")
METHODS = _core.METHODS
REFERENCE = "ddqn_rtg"  # what the others are compared with
WIDER = "ddqn_rtg_dr"  # starts elsewhere, so its success is no one else's


def run_words(method: str) -> tuple[str, ...]:
    """Flags of `rtg run` that make it a run of the method."""
    return ("--method", method)
