"""Says where a run that did not succeed got stuck, with the figure that tells and what to try."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rtg import _core, paths
from rtg.pictures.draw import objects
from rtg.run.effective_config import TREE_GENERATORS

_WELL = 0.9  # success rate that needs no explanation
_UNDRAWN = 0.05  # share of draws of goal states in vain that is told
_SOLVED = 0.5  # least share of reverse solves
_COVERED = 0.005  # least share of transitions that begin in the start region
_RANKED = 0.5  # least rank correlation of Q with the simulator
_MANY_STEPS = 4  # gradient steps of a round, beyond which more are not advised
_THERE = 0.4  # distance at which an object is in its place, in the unit of poses
_STILL = 0.05  # spread of places of an object that is in one place, in the unit of poses

Floats = NDArray[np.float64]


def _outside(region: dict[str, Any], places: Floats) -> Floats:
    """Returns how far the places lie outside of a start's region; 0 inside. [N, 2] -> [N] [m]

    Near a corner of a polygon the distance from the nearest edge line counts.
    """
    if disc := region.get("in", {}).get("disc"):
        excess = np.linalg.norm(places - disc["centre"], axis=1) - disc["radius"]
    elif ring := region.get("in", {}).get("polygon"):  # convex, counter-clockwise
        edges = np.roll(ring, -1, axis=0) - ring
        normals = np.stack((edges[:, 1], -edges[:, 0]), axis=1)
        normals /= np.linalg.norm(edges, axis=1)[:, None]
        excess = (places @ normals.T - (normals * ring).sum(axis=1)).max(axis=1)
    else:
        (left, right), (low, high) = region["x"], region["y"]
        x, y = places.T
        excess = np.max((left - x, x - right, low - y, y - high), axis=0)
    return np.maximum(excess, 0.0)


def _on_ranges(task: _core.Task, bodies: list[dict[str, Any]]) -> set[int]:
    """Returns the bodies that joints connect with one whose start is a range.

    Their start is given as if that body were in the middle of its range.
    """
    moved = {k for k, body in enumerate(bodies) if isinstance(body["start"], dict)}
    ranged = set(moved)
    for _ in task.joints:  # in any order, so one more body of a tree with each pass
        moved |= {child for parent, child, _ in task.joints if parent in moved}
    return moved - ranged


def _distances(config: _core.Config, poses: Floats) -> str:
    """Says how near each object comes to where it starts in the nodes [N, bodies, 3] of the trees.

    Says nothing of bodies that hang on one whose start is a range.
    """
    task, parts = config.task, []
    bodies = json.loads(config.json)["task"]["bodies"]
    on_ranges = _on_ranges(task, bodies)
    for body in objects(task):
        if body in on_ranges:
            continue
        places, start = poses[:, body, :2], bodies[body]["start"]
        if isinstance(start, dict):
            away = float(_outside(start, places / task.metre).min())
        else:
            way = np.linalg.norm(places - task.start[body, :2], axis=1)
            away = float(way.min()) / task.metre
        words = f"'{task.names[body]}' {away:.2g} m"
        if np.ptp(places, axis=0).max() < _STILL and away * task.metre > _THERE:
            words += " (in one place in all states)"
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


def undrawn_goals(summary: dict[str, Any]) -> str | None:
    """Returns a sentence on the goal states that were drawn in vain; None if there were few.

    `summary` has the figures of generation.json; with own data, it has none on draws.
    """
    failed, draws = summary.get("undrawn_goals") or 0, summary.get("goal_draws") or 0
    if failed < max(1.0, _UNDRAWN * draws):
        return None
    return (
        f"goal states: {failed:,} of {draws:,} draws met no goal: {summary['undrawn_reason']}; "
        f"{paths.COMMAND} check FILE.yaml --picture FILE.png draws some"
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
            f"goal states: {summary.get('undrawn_goals', 0)} draws met no goal"
            f"{f' ({why})' if (why := summary.get('undrawn_reason')) else ''} and "
            f"{summary.get('unsettled_goals', 0)} states did not come to rest as one; try wider "
            f"tolerances of task.goal, and {paths.COMMAND} check FILE.yaml --picture FILE.png"
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


def of_own_data(data: dict[str, Any]) -> str | None:
    """Returns a sentence about what own data lack; None if they have successes.

    `data`: that of generation.json.
    """
    if data["successes"]:
        return None
    return f"goal: none of {data['transitions']:,} transitions reaches it; try data that do"


def _learning(config: _core.Config, summary: dict[str, Any]) -> str | None:
    success = summary.get("success_rate")
    if success is None:
        return None
    starts, count = summary["start_region_transitions"], summary["transitions"]
    search, is_own = config.search, bool(summary.get("data"))
    if starts < _COVERED * count:
        more = (
            "data from there"
            if is_own
            else f"more transitions (search.transitions, {search.transitions:,} now)"
        )
        return f"coverage: {starts:,} of {count:,} transitions begin where episodes do; try {more}"
    ranked = summary.get("q_rank_correlation")
    if ranked is not None and ranked < _RANKED:
        headings = (
            f"data with other headings from the same states ({summary['headings_per_state']:.1f} "
            "per state now)"
            if is_own
            else f"other headings with each step (search.branches, {search.branches} now)"
        )
        return (
            f"learning: Q ranks the headings of a state little better than by chance "
            f"({ranked:.2f}); try {headings}, more interactions (train.interactions)"
        )
    train = config.train
    more = f"more interactions (train.interactions, {train.interactions:,} now)"
    if train.gradient_steps < _MANY_STEPS:
        more = f"more gradient steps (train.gradient_steps, {train.gradient_steps} now) or {more}"
    return f"learning: success {success:.2f} at the end of the budget; try {more}"


def bottleneck(
    config: _core.Config, summary: dict[str, Any], nodes: Sequence[dict[str, Any]]
) -> str | None:
    """Returns a sentence about the first stage that falls short; None if all is well.

    `nodes`: those of generation.json. Only of runs whose own trees found the data, or that were
    given data.
    """
    own = summary.get("data")
    if summary["transitions"] is None:
        return None
    if not own and config.search.generator not in TREE_GENERATORS:
        return None
    if (summary.get("success_rate") or 0.0) >= _WELL:
        return None
    lacks = of_own_data(own) if own else of_generation(config, summary, nodes)
    found = lacks or _learning(config, summary)
    return found and f"bottleneck: {found}"
