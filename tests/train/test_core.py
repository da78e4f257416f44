"""The bindings against the stub and against each other."""

import ast
import json
from pathlib import Path

import numpy as np
import pytest
import scaled
from rtg import _core, paths

CONFIG = _core.Config.from_file(paths.CONFIG / "gathering.yaml")
TASK = CONFIG.task


def test_everything_in_the_core_is_documented_in_its_stub() -> None:
    tree = ast.parse((Path(_core.__file__).parent / "_core.pyi").read_text())
    named = {n.name: n for n in tree.body if isinstance(n, ast.ClassDef | ast.FunctionDef)}
    values = {
        "METHODS",
        "GENERATORS",
        "SOURCES",
        "SOLVE_STATUSES",
        "MAX_GRADIENT_NORM",
        "PROCESSOR",
        "BOX2D_VERSION",
        "SETTLE",
    }
    assert {name for name in vars(_core) if not name.startswith("_")} == {*named, *values}
    members = {
        f"{name}.{member.name}": member
        for name, one in named.items()
        for member in one.body
        if isinstance(member, ast.FunctionDef) and not member.name.startswith("__")
    }
    assert len(members) > 150
    silent = [name for name, one in {**named, **members}.items() if not ast.get_docstring(one)]
    assert silent == []


def test_sections_of_the_configuration_have_the_values_of_its_text() -> None:
    values = json.loads(CONFIG.json)
    for name in ("physics", "forward", "reverse", "search", "train", "run"):
        section = getattr(CONFIG, name)
        found = {key: getattr(section, key) for key in dir(section) if not key.startswith("_")}
        assert found and found == values[name]
        assert {type(found[key]) for key in found} <= {bool, int, float, str}
        assert [type(found[key]) for key in values[name]] == [*map(type, values[name].values())]


def test_observation_is_the_documented_one() -> None:
    poses = TASK.start + np.arange(12).reshape(4, 3) / 100
    robot, expected = poses[0], [*(poses[0, :2] / 4)]  # half the arena, half a stride
    for x, y, theta in poses[1:]:
        expected += [x / 4, y / 4, np.cos(theta), np.sin(theta)]
        expected += [x - robot[0], y - robot[1]]
    assert TASK.position_unit == 4.0
    np.testing.assert_allclose(TASK.observation(poses[None])[0], expected, atol=1e-7)


def test_success_is_the_goal_term_drawn_in_pictures() -> None:
    (mark,) = TASK.goal_marks
    centre, radius = mark.ring.mean(axis=0), np.linalg.norm(mark.ring[0])
    rng = np.random.default_rng(0)
    states = np.repeat(TASK.start[None], 500, 0)
    states[:, 1:, :2] = rng.uniform(-2.2, 2.2, (500, 3, 2))
    inside = np.linalg.norm(states[:, 1:, :2] - centre, axis=2) <= radius
    expected = inside.all(axis=1)
    assert 0.1 < expected.mean() < 0.9
    np.testing.assert_array_equal(TASK.succeeded(states), expected)


def test_a_body_has_moved_if_its_place_is_another() -> None:
    """In the units of the task, so that its size is of no matter."""
    for scale in (1.0, 1 / 20):
        task = scaled.gathering(scale).task
        before = np.repeat(task.start[None], 2, axis=0)
        after = before.copy()
        after[0, 1:, 0] += 0.049, 0.051, 0.0
        after[0, 3, 2] += 3.0
        after[1, :, 1] -= 1.0
        assert task.moved(before, after).tolist() == [[False, False, True, False], [True] * 4]
    with pytest.raises(ValueError, match="states of 3 bodies; legal: 4"):
        TASK.moved(before, after[:, :3].copy())
    with pytest.raises(ValueError, match="2 states but 1 next states; legal: equally many"):
        TASK.moved(before, after[:1])


@pytest.mark.parametrize(
    ("name", "settings"), [("push_t", []), ("gathering", ["task.push.strides=[0.5,1.0]"])]
)
def test_the_way_of_an_action_is_that_of_a_robot_that_meets_nothing(
    name: str, settings: list[str]
) -> None:
    """Also of a task in other units, and with several strides."""
    config = _core.Config.from_file(paths.CONFIG / f"{name}.yaml", settings)
    actions = np.arange(0, config.task.actions, 5)
    starts = np.repeat(config.task.start[None], len(actions), axis=0)
    starts[:, 0, :2] = 0.7 * config.task.arena
    after, ok = _core.Simulator(config).push(starts, actions)
    free = ok & (np.abs(after[:, 1:] - starts[:, 1:]).max(axis=(1, 2)) == 0)
    free &= (np.abs(after[:, 0, :2]) < 0.95 * config.task.arena).all(axis=1)
    assert free.sum() > 5
    way = (after - starts)[:, 0, :2]
    np.testing.assert_allclose(way[free], config.task.ways(actions)[free], atol=1e-4)


