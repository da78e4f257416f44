"""Says where a run that did not succeed got stuck, with the figure that tells and what to try."""

from __future__ import annotations

from typing import Any

import numpy as np

from rtg import _core, paths
from rtg.pictures.draw import objects
from rtg.run.effective_config import TREE_GENERATORS

_WELL = 0.9  # success rate that needs no explanation
_UNDRAWN = 0.05  # share of draws of goal states in vain that is told
_SOLVED = 0.5  # least share of reverse solves
_REJECTED = 0.5  # share of pushes that could not be simulated
_COVERED = 0.005  # least share of own transitions that begin at a start
_RANKED = 0.5  # least rank correlation of Q with the simulator
_MANY_STEPS = 4  # gradient steps of a round, beyond which more are not advised
_THERE = 0.4  # distance at which an object is in its place, in the unit of poses
_STILL = 0.05  # spread of places of an object that is in one place, in the unit of poses


def _distances(task: _core.Task, report: dict[str, Any]) -> str:
    """Says how far each object is from its start in the state that comes nearest to one."""
    parts = []
    bodies = objects(task)
    nearest = min((np.array(s["away"]) for s in report["starts"]), key=lambda a: a[bodies].sum())
    poses = np.array([node["poses"] for node in report["nodes"]])
    for body in bodies:
        words = f"'{task.names[body]}' {nearest[body] / task.metre:.2g} m"
        if np.ptp(poses[:, body, :2], axis=0).max() < _STILL and nearest[body] > _THERE:
            words += " (in one place in all states)"
        parts.append(words)
    return ", ".join(parts)


def _search_advice(config: _core.Config, deepest: int) -> str:
    search = config.search
    if deepest >= min(search.depth, config.task.horizon) - 1:
        horizon = config.task.horizon
        return f"deeper trees (search.depth, {search.depth} now, and task.horizon, {horizon} now)"
    return f"more transitions (search.transitions, {search.transitions:,} now)"


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


def of_search(config: _core.Config, report: dict[str, Any]) -> str | None:
    """Returns a sentence about goal states or reverse solves that fall short; None if none do.

    `report`: generation.json.
    """
    if config.search.generator not in TREE_GENERATORS:
        return None
    replays, rejected = report.get("replays", 0), report.get("rejected_pushes", 0)
    if replays and rejected > _REJECTED * replays:
        return (
            f"forward simulator: it could not simulate {rejected:,} of {replays:,} pushes; try "
            f"another forward.engine ({config.forward.engine} now), or mend it"
        )
    if not report["trees"]:
        return (
            f"goal states: {report.get('undrawn_goals', 0)} draws met no goal"
            f"{f' ({why})' if (why := report.get('undrawn_reason')) else ''} and "
            f"{report.get('unsettled_goals', 0)} states did not come to rest as one; try wider "
            f"tolerances of task.goal, and {paths.COMMAND} check FILE.yaml --picture FILE.png"
        )
    asked = report["candidates"] - report["pruned"]
    if asked and report["converged"] < _SOLVED * asked:
        return (
            f"reverse solves: {report['converged']:,} of {asked:,} found a push; try more "
            "sub-steps of a push (physics.sub_steps) or shorter ones (task.push.strides)"
        )
    return None


def of_starts(config: _core.Config, report: dict[str, Any]) -> str | None:
    """Returns a sentence about trees none of which comes to its start; None if one does.

    Runs with such trees often learn all the same: it explains a failure, and foretells none.
    `report`: generation.json, of which of_search() says nothing.
    """
    if config.search.generator not in TREE_GENERATORS or report["starts_reached"]:
        return None
    if heavy := config.heavy_bodies:
        return (
            f"pushes: the robot moves {', '.join(heavy)}; try a denser robot "
            "(task.bodies.0.density), lighter objects, or more physics.force_factor"
        )
    trees = report["trees"]
    deepest = max(node["depth"] for node in report["nodes"])
    room = ", or wider ways between the fixed bodies" if any(config.task.fixed) else ""
    return (
        f"reaching the start: no tree does ({trees} grew, starts_reached is 0), the "
        f"deepest has {deepest} actions; the state nearest to a start has "
        f"{_distances(config.task, report)}; try "
        f"{_search_advice(config, deepest)}, or an easier start{room}"
    )


def of_own_data(data: dict[str, Any]) -> str | None:
    """Returns a sentence about what own data lack; None if they have successes, and starts.

    `data`: that of generation.json.
    """
    count, starts = data["transitions"], data["at_start"]
    if not data["successes"]:
        return f"goal: none of {count:,} transitions reaches it; try data that do"
    if starts < _COVERED * count:
        return (
            f"coverage: {starts:,} of {count:,} transitions begin where episodes do; try data "
            "from there"
        )
    return None


def _learning(config: _core.Config, summary: dict[str, Any]) -> str | None:
    success = summary.get("success_rate")
    if success is None:
        return None
    search, is_own = config.search, bool(summary.get("data"))
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
    if not train.interact:
        return (
            f"learning: success {success:.2f} from the data alone; try interactions "
            "(train.interact=true)"
        )
    more = f"more interactions (train.interactions, {train.interactions:,} now)"
    if train.gradient_steps < _MANY_STEPS:
        more = f"more gradient steps (train.gradient_steps, {train.gradient_steps} now) or {more}"
    return f"learning: success {success:.2f} at the end of the budget; try {more}"


def bottleneck(config: _core.Config, summary: dict[str, Any], report: dict[str, Any]) -> str | None:
    """Returns a sentence about the first stage that falls short; None if all is well.

    `report`: generation.json. Only of runs whose own trees found the data, or that were
    given data.
    """
    own = summary.get("data")
    if summary["transitions"] is None:
        return None
    if not own and config.search.generator not in TREE_GENERATORS:
        return None
    if (summary.get("success_rate") or 0.0) >= _WELL:
        return None
    lacks = of_own_data(own) if own else of_search(config, report) or of_starts(config, report)
    found = lacks or _learning(config, summary)
    return found and f"bottleneck: {found}"
