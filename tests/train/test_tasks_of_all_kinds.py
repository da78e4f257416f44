"""Tasks at the edge of what is legal: what the core makes of them."""

import math

import numpy as np
import pytest
from rtg import _core

HEXAGON = "{regular: {sides: 6, radius: 0.8}}"
ROBOT = f"{{name: robot, kind: robot, shape: {HEXAGON}, start: [0, -6, 0]}}"


def config(bodies: list[str], goal: list[str], more: str = "", robot: str = ROBOT) -> _core.Config:
    lines = ["task:", "  name: x", "  bodies:"]
    lines += [f"    - {body}" for body in (robot, *bodies)]
    lines += ["  goal:", *(f"    - {term}" for term in goal), more]
    return _core.Config.from_text("\n".join(lines))


def star(count: int, inner: float) -> list[list[float]]:
    radii = [1.5 if k % 2 else inner for k in range(count)]
    angles = [2.0 * math.pi * k / count for k in range(count)]
    return [
        [round(r * math.cos(a), 4), round(r * math.sin(a), 4)]
        for r, a in zip(radii, angles, strict=True)
    ]


@pytest.mark.parametrize("count", [10, 12, 16, 20])
@pytest.mark.parametrize("inner", [0.6, 0.9, 1.2])
def test_what_is_written_of_a_polygon_is_read_back(count: int, inner: float) -> None:
    body = f"{{name: a, kind: a, shape: {{vertices: {star(count, inner)}}}, start: [5, 0, 0]}}"
    one = config([body], ["{kind: a, disc: {centre: [0, 0], radius: 2}}"])
    assert _core.Config.from_text(one.yaml).yaml == one.yaml


def test_a_density_that_is_not_given_is_that_of_the_robot() -> None:
    heavy = ROBOT.replace("start", "density: 5000, start")
    body = "{name: a, kind: a, shape: {box: [1, 1]}, start: [5, 0, 0]}"
    one = config([body], ["{kind: a, disc: {centre: [0, 0], radius: 2}}"], robot=heavy)
    assert one.yaml.count("density: 5000.0") == 2
    assert _core.Config.from_text(one.yaml).yaml == one.yaml


BASE = "{name: base, kind: base, shape: {box: [1.2, 1.2]}, start: [0, 0, 0]}"
TRAY = "{name: tray, kind: tray, shape: {box: [1.2, 0.6]}, start: [1.5, 0, 0]}"
SLIDER = (
    "  joints: [{type: prismatic, parent: base, child: tray, axis: [1, 0], limits: [0, 1]}]\n"
    "  start_jitter: 0.5"
)


def test_a_drawer_is_shifted_together_with_what_it_slides_on() -> None:
    task = config([BASE, TRAY], ["{joint: tray, slides: [0.6, 1]}"], SLIDER).task
    starts = np.stack([task.jittered_start(0.5, 1, k) for k in range(50)])
    slides = starts[:, 2] - starts[:, 1]
    np.testing.assert_allclose(slides, [[1.5, 0.0, 0.0]] * 50, atol=1e-6)
    assert np.ptp(starts[:, 1, 0]) > 0.5


def test_starts_with_joints_are_in_the_start_region() -> None:
    base = BASE.replace("[0, 0, 0]}", "{x: [-4, 4], y: [-3, 4], theta: [-1, 1]}}")
    joint = (
        "  joints: [{parent: base, child: tray, on_parent: [0.7, 0], on_child: [-0.6, 0], "
        "limits: [-1, 1]}]"
    )
    task = config(
        [base, TRAY.replace("[1.5, 0, 0]", "[1.3, 0.5, 0]")],
        ["{joint: tray, angles: [0.6, 1]}"],
        joint,
    ).task
    starts = np.stack([task.jittered_start(0.1, 1, k) for k in range(50)])
    assert task.in_start_region(starts).all()
    swung = starts.copy()
    swung[:, 2, 2] += 0.9
    assert not task.in_start_region(swung).any()


