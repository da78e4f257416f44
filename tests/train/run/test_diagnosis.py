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
    "start_region_depth": 12,
    "start_region_transitions": 5_000,
    "success_rate": 0.99,
    "q_rank_correlation": 0.8,
}


def node(depth: int, **moved: tuple[float, float]) -> dict[str, Any]:
    """A node of a tree with the start's poses but for those of the bodies `moved`."""
    poses = np.array(CONFIG.task.start)
    for name, by in moved.items():
        poses[CONFIG.task.names.index(name), :2] += by
    return {"poses": poses.tolist(), "depth": depth}


NODES = [node(3, box1=(3.0, 0.0), box2=(0.3, 0.0)), node(9, box1=(3.0, 0.0), box2=(2.0, 0.0))]


def said(**figures: Any) -> str:
    words = bottleneck(CONFIG, {**GOOD, "success_rate": None, **figures}, NODES)
    assert words is not None and words.startswith("bottleneck: ")
    return words


def test_nothing_is_said_of_a_run_that_is_well_or_has_no_trees() -> None:
    assert bottleneck(CONFIG, GOOD, NODES) is None
    assert bottleneck(CONFIG, {**GOOD, "start_region_depth": -1}, NODES) is None
    assert bottleneck(CONFIG, {**GOOD, "success_rate": None}, NODES) is None  # --no-train
    walks = _core.Config.from_file(paths.CONFIG / "gathering.yaml", ["run.method=ddqn_random"])
    bad = {**GOOD, "trees": 0, "start_region_depth": -1, "success_rate": 0.0}
    assert bottleneck(walks, bad, []) is None


def test_of_goal_states_the_draws_in_vain_are_told() -> None:
    words = said(trees=0, undrawn_goals=20, unsettled_goals=3)
    assert "goal states: 20 draws met no goal and 3 states did not come to rest" in words


def test_few_solved_pushes_are_the_first_suspect() -> None:
    assert "reverse solves: 2,000 of 6,000 found a push" in said(
        converged=2_000, start_region_depth=-1
    )


def test_of_a_start_that_is_not_reached_each_object_is_told() -> None:
    words = said(start_region_depth=-1)
    assert "'box1' 3 m (in one place in all states), 'box2' 0.3 m, 'box3' 0 m" in words
    assert "the deepest has 9 actions" in words and "search.patience, 4 now" in words


def of_ranges(text: str, *places: dict[int, tuple[float, float]]) -> str:
    """What is said of the task of `text` with nodes at `places` [m], by body."""
    config = _core.Config.from_text(text)
    nodes = []
    for place in places:
        poses = np.array(config.task.start)
        for body, at in place.items():
            poses[body, :2] = np.multiply(at, config.task.metre)
        nodes.append({"poses": poses.tolist(), "depth": 1})
    words = bottleneck(config, {**GOOD, "success_rate": None, "start_region_depth": -1}, nodes)
    assert words is not None
    return words


def test_an_object_that_starts_in_ranges_is_as_far_off_as_its_region() -> None:
    """Push-T's T starts with x and y from -5 to 5 m, and one metre is 1.6 units of poses."""
    text = (paths.CONFIG / "push_t.yaml").read_text()
    assert "'t' 2 m (in one place in all states);" in of_ranges(text, {1: (1.0, -7.0)})
    assert "'t' 0 m;" in of_ranges(text, {1: (7.0, 0.0)}, {1: (-4.9, 4.9)})


@pytest.mark.parametrize(
    ("start", "away"),
    [
        ("{disc: {centre: [-3, 1], radius: 1}}", 3.0),
        ("{polygon: [[-4, 0], [-2, 0], [-2, 2], [-4, 2]]}", 3.0),
        ("{polygon: [[-4, -1], [-2, 1], [-4, 3]]}", 2.1),  # 3 / √2 from an edge
    ],
)
def test_regions_of_starts_may_have_any_shape(start: str, away: float) -> None:
    text = (paths.CONFIG / "gathering.yaml").read_text()
    ranged = text.replace("start: [-3.0, 1.13, 0.2]", f"start: {{in: {start}}}")
    assert f"'box1' {away:.2g} m (in one" in of_ranges(ranged, {1: (1.0, 1.0)})
    assert "'box1' 0 m, 'box2' 0 m" in of_ranges(ranged, {1: (-2.5, 1.0)})


def test_nothing_is_said_of_bodies_that_hang_on_one_with_ranges() -> None:
    """Where they start depends on the draw."""
    text = (paths.CONFIG / "art_manip.yaml").read_text()
    ranged = text.replace("[-3.6, 0.0, 0.0]", "{x: [-4.6, -2.6], y: [-1, 1], theta: 0}")
    words = of_ranges(ranged, {1: (-3.0, 5.0)})
    assert "nearest to their starts came 'link1' 4 m (in one place in all states); try" in words


@pytest.mark.parametrize(
    ("trees", "depth", "advice"),
    [
        (3, 59, "search.depth, 100 now, and task.horizon, 60 now"),
        (1, 9, "search.transitions"),
        (5, 9, "search.breadth"),
    ],
)
def test_the_advice_is_about_what_ended_the_trees(trees: int, depth: int, advice: str) -> None:
    figures = {**GOOD, "start_region_depth": -1, "trees": trees, "success_rate": 0.1}
    words = bottleneck(CONFIG, figures, [*NODES, node(depth)])
    assert words is not None and advice in words


def test_of_learning_coverage_comes_first_then_the_ranks_then_the_budget() -> None:
    failed = {"success_rate": 0.4}
    assert "coverage: 10 of 60,000" in said(**failed, start_region_transitions=10)
    assert "little better than by chance (0.20)" in said(**failed, q_rank_correlation=0.2)
    assert "train.interactions, 350,000 now" in said(**failed)


def test_draws_of_goal_states_in_vain_are_told_with_their_reason_if_they_are_many() -> None:
    why = "task.goal.1 did not hold in 93% of the tries"
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
    assert bottleneck(many, {**GOOD, "success_rate": 0.4}, NODES) == (
        "bottleneck: learning: success 0.40 at the end of the budget; try more interactions "
        "(train.interactions, 350,000 now)"
    )


def test_of_own_data_other_data_are_advised_and_no_settings_of_a_search() -> None:
    data = {"transitions": 60_000, "successes": 500}
    own = {"data": data, "trees": None, "headings_per_state": 1.2, "success_rate": 0.4}
    words = said(**{**own, "data": {**data, "successes": 0}})
    assert words == "bottleneck: goal: none of 60,000 transitions reaches it; try data that do"
    words = said(**own, start_region_transitions=10)
    assert words.endswith("10 of 60,000 transitions begin where episodes do; try data from there")
    words = said(**own, q_rank_correlation=0.2)
    assert "data with other headings from the same states (1.2 per state now)" in words
    assert "search." not in words
    assert "more gradient steps" in said(**own)
    assert bottleneck(CONFIG, {**GOOD, **own, "success_rate": None}, []) is None  # --no-train
