"""Layouts of tasks: the places and angles of their objects."""

from typing import Any

import numpy as np
import pytest
from rtg import _core, paths
from rtg.envs import layouts as module
from rtg.envs.layouts import MAX_LAYOUTS, TOLERANCE, Layouts

TASK = _core.Config.from_file(paths.CONFIG / "gathering.yaml").task
BOXES = Layouts(TASK)
CHAIN_TASK = _core.Config.from_file(paths.CONFIG / "art_manip.yaml").task
CHAIN = Layouts(CHAIN_TASK)
UNIT = TASK.position_unit  # [m], CHAIN_TASK's too


def moved(state: np.ndarray, **by: tuple[int, float]) -> np.ndarray:
    """The layout of the state with `x`, `y` or `theta` of a body changed: (body, by). [size]"""
    changed = state.copy()
    for name, (body, amount) in by.items():
        changed[body, ("x", "y", "theta").index(name)] += amount
    task, layouts = (TASK, BOXES) if len(state) == TASK.bodies else (CHAIN_TASK, CHAIN)
    return layouts.of(task.observation(changed[None]))[0]


def test_a_layout_is_where_objects_are_and_how_jointed_ones_are_turned() -> None:
    assert (BOXES.size, CHAIN.size) == (6, 16)
    boxes = BOXES.of(TASK.observation(TASK.start[None]))
    np.testing.assert_array_equal(boxes[0], np.float32(TASK.start[1:, :2].ravel() / UNIT))
    state = CHAIN_TASK.goal_state(1)
    x, y, theta = state[1:].T
    expected = np.concatenate(
        (np.stack((x, y), 1).ravel() / UNIT, np.stack((np.cos(theta), np.sin(theta)), 1).ravel())
    )
    found = CHAIN.of(CHAIN_TASK.observation(state[None]))[0]
    np.testing.assert_array_equal(found, expected.astype(np.float32))


def test_fixed_bodies_are_no_part_of_a_layout() -> None:
    wall = "{name: wall, kind: wall, shape: {box: [1, 1]}, fixed: true, start: [6, 6, 0]}"
    text = (paths.CONFIG / "gathering.yaml").read_text()
    first = "    - {name: box1"
    task = _core.Config.from_text(text.replace(first, f"    - {wall}\n{first}")).task
    assert task.bodies == 5
    found = Layouts(task).of(task.observation(task.start[None]))
    np.testing.assert_array_equal(found[0], np.float32(task.start[2:, :2].ravel() / UNIT))


@pytest.mark.parametrize("body", [1, 2, 3])
def test_a_layout_is_near_where_no_object_is_half_a_metre_off(body: int) -> None:
    start = TASK.start
    assert BOXES.near(moved(start), moved(start, x=(body, -0.49), theta=(body, 2.0)))
    assert not BOXES.near(moved(start), moved(start, x=(body, -0.51)))
    assert not BOXES.near(moved(start), moved(start, x=(body, 0.37), y=(body, 0.37)))


@pytest.mark.parametrize("body", [1, 4])
def test_a_layout_of_a_chain_is_near_where_its_links_are_turned_alike_too(body: int) -> None:
    state = CHAIN_TASK.start
    assert CHAIN.near(moved(state), moved(state, theta=(body, 0.04), x=(body, 0.45)))
    for turn in (0.06, -0.06, np.pi):
        assert not CHAIN.near(moved(state), moved(state, theta=(body, turn)))
    assert CHAIN.near(moved(state), moved(state, theta=(body, 2 * np.pi)))


def test_the_network_sees_how_far_objects_are_from_what_is_asked_for() -> None:
    state = CHAIN_TASK.goal_state(1)
    seen = CHAIN_TASK.observation(state[None])
    goal = moved(state, x=(2, 0.8), y=(3, -1.6), theta=(4, 0.3))
    asked = CHAIN.network_input(seen, goal[None])
    assert asked.dtype == np.float32 and asked.shape == (1, CHAIN_TASK.observation_size + 16)
    np.testing.assert_array_equal(asked[:, :-16], seen)
    turn = [1, 0, 1, 0, 1, 0, np.cos(0.3), np.sin(0.3)]
    np.testing.assert_allclose(asked[0, -16:], [0, 0, 0.2, 0, 0, -0.4, 0, 0, *turn], atol=1e-6)