def test_an_action_that_the_task_lacks_has_no_way() -> None:
    for wrong in (-1, TASK.actions):
        with pytest.raises(ValueError, match=f"action {wrong}; legal: 0 to 47"):
            TASK.ways(np.array([0, wrong]))


def test_joints_are_reached_where_each_goal_of_theirs_is_met() -> None:
    goal = "task.goal=[{joint: link2, angles: [1.0, 1.5]}, {joint: link3, angles: [-1.5, -1.0]}]"
    task = _core.Config.from_file(paths.CONFIG / "art_manip.yaml", [goal]).task
    straight = task.start[None]
    assert task.joints_reached(straight) == [False, False, False]
    bent = straight.copy()
    bent[0, 2:, 2] += 1.2  # the first joint by 1.2, the others by none
    assert task.joints_reached(bent) == [True, False, False]


def test_a_plan_says_how_many_pushes_its_search_made() -> None:
    settings = ["run.method=planner", "search.forward_breadth=4", "search.depth=3"]
    config = _core.Config.from_file(paths.CONFIG / "gathering.yaml", settings)
    states, pushes = _core.plan(config, config.task.start[None])
    np.testing.assert_array_equal(states, config.task.start[None])  # it found no plan
    assert pushes == 48 * (1 + 4 + 4)


def test_pushes_of_a_batch_do_not_depend_on_each_other() -> None:
    simulator = _core.Simulator(CONFIG)
    rng = np.random.default_rng(1)
    states, actions = np.repeat(TASK.start[None], 64, 0), rng.integers(48, size=64)
    for _ in range(5):
        states, ok = simulator.push(states, actions)
        assert ok.all()
    together, _ = simulator.push(states, actions)
    order = rng.permutation(64)
    apart = np.empty_like(together)
    for k in order:
        apart[k] = simulator.push(states[k : k + 1], actions[k : k + 1])[0][0]
    np.testing.assert_array_equal(apart, together)


@pytest.mark.parametrize(
    ("bodies", "actions", "wrong"),
    [
        (4, [-1], "legal: 0 to 47"),
        (4, [48], "legal: 0 to 47"),
        (4, [0, 47], "1 states but 2 actions; legal: one action per state"),
        (3, [0], "3 bodies"),
    ],
)
def test_pushes_that_do_not_fit_the_task_are_refused(
    bodies: int, actions: list[int], wrong: str
) -> None:
    with pytest.raises(ValueError, match=wrong):
        _core.Simulator(CONFIG).push(TASK.start[None, :bodies], np.array(actions))


def test_arrays_outlive_the_call() -> None:
    kept = [_core.Config.from_file(paths.CONFIG / "gathering.yaml").task.start for _ in range(100)]
    assert all(np.array_equal(start, TASK.start) for start in kept)


@pytest.mark.parametrize(
    ("settings", "evaluation", "training"),
    [
        ((), 0.1, 0.3),
        (("train.randomise=true",), 0.7, 0.7),
        (("train.randomise=true", "train.start_jitter=0.9"), 0.7, 0.9),
    ],
)
def test_randomise_widens_the_jitter_of_starts(
    settings: tuple[str, ...], evaluation: float, training: float
) -> None:
    base = ("task.start_jitter=0.1", "task.randomisation=0.7", "train.start_jitter=0.3")
    config = _core.Config.from_file(paths.CONFIG / "gathering.yaml", [*base, *settings])
    assert (config.evaluation_jitter, config.training_jitter) == (evaluation, training)


def test_the_learner_discounts_as_the_task_does_unless_told() -> None:
    settings = ["task.discount=0.7", "train.discount=0"]
    config = _core.Config.from_file(paths.CONFIG / "gathering.yaml", settings)
    assert config.learner_discount == 0.7
    settings[1] = "train.discount=0.9"
    config = _core.Config.from_file(paths.CONFIG / "gathering.yaml", settings)
    assert config.learner_discount == 0.9


def test_the_start_region_is_that_of_objects_within_reach_of_a_start() -> None:
    ranged = "task.bodies.1.start={x: [-5, -2], y: [0, 3], theta: [-0.5, 0.5]}"
    for settings, inside, outside in (
        ([], (0.3, 0.2), (0.3, 0.3)),
        ([ranged], (1.3, 2.2), (1.5, 2.2)),
    ):
        task = _core.Config.from_file(paths.CONFIG / "gathering.yaml", settings).task
        states = np.repeat(TASK.start[None], 2, 0)
        states[:, 1, :2] += np.array([inside, outside])
        states[:, 0] += 3.0
        assert task.in_start_region(states).tolist() == [True, False]