def test_the_order_of_terms_does_not_matter() -> None:
    vase = "{name: vase, kind: vase, shape: {box: [1.2, 0.6]}, start: [0, 0, 0]}"
    terms = ["{kind: vase, angle: [1.4, 1.75]}", "{kind: vase, stays: 0.3}"]
    for goal in (terms, terms[::-1]):
        state = config([vase], goal).task.goal_state(1)
        assert state is not None and 1.4 <= state[1, 2] % math.pi <= 1.75


BOX = "{name: a, kind: a, shape: {box: [1, 1]}, start: [5, 0, 0]}"
OTHER = "{name: b, kind: a, shape: {box: [1, 1]}, start: [5, 3, 0]}"


@pytest.mark.parametrize(
    "term",
    [
        "{kind: a, polygon: [[-2, -2], [2, -2], [2, 1.99], [1.99, 2], [-2, 2]]}",  # a short edge
        "{kind: a, angle: [-0.745, 0.745], not: true}",  # leaves 0.08 rad
        "{kind: a, apart: a, gap: 0.03, not: true}",  # touching bodies are 0.02 m apart
    ],
)
def test_margins_of_goal_states_leave_room_where_there_is_little(term: str) -> None:
    task = config([BOX, OTHER], [term]).task
    states = [task.goal_state(seed) for seed in range(5)]
    assert all(state is not None for state in states)
    assert task.succeeded(np.stack(states)).all()


def test_a_policy_is_of_one_place_to_stay_and_of_one_zero_of_a_drawer() -> None:
    vases = [BOX.replace("[5, 0, 0]", start) for start in ("[5, 0, 0]", "[5, -4, 0]")]
    stays = ["{kind: a, stays: 0.3}", "{kind: b, disc: {centre: [0, 0], radius: 1}}"]
    other = OTHER.replace("kind: a", "kind: b")
    assert len({config([vase, other], stays).task.content for vase in vases}) == 2
    moves = ["{kind: a, disc: {centre: [0, 0], radius: 1}}", stays[1]]
    assert len({config([vase, other], moves).task.content for vase in vases}) == 1
    trays = [TRAY, TRAY.replace("1.5", "2.0")]
    goal = ["{joint: tray, slides: [0.6, 1]}"]
    assert len({config([BASE, tray], goal, SLIDER).task.content for tray in trays}) == 2


@pytest.mark.parametrize(("shape", "entries"), [(HEXAGON, 4), ("{disc: 0.8}", 2)])
def test_the_angle_of_a_robot_is_observed_where_it_differs(shape: str, entries: int) -> None:
    anywhere = "{in: {disc: {centre: [0, -6], radius: 1}}, theta: [-3, 3]}"
    robot = f"{{name: robot, kind: robot, shape: {shape}, start: {anywhere}}}"
    task = config([BOX], ["{kind: a, disc: {centre: [0, 0], radius: 2}}"], robot=robot).task
    assert task.robot_entries == entries and task.observation_size == entries + 6
    state = task.jittered_start(0.0, 1)[None]
    turned = state.copy()
    turned[0, 0, 2] += 0.5
    differs = np.flatnonzero(task.observation(state)[0] != task.observation(turned)[0])
    assert differs.tolist() == ([2, 3] if entries == 4 else [])


def test_without_an_angle_objects_start_at_any_and_the_robot_at_none() -> None:
    area = "{in: {disc: {centre: [0, -6], radius: 1}}}"
    robot = f"{{name: robot, kind: robot, shape: {HEXAGON}, start: {area}}}"
    box = BOX.replace("[5, 0, 0]", "{x: [3, 5], y: 0}")
    task = config([box], ["{kind: a, disc: {centre: [0, 0], radius: 2}}"], robot=robot).task
    starts = np.stack([task.jittered_start(0.0, 1, k) for k in range(50)])
    assert np.ptp(starts[:, 1, 2]) > 5.0 and (starts[:, 0, 2] == 0.0).all()
