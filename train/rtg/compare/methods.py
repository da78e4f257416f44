"""The tasks and methods that are compared, and how a run is told its method."""

from __future__ import annotations

TASKS = ("gathering", "sorting", "art_manip")
METHODS = (
    "dqn",
    "ddqn",
    "ddqn_random",
    "ddqn_scatter",
    "ddqn_naive",
    "ddqn_forward",
    "ddqn_rtg",
    "ddqn_rtg_dr",
    "her",
    "rcg",
    "cql_rtg",
    "bc_rtg",
    "planner",
)
REFERENCE = "ddqn_rtg"  # what the others are compared with
WIDER = "ddqn_rtg_dr"  # starts elsewhere, so its success is no one else's


def run_words(method: str) -> tuple[str, ...]:
    """Flags of `rtg run` that make it a run of the method."""
    return ("--method", method)
