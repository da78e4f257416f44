"""What a run says about the stage that falls short."""

from typing import Any

import numpy as np
import pytest
from rtg import _core, paths
from rtg.run.diagnosis import bottleneck

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
    assert "'box1' 3 m (no step moves it), 'box2' 0.3 m, 'box3' 0 m" in words
    assert "the deepest has 9 actions" in words and "search.patience, 4 now" in words


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
