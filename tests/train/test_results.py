"""The last words of a run."""

from pathlib import Path

import pytest
from rtg import results
from rtg.run_plan import RunPlan


@pytest.mark.parametrize(("success", "told"), [(0.0, True), (0.05, True), (0.6, False)])
def test_data_that_does_not_connect_start_and_goal_is_told(success, told):
    plan = RunPlan(Path("runs/x"), "x", {}, train=False, resume=False, notes=())
    summary = {
        "transitions": 2000,
        "generate_wall_s": 3.0,
        "contact_share": 0.3,
        "tree_policy_success": success,
    }
    assert ("--transitions" in results.words(plan, summary)) == told
