"""What a run says about the stage that falls short."""

from typing import Any

import numpy as np
import pytest
from rtg import _core, paths
from rtg.run.diagnosis import bottleneck, undrawn_goals

CONFIG = _core.Config.from_file(paths.CONFIG / "gathering.yaml")
GOOD: dict[str, Any] = {
    "transitions": 60_000,
    "trees": 3,
    "candidates": 10_000,
    "pruned": 4_000,
    "converged": 5_500,
    "starts_reached": 2,
    "success_rate": 0.99,
    "q_rank_correlation": 0.8,
}


def node(depth: int, **moved: tuple[float, float]) -> dict[str, Any]:
    """A node of a tree with the start's poses but for those of the bodies `moved`."""
    poses = np.array(CONFIG.task.start)
    for name, by in moved.items():
        poses[CONFIG.task.names.index(name), :2] += by
    return {"poses": poses.tolist(), "depth": depth}


def towards(*away: float) -> dict[str, Any]:
    """A start that no tree reached, with distances of robot and boxes in the nearest state."""
    return {"poses": CONFIG.task.start.tolist(), "depth": None, "away": list(away)}


NODES = [node(3, box1=(3.0, 0.0), box2=(0.3, 0.0)), node(9, box1=(3.0, 0.0), box2=(2.0, 0.0))]
STARTS = [towards(0.1, 5.0, 0.3, 0.0), towards(0.2, 3.0, 0.7, 0.05)]


def found(summary: dict[str, Any], config: _core.Config = CONFIG, **more: Any) -> str | None:
    return bottleneck(config, summary, {**summary, "nodes": NODES, "starts": STARTS, **more})


def said(**figures: Any) -> str:
    words = found({**GOOD, "success_rate": None, **figures})
    assert words is not None and words.startswith("bottleneck: ")
    return words


def test_nothing_is_said_of_a_run_that_is_well_or_has_no_trees() -> None:
    assert found(GOOD) is None
    assert found({**GOOD, "starts_reached": 0}) is None
    assert found({**GOOD, "success_rate": None}) is None  # --no-train
    walks = _core.Config.from_file(paths.CONFIG / "gathering.yaml", ["run.method=ddqn_random"])
    bad = {**GOOD, "trees": 0, "starts_reached": 0, "success_rate": 0.0}
    assert found(bad, walks, nodes=[], starts=[]) is None


def test_of_goal_states_the_draws_in_vain_are_told() -> None:
    words = said(trees=0, undrawn_goals=20, unsettled_goals=3)
    assert "goal states: 20 draws met no goal and 3 states did not come to rest" in words


def test_few_solved_pushes_are_the_first_suspect() -> None:
    assert "reverse solves: 2,000 of 6,000 found a push" in said(converged=2_000, starts_reached=0)


def test_an_object_too_heavy_for_the_robot_is_told_by_check_and_by_runs_that_reach_no_start() -> (
    None
):
    config = _core.Config.from_file(
        paths.CONFIG / "gathering.yaml", ["task.bodies.2.density=40", "task.bodies.3.density=4"]
    )
    heavy = "'box2' by 0.17 of a stride at most"
    assert config.heavy_bodies == [heavy] and CONFIG.heavy_bodies == []
    assert f"a push moves {heavy}: its mass is large" in config.description
    bad = {**GOOD, "success_rate": None, "starts_reached": 0}
    words = found(bad, config)
    assert words is not None and words.startswith(f"bottleneck: pushes: the robot moves {heavy}; ")
    assert found({**bad, "starts_reached": 1}, config) is None


def test_of_a_start_that_is_not_reached_each_object_is_told() -> None:
    words = said(starts_reached=0)
    assert "no tree does (3 grew, starts_reached is 0)" in words
    assert "'box1' 3 m (in one place in all states), 'box2' 0.7 m, 'box3' 0.05 m" in words
    assert "the deepest has 9 actions" in words and "search.transitions" in words


def test_how_near_an_object_came_is_told_in_metres() -> None:
    """One metre of push_t is 1.6 units of poses."""
    config = _core.Config.from_file(paths.CONFIG / "push_t.yaml")
    node = {"poses": config.task.start.tolist(), "depth": 1}
    start = {"poses": config.task.start.tolist(), "depth": None, "away": [0.0, 3.2]}
    summary = {**GOOD, "success_rate": None, "starts_reached": 0}
    words = found(summary, config, nodes=[node], starts=[start])
    assert words is not None and "has 't' 2 m (in one place in all states);" in words


@pytest.mark.parametrize(
    ("depth", "advice"),
    [(59, "search.depth, 100 now, and task.horizon, 60 now"), (9, "search.transitions")],
)
def test_the_advice_is_about_what_ended_the_trees(depth: int, advice: str) -> None:
    figures = {**GOOD, "starts_reached": 0, "success_rate": 0.1}
    words = found(figures, nodes=[*NODES, node(depth)])
    assert words is not None and advice in words


def test_of_learning_the_ranks_come_first_then_the_budget() -> None:
    failed = {"success_rate": 0.4}
    assert "little better than by chance (0.20)" in said(**failed, q_rank_correlation=0.2)
    assert "train.interactions, 350,000 now" in said(**failed)


def test_draws_of_goal_states_in_vain_are_told_with_their_reason_if_they_are_many() -> None:
    why = "task.goal.1 did not hold in 93% of the failed tries"
    draws = {"goal_draws": 600, "undrawn_reason": why}
    assert undrawn_goals({**draws, "undrawn_goals": 29}) is None
    assert undrawn_goals({"goal_draws": None, "undrawn_goals": None}) is None  # own data
    words = undrawn_goals({**draws, "undrawn_goals": 30})
    assert words is not None
    assert words.startswith(f"goal states: 30 of 600 draws met no goal: {why}; ")
    assert f"20 draws met no goal ({why}) and 0 states" in said(
        trees=0, undrawn_goals=20, undrawn_reason=why
    )


def test_more_gradient_steps_are_advised_only_where_there_are_few() -> None:
    few = said(success_rate=0.4)
    assert few == (
        "bottleneck: learning: success 0.40 at the end of the budget; try more gradient steps "
        "(train.gradient_steps, 1 now) or more interactions (train.interactions, 350,000 now)"
    )
    many = _core.Config.from_file(paths.CONFIG / "gathering.yaml", ["train.gradient_steps=4"])
    assert found({**GOOD, "success_rate": 0.4}, many) == (
        "bottleneck: learning: success 0.40 at the end of the budget; try more interactions "
        "(train.interactions, 350,000 now)"
    )


def test_of_own_data_other_data_are_advised_and_no_settings_of_a_search() -> None:
    data = {"transitions": 60_000, "successes": 500, "at_start": 5_000}
    own = {"data": data, "trees": None, "headings_per_state": 1.2, "success_rate": 0.4}
    words = said(**{**own, "data": {**data, "successes": 0}})
    assert words == "bottleneck: goal: none of 60,000 transitions reaches it; try data that do"
    words = said(**{**own, "data": {**data, "at_start": 10}})
    assert words.endswith("10 of 60,000 transitions begin where episodes do; try data from there")
    words = said(**own, q_rank_correlation=0.2)
    assert "data with other headings from the same states (1.2 per state now)" in words
    assert "search." not in words
    assert "more gradient steps" in said(**own)
    assert found({**GOOD, **own, "success_rate": None}) is None  # --no-train
