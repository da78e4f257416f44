"""MuJoCo as a forward simulator, beside Box2D."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import rtg
from numpy.typing import NDArray
from rtg import _core

pytest.importorskip("mujoco", reason="the extra `mujoco` is not installed")


def meeting_pushes(task: rtg.Task, count: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """States on the way of random walks that seek contact, and pushes there."""
    box2d = rtg.forward.Box2D(task)
    states = np.stack([task.start(seed) for seed in range(-(-count // 10))])
    found = []
    for step in range(20):
        actions = task.core.contact_headings(task.inner(states), step)
        if step >= 10:
            found.append((states, actions))
        after, ok = box2d.push(states, actions)
        states = np.where(ok[:, None, None], after, states)
    return np.concatenate([s for s, _ in found])[:count], np.concatenate([a for _, a in found])[
        :count
    ]


@pytest.mark.parametrize(
    ("name", "most"),
    [("gathering", 0.02), ("push_t", 0.15), ("art_manip", 0.05), ("drawer", 0.02), ("cable", 0.15)],
)
def test_pushes_end_about_where_those_of_box2d_do(name: str, most: float) -> None:
    task = rtg.load_task(name)
    states, actions = meeting_pushes(task, 60)
    box2d, there = rtg.forward.Box2D(task).push(states, actions)
    mujoco, ok = rtg.forward.MuJoCo(task).push(states, actions)
    both = there & ok
    assert both.mean() > 0.9
    apart = np.linalg.norm((mujoco - box2d)[both][:, :, :2], axis=2) * task.core.metre
    assert np.median(apart.max(1)) < most
    assert np.abs(box2d - states)[:, 1:, :2].max() > 0.3


def test_equal_pushes_end_equally_in_any_batch() -> None:
    task = rtg.load_task("art_manip", ["forward.engine=mujoco"])
    states, actions = meeting_pushes(task, 40)
    engine = rtg.forward.Forward(task)
    ends, ok = engine.push(states, actions)
    order = np.random.default_rng(3).permutation(40)[:17]
    again, still_ok = rtg.forward.Forward(task).push(states[order], actions[order])
    assert (again == ends[order]).all() and (still_ok == ok[order]).all()


def test_pushes_of_other_lengths_beside_one_change_nothing() -> None:
    task = rtg.load_task("gathering", ["forward.engine=mujoco"])
    states, actions = meeting_pushes(task, 12)
    lengths = np.resize([0.0, 1e-9, 0.3, 1.0, 2.5], len(actions))
    states, lengths = np.tile(states, (25, 1, 1)), np.tile(lengths, 25)  # more than one batch
    angles = 2.0 * np.pi * np.tile(actions, 25) / task.headings
    ways = lengths[:, None] * np.stack((np.cos(angles), np.sin(angles)), 1)
    engine = rtg.engines.simulator(task.config)
    inner, ways = task.inner(states), ways * task.core.metre
    ends, ok = engine.push_along(inner, ways)
    for k in range(0, 12):
        alone, alone_ok = engine.push_along(inner[[k]], ways[[k]])
        assert (alone[0] == ends[k]).all() and alone_ok[0] == ok[k]
        assert (ends[k::12] == ends[k]).all()


def test_threads_side_by_side_get_the_same_bits() -> None:
    """As the variants of an evaluation and the seeds of one process do."""
    task = rtg.load_task("gathering", ["forward.engine=mujoco"])
    states, actions = meeting_pushes(task, 40)
    expected, _ = rtg.forward.Forward(task).push(states, actions)
    with ThreadPoolExecutor(4) as pool:
        engines = [rtg.forward.Forward(task) for _ in range(4)]
        for found in pool.map(lambda one: one.push(states, actions)[0], engines * 3):
            assert (found == expected).all()


def test_joints_stay_closed() -> None:
    task = rtg.load_task("cable", ["forward.engine=mujoco"])
    states, actions = meeting_pushes(task, 30)
    ends, ok = rtg.forward.Forward(task).push(states, actions)
    assert ok.mean() > 0.95  # some chains take long to come to rest
    scene = rtg.engines.Scene(task.config)

    def places(body: int, point: np.ndarray) -> np.ndarray:
        c, s = np.cos(ends[ok, body, 2]), np.sin(ends[ok, body, 2])
        return ends[ok, body, :2] + point @ np.array([[c, s], [-s, c]]).transpose(2, 0, 1)

    for joint in scene.joints:
        gap = places(joint.child, joint.on_child) - places(joint.parent, joint.on_parent)
        assert np.abs(gap).max() < 0.02 * scene.size


def test_lengths_and_densities_have_no_scale() -> None:
    """Gathering at a twentieth and with a thousandfold density has the same pushes."""
    task = rtg.load_task("gathering", ["forward.engine=mujoco"])
    states, actions = meeting_pushes(task, 20)
    inner = task.inner(states)
    ends, _ = rtg.engines.simulator(task.config).push(inner, actions)
    text = task.config.yaml.replace("density: 1.0, friction", "density: 1000.0, friction")
    heavy = _core.Config.from_text(text, "heavy")
    again, _ = rtg.engines.simulator(heavy).push(inner, actions)
    np.testing.assert_allclose(again, ends, atol=1e-5)


def test_bodies_come_to_rest_apart() -> None:
    task = rtg.load_task("gathering", ["forward.engine=mujoco"])
    state = task.inner(task.start()[None])
    state[0, 2] = state[0, 1] + [1.1, 0.2, 0.0]  # boxes of 1.2 m
    assert not task.core.is_legal(state)[0]
    ends, ok = rtg.engines.simulator(task.config).push(state, np.array([_core.SETTLE]))
    assert ok[0] and task.core.is_legal(ends)[0]
