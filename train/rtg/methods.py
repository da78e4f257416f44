"""The methods that are compared, and how a run is told which of them it is."""

from __future__ import annotations

METHODS = (
    "dqn",
    "ddqn",
    "ddqn_random",
    "ddqn_naive",
    "ddqn_rtg",
    "ddqn_rtg_dr",
    "her",
    "rcg",
)
REFERENCE = "ddqn_rtg"  # what the others are compared with

_RUN_WORDS: dict[str, tuple[str, ...]] = {
    "ddqn_naive": ("--reverse", "naive"),
    "ddqn_rtg": ("--reverse", "rrbs"),
}
RUNNABLE = tuple(method for method in METHODS if method in _RUN_WORDS)


def run_words(method: str) -> tuple[str, ...]:
    """Flags of `rtg run` that make it a run of the method, one of RUNNABLE."""
    return _RUN_WORDS[method]