def test_layouts_of_the_task_stay_goals_where_all_objects_are_a_little_off() -> None:
    """The disc's radius is 2.0 m; within it are most draws, but few layouts stay within by 0.5."""
    radius = np.linalg.norm(UNIT * BOXES.goal_layouts.reshape(-1, 3, 2), axis=2)
    assert 300 < len(BOXES.goal_layouts) <= MAX_LAYOUTS and radius.max() < 1.6
    assert 300 < len(CHAIN.goal_layouts) <= MAX_LAYOUTS
    centre = UNIT * CHAIN.goal_layouts[:, :8].reshape(-1, 4, 2).mean(axis=1)
    assert np.linalg.norm(centre - (0.0, 3.0), axis=1).max() < 0.6
    turns = np.diff(np.arctan2(CHAIN.goal_layouts[:, 9::2], CHAIN.goal_layouts[:, 8::2]), axis=1)
    off = np.abs(np.abs(np.angle(np.exp(1j * turns))) - np.pi / 2)
    assert off.max() < 0.263 - 2 * module.JOINT_TOLERANCE  # joints may be 15 degrees off
    np.testing.assert_array_equal(Layouts(TASK).goal_layouts, BOXES.goal_layouts)


def test_the_bodies_of_a_joint_turn_against_each_other_in_any_order_of_the_joints() -> None:
    lines = (paths.CONFIG / "art_manip.yaml").read_text().splitlines(keepends=True)
    at = [k for k, line in enumerate(lines) if "{parent: " in line]
    assert len(at) == 3
    lines[at[0]], lines[at[2]] = lines[at[2]], lines[at[0]]
    reordered = _core.Config.from_text("".join(lines)).task
    assert [joint[:2] for joint in reordered.joints] == [(3, 4), (2, 3), (1, 2)]
    for task in (CHAIN_TASK, reordered):
        np.testing.assert_array_equal(module._sides(task), [0, 1, -1, 1, -1])


def test_a_goal_state_is_robust_if_it_holds_a_little_further_on() -> None:
    states = np.stack([TASK.goal_state(1, k) for k in range(50)])
    still = np.zeros(TASK.bodies)
    assert 0 < len(module.robust_goal_states(TASK, states, TOLERANCE, still)) < 50
    assert len(module.robust_goal_states(TASK, states, 4.0, still)) == 0


def test_layouts_know_the_angles_of_loose_bodies_that_a_goal_asks_for() -> None:
    task = _core.Config.from_file(paths.CONFIG / "push_t.yaml").task
    layouts = Layouts(task)
    assert layouts.size == 4 and 0.0 < layouts.tolerance < TOLERANCE
    assert layouts.turns == module.ANGLE_TOLERANCE * layouts.tolerance / TOLERANCE
    target = np.array([0, 0, np.sqrt(0.5), np.sqrt(0.5)])
    assert np.abs(layouts.goal_layouts - target).max() < 0.2
    goal = task.goal_state(1)
    turned, aside = goal.copy(), goal.copy()
    turned[1, 2] += 1.01 * layouts.turns[0]
    aside[1, 0] += 1.01 * layouts.tolerance
    here, there, off = layouts.of(task.observation(np.stack([goal, turned, aside])))
    assert layouts.near(here, here)
    assert not layouts.near(here, there) and not layouts.near(here, off)


def moved_within(layouts: Layouts, task: _core.Task, count: int) -> np.ndarray:
    """States near each layout, of objects that all have angles. [layouts, count, bodies, 3]

    Each object is moved and turned at random, by up to the tolerances.
    """
    movable = [body for body in range(1, task.bodies) if not task.fixed[body]]
    objects, rng = len(movable), np.random.default_rng(1)
    goals = np.float64(layouts.goal_layouts)
    states = np.tile(task.start, (len(goals), count, 1, 1))
    turned = goals[:, 2 * objects :].reshape(-1, objects, 2)
    states[:, :, movable, :2] = task.position_unit * goals[:, None, : 2 * objects].reshape(
        -1, 1, objects, 2
    )
    states[:, :, movable, 2] = np.arctan2(turned[..., 1], turned[..., 0])[:, None]
    shape = (len(goals), count, objects)
    way, angle = (
        0.999 * layouts.tolerance * np.sqrt(rng.random(shape)),
        2 * np.pi * rng.random(shape),
    )
    states[:, :, movable, 0] += way * np.cos(angle)
    states[:, :, movable, 1] += way * np.sin(angle)
    states[:, :, movable, 2] += 0.999 * layouts.turns * rng.uniform(-1, 1, shape)
    return states


