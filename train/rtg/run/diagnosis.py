"""Says where a run that did not succeed got stuck, with the figure that tells and what to try."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.pictures.draw import objects
from rtg.run.effective_config import TREE_GENERATORS

_WELL = 0.9  # success rate that needs no explanation
_SOLVED = 0.5  # least share of reverse solves
_COVERED = 0.005  # least share of transitions that begin in the start region
_RANKED = 0.5  # least rank correlation of Q with the simulator
_THERE = 0.4  # distance at which an object is in its place
_STILL = 0.05  # spread of places of an object that does not move


def _distances(config: _core.Config, poses: NDArray[np.float64]) -> str:
    """Says how near each object comes to its start in the nodes [N, bodies, 3] of the trees."""
    task, parts = config.task, []
    for body in objects(task):
        way = np.linalg.norm(poses[:, body, :2] - task.start[body, :2], axis=1)
        still = bool(np.ptp(poses[:, body, :2], axis=0).max() < _STILL)
        words = f"'{task.names[body]}' {way.min() / task.metre:.2g} m"
        if still and way.min() > _THERE:
            words += " (no step moves it)"
        parts.append(words)
    return ", ".join(parts)


def _search_advice(config: _core.Config, summary: dict[str, Any], deepest: int) -> str:
    search = config.search
    if deepest >= min(search.depth, config.task.horizon) - 1:
        horizon = config.task.horizon
        return f"deeper trees (search.depth, {search.depth} now, and task.horizon, {horizon} now)"
    if summary["trees"] <= 1:
        return f"more transitions (search.transitions, {search.transitions:,} now)"
    return (
        f"trees that go on without coming nearer (search.patience, {search.patience} now), wider "
        f"ones (search.breadth, {search.breadth} now)"
    )


def of_generation(
    config: _core.Config, summary: dict[str, Any], nodes: Sequence[dict[str, Any]]
) -> str | None:
    """Returns a sentence about what limits the search; None if nothing does.

    `summary` has the figures of generation.json, `nodes` are those of it.
    """
    if config.search.generator not in TREE_GENERATORS:
        return None
    if not summary["trees"]:
        return (
            f"goal states: {summary.get('undrawn_goals', 0)} draws met no goal and "
            f"{summary.get('unsettled_goals', 0)} states did not come to rest as one; try wider "
            "tolerances of task.goal, and ./run.sh check FILE.yaml --picture FILE.png"
        )
    asked = summary["candidates"] - summary["pruned"]
    if asked and summary["converged"] < _SOLVED * asked:
        return (
            f"reverse solves: {summary['converged']:,} of {asked:,} found a push; try more "
            "sub-steps of a push (physics.sub_steps) or shorter ones (task.push.strides)"
        )
    if summary["start_region_depth"] < 0 and nodes:
        poses = np.array([node["poses"] for node in nodes])
        deepest = max(node["depth"] for node in nodes)
        room = ", or wider ways between the fixed bodies" if any(config.task.fixed) else ""
        return (
            f"reaching the start: no tree does (start_region_depth is -1), the deepest has "
            f"{deepest} actions; nearest to their starts came {_distances(config, poses)}; try "
            f"{_search_advice(config, summary, deepest)}, or an easier start{room}"
        )
    return None


def _learning(config: _core.Config, summary: dict[str, Any]) -> str | None:
    success = summary.get("success_rate")
    if success is None:
        return None
    starts, count = summary["start_region_transitions"], summary["transitions"]
    if starts < _COVERED * count:
        return (
            f"coverage: {starts:,} of {count:,} transitions begin where episodes do; try more "
            f"transitions (search.transitions, {config.search.transitions:,} now)"
        )
    ranked = summary.get("q_rank_correlation")
    if ranked is not None and ranked < _RANKED:
        return (
            f"learning: Q ranks the headings of a state little better than by chance "
            f"({ranked:.2f}); try other headings with each step (search.branches, "
            f"{config.search.branches} now), more interactions (train.interactions)"
        )
    return (
        f"learning: success {success:.2f} at the end of the budget; try more interactions "
        f"(train.interactions, {config.train.interactions:,} now)"
    )


def bottleneck(
    config: _core.Config, summary: dict[str, Any], nodes: Sequence[dict[str, Any]]
) -> str | None:
    """Returns a sentence about the first stage that falls short; None if all is well.

    `nodes`: those of generation.json. Only of runs whose data trees found.
    """
    if summary["transitions"] is None or config.search.generator not in TREE_GENERATORS:
        return None
    if (summary.get("success_rate") or 0.0) >= _WELL:
        return None
    found = of_generation(config, summary, nodes) or _learning(config, summary)
    return found and f"bottleneck: {found}"
