"""Depths and plans of steps on a line: the robot walks from x = 4 to success beyond x = 0."""

import numpy as np
from rtg.files.dataset import Rows
from rtg.view.step_tree import StepTree


def steps(*xs, last=False):
    """Steps that begin at `xs` and lead 1 m to the left; the last one succeeds if `last`."""
    poses = np.zeros((len(xs), 2, 3))
    poses[:, 0, 0] = xs
    after = poses.copy()
    after[:, 0, 0] -= 1.0
    done = np.zeros(len(xs), bool)
    done[-1] = last
    count = len(xs)
    return Rows(
        poses, np.zeros(count, np.int32), after, done.astype(np.float32), done, np.zeros(count)
    )


def test_the_depth_counts_the_steps_to_success():
    tree = StepTree(bodies=2)
    assert tree.add(steps(1.0, last=True)).tolist() == [0]
    assert tree.add(steps(2.1)).tolist() == [1]  # ends 0.1 m from the start of the first
    assert tree.add(steps(4.0, 3.0)).tolist() == [2, 3]  # stored in the order of their plan
    assert tree.depths.tolist() == [1, 2, 4, 3]


def test_a_plan_goes_from_a_step_to_success():
    tree = StepTree(bodies=2)
    tree.add(steps(1.0, last=True))
    tree.add(steps(3.0, 2.1))
    assert np.allclose(tree.plan(1)[:, 0, 0], [3.0, 2.1, 1.0, 0.0])
    assert np.allclose(tree.plan(0)[:, 0, 0], [1.0, 0.0])


def test_a_step_waits_for_one_that_comes_later():
    tree = StepTree(bodies=2)
    assert tree.add(steps(2.0)).tolist() == []
    assert tree.add(steps(1.0, last=True)).tolist() == [0, 1]
    assert tree.depths.tolist() == [2, 1]


def test_a_step_that_leads_nowhere_has_no_depth_after_three_tries_or_at_the_end():
    tree = StepTree(bodies=2)
    assert tree.add(steps(9.0)).tolist() == []
    assert tree.add(steps(1.0, last=True)).tolist() == [1]
    assert tree.add(steps(2.0, 7.0)).tolist() == [0, 2]
    assert tree.rest().tolist() == [3] and tree.rest().tolist() == []
    assert tree.depths.tolist() == [0, 1, 2, 0]


def test_no_step_follows_one_that_ends_half_a_metre_off():
    tree = StepTree(bodies=2)
    tree.add(steps(1.0, last=True))
    tree.add(steps(2.49, 2.51))
    tree.rest()
    assert tree.depths.tolist() == [1, 2, 0]


def test_depths_of_a_search_do_not_depend_on_how_its_steps_are_divided(rows):
    chosen = rows.source != 1
    kept = Rows(*(column[chosen] for column in rows))
    whole, parts = StepTree(kept.poses.shape[1]), StepTree(kept.poses.shape[1])
    settled = [*whole.add(kept), *whole.rest()]
    assert sorted(settled) == list(range(len(kept.action)))
    for k in range(0, len(kept.action), 25):
        parts.add(kept.slice(k, k + 25))
    assert whole.depths.max() > 3
    assert (whole.depths > 0).mean() > 0.9
    assert (parts.depths == whole.depths).mean() > 0.8