def test_who_reaches_a_layout_of_boxes_that_touch_nearly_always_succeeds(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each box moves on its own; so gaps open by up to twice the tolerance."""
    monkeypatch.setattr(module, "FIRST_DRAWS", 60)  # each takes 20 ms
    monkeypatch.setattr(module, "MAX_DRAWS", 60)
    task = _core.Config.from_file(paths.CONFIG / "pack.yaml").task
    layouts = Layouts(task)
    assert layouts.size == 12  # three boxes, whose angles the goal asks for
    assert len(layouts.goal_layouts) > 30
    states = moved_within(layouts, task, 100)
    reached = layouts.of(task.observation(states.reshape(-1, task.bodies, 3)))
    assert layouts.near(reached, np.repeat(layouts.goal_layouts, 100, axis=0)).all()
    assert task.succeeded(states.reshape(-1, task.bodies, 3)).mean() > 0.99


class Counted:
    """A task that counts the goal states that are drawn of it."""

    def __init__(self, task: _core.Task) -> None:
        self.task, self.draws = task, 0

    def __getattr__(self, name: str) -> Any:
        return getattr(self.task, name)

    def goal_state(self, seed: int, index: int) -> np.ndarray | None:
        self.draws += 1
        return self.task.goal_state(seed, index)


@pytest.mark.parametrize(("most", "draws"), [(50, 200), (100, 400), (MAX_LAYOUTS, 2800)])
def test_goal_states_are_drawn_until_enough_are_robust(
    monkeypatch: pytest.MonkeyPatch, most: int, draws: int
) -> None:
    """Of Sorting's 37 % are. The layouts are those of the first robust draws, however many."""
    monkeypatch.setattr(module, "MAX_LAYOUTS", most)
    task = Counted(_core.Config.from_file(paths.CONFIG / "sorting.yaml").task)
    layouts = Layouts(task)
    assert len(layouts.goal_layouts) == most and task.draws == draws
    states = np.stack([task.task.goal_state(module.LAYOUT_SEED, k) for k in range(draws)])
    robust = module.robust_goal_states(task.task, states, TOLERANCE, np.zeros(task.bodies))
    expected = layouts.of(task.observation(robust[:most]))
    np.testing.assert_array_equal(layouts.goal_layouts, expected)


def test_fixed_bodies_stay_where_goal_states_are_tried_for_robustness() -> None:
    """The drawer is to be 1.7 to 2.2 m out of its cabinet, which does not come along."""
    task = _core.Config.from_file(paths.CONFIG / "drawer.yaml").task
    states = np.stack([task.goal_state(1, k) for k in range(50)])
    still = np.zeros(task.bodies)
    assert len(module.robust_goal_states(task, states, 0.26 * task.metre, still)) == 0
    assert len(module.robust_goal_states(task, states, 0.05 * task.metre, still)) > 0


def test_the_nearest_layout_has_the_shortest_way_of_all_objects() -> None:
    starts = np.stack([TASK.jittered_start(1.0, 3, k) for k in range(5)])
    found = BOXES.nearest(TASK.observation(starts))
    among = np.array([7, 100, 200])
    of_few = BOXES.nearest(TASK.observation(starts), among)
    for start, one, other in zip(starts, found, of_few, strict=True):
        ways = [
            sum(np.hypot(*(UNIT * goal[2 * k : 2 * k + 2] - start[k + 1, :2])) for k in range(3))
            for goal in BOXES.goal_layouts
        ]
        np.testing.assert_array_equal(one, BOXES.goal_layouts[np.argmin(ways)])
        k = among[np.argmin([ways[k] for k in among])]
        np.testing.assert_array_equal(other, BOXES.goal_layouts[k])
