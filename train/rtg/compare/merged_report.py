"""Merges the reports of generations that found the shards of one data set."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

Report = dict[str, Any]  # the content of a generation.json

_SHARES = ("contact_share", "multi_body_share")  # of the transitions
# Medians and 90th percentiles, by the list that they are of.
_QUANTILES = {
    "iterations": "iterations",
    "pushing_iterations": "pushing_iterations",
    "replay_gap": "replay_gaps",
}
_WALL = "generate_wall_s"


def merged(reports: Sequence[Report]) -> Report:
    """Returns the report on all transitions. The wall time is that of the slowest generation."""
    found = {key: _sum([report[key] for report in reports]) for key in reports[0]}
    found["shortfalls"] = list(dict.fromkeys(found["shortfalls"]))
    most = max(reports, key=lambda report: report["undrawn_goals"])
    found["undrawn_reason"] = most["undrawn_reason"]
    found[_WALL] = max(report[_WALL] for report in reports)
    counts = [report["transitions"] for report in reports]
    for key in _SHARES:
        found[key] = _mean([report[key] for report in reports], counts)
    with_data = [report for report in reports if report["transitions"]]
    states = sum(report["transitions"] / report["headings_per_state"] for report in with_data)
    found["headings_per_state"] = found["transitions"] / states if states else 0.0
    depths = [start["depth"] for start in found["starts"] if start["depth"] is not None]
    found["start_depth"] = _quantile(depths, 0.5) if depths else None
    for name, values in _QUANTILES.items():
        for key, share in ((f"{name}_median", 0.5), (f"{name}_p90", 0.9)):
            found[key] = _quantile(found[values], share) if found["candidates"] else None
    return found


def _sum(values: Sequence[Any]) -> Any:
    """Returns the sum of numbers, of lists, or of dictionaries entry by entry.

    Returns None if there are others, such as digests, which cannot be added.
    """
    first = values[0]
    if isinstance(first, dict):
        return {key: _sum([value[key] for value in values]) for key in first}
    if isinstance(first, list):
        return [entry for value in values for entry in value]
    return None if any(value is None or isinstance(value, str) for value in values) else sum(values)


def _mean(values: Sequence[float], weights: Sequence[int]) -> float:
    total = sum(weights)
    return sum(v * w for v, w in zip(values, weights, strict=True)) / total if total else 0.0


def _quantile(values: Sequence[float], share: float) -> float:
    """Returns the value of the nearest rank, as core/math/quantile.hpp; 0 if there are none."""
    return float(sorted(values)[int(share * (len(values) - 1) + 0.5)]) if values else 0.0
