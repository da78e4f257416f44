"""The step energy and the beam search from Python."""

import numpy as np
import pytest
import rtg


def touching(task: rtg.Task) -> tuple[np.ndarray, np.ndarray]:
    """Two states of a sub-step in which bodies are near each other, and move a little."""
    now = task.goal_state(2)
    after = now.copy()
    movable = ~np.array(task.core.fixed)
    after[movable, :2] += 0.002 * np.random.default_rng(1).standard_normal((movable.sum(), 2))
    return now, after


@pytest.mark.parametrize("name", ["pack", "push_t"])
def test_derivatives_of_the_energy_are_those_of_its_value(name: str) -> None:
    task = rtg.load_task(name)
    energy = rtg.StepEnergy(task)
    now, after = touching(task)
    gradient, hessian = energy.gradient(after, now), energy.hessian(after, now)
    movable = [k for k, fixed in enumerate(task.core.fixed) if not fixed]
    assert gradient.shape == (3 * len(movable),) and np.abs(gradient).max() > 0.0
    step = 1e-6  # [m], [rad]
    for k in range(len(gradient)):
        ends = []
        for sign in (-1.0, 1.0):
            moved = after.copy()
            moved[movable[k // 3], k % 3] += sign * step
            ends.append((energy.value(moved, now), energy.gradient(moved, now)))
        (low, below), (high, above) = ends
        assert gradient[k] == pytest.approx((high - low) / (2 * step), rel=1e-5, abs=1e-7)
        np.testing.assert_allclose(hessian[k], (above - below) / (2 * step), rtol=1e-4, atol=1e-5)
    np.testing.assert_allclose(hessian, hessian.T, atol=1e-9)


def test_a_vertex_inside_another_body_has_infinite_energy() -> None:
    task = rtg.load_task("gathering")
    energy = rtg.StepEnergy(task)
    now = task.start()
    inside = now.copy()
    inside[1, :2] = inside[2, :2] + 0.3
    assert energy.value(inside, now) == np.inf


def test_forces_are_those_of_the_barrier_where_gaps_are_small() -> None:
    task = rtg.load_task("pack")
    energy = rtg.StepEnergy(task)
    state, _ = touching(task)
    gaps, forces = energy.gaps(state), energy.forces(state)
    assert len(energy.contacts) == len(gaps) == len(forces)
    reach = gaps.max() / 2.0
    assert (forces[gaps >= reach] == 0.0).all() and (forces[gaps < 0.9 * reach] > 0.0).all()
    near = energy.contacts[int(gaps.argmin())]
    assert {near.body, near.other} <= set(task.bodies) and near.body != near.other
    with pytest.raises(ValueError, match=rf"forces of shape \[3\]; legal: \[{len(gaps)}\]"):
        energy.value(state, state, [0.0, 0.0, 0.0])


def test_a_beam_search_grows_layer_by_layer_and_its_plans_succeed() -> None:
    task = rtg.load_task("gathering")
    search = rtg.BeamSearch(task, settings=["search.breadth=20"], workers=2)
    roots = search.nodes
    assert len(roots) and task.succeeded(roots.states).all() and (roots.depths == 0).all()
    far = search.start_distance
    data = rtg.Transitions.joined(search.grow() for _ in range(4))
    nodes = search.nodes
    assert search.start_distance < far and (nodes.depths[search.beam] == 4).all()
    node = int(search.beam[0])
    state, plan = nodes.states[node][None], nodes.plan(node)
    assert len(plan) == 4 and len(data)
    box2d = rtg.forward.Box2D(task)
    for action in plan:
        assert not task.succeeded(state)[0]
        state, ok = box2d.push(state, [action])
        assert ok[0]
    assert task.succeeded(state)[0]


def test_a_search_is_the_same_for_a_seed_and_grows_towards_a_given_start() -> None:
    task = rtg.load_task("gathering")
    target = task.start(5)
    searches = [
        rtg.BeamSearch(task, target, seed=3, workers=k, settings=["search.breadth=10"])
        for k in (1, 2)
    ]
    one, other = (search.grow() for search in searches)
    np.testing.assert_array_equal(one.states, other.states)
    np.testing.assert_array_equal(searches[0].target, target)
    with pytest.raises(ValueError, match="breadth"):
        rtg.BeamSearch(task, settings=["search.breadth=0"])
