"""The door to the parts: tasks, the reverse simulator and the forward ones, in metres."""

import numpy as np
import pytest
import rtg
from rtg import paths


@pytest.fixture(scope="module")
def solved() -> tuple[rtg.Task, np.ndarray, rtg.ReverseSolutions]:
    task = rtg.load_task("push_t")
    goal = task.goal_state(3)
    return task, goal, rtg.ReverseSimulator(task).solve(goal, np.arange(task.actions))


def test_a_task_is_loaded_by_name_or_path_with_settings() -> None:
    file = paths.CONFIG / "drawer.yaml"
    one, other = rtg.load_task("drawer"), rtg.load_task(file, ["task.horizon=7"])
    assert one.name == other.name == "drawer" and other.horizon == 7 != one.horizon
    with pytest.raises(ValueError, match=r"nothing\.yaml: .*; legal: "):
        rtg.load_task("nothing.yaml")


def test_states_are_in_metres() -> None:
    """The robot of push_t has a radius of 0.5 m, so that units of the core are others."""
    task = rtg.load_task("push_t")
    goal = task.goal_state(1)
    assert task.core.metre == pytest.approx(1.6)
    assert task.succeeded(goal[None])[0]
    off = goal.copy()
    off[1, 0] += 1.0
    assert not task.succeeded(off[None])[0]
    np.testing.assert_allclose(task.outer(task.inner(off[None])), off[None], atol=1e-12)


def test_poses_of_a_run_are_not_taken_for_metres_where_a_body_is_fixed() -> None:
    task = rtg.load_task("drawer")
    in_metres, in_units = task.start()[None], task.core.start[None]
    wrong = (
        r"row 0 has the fixed body 'cabinet' at \(0 m, 9.168 m, .* of \(0 m, 5.73 m, .*; legal: m"
    )
    rows = rtg.forward.Box2D(task).push(in_metres, [0])[0]
    np.testing.assert_array_equal(task.inner(rows)[0, 3], task.core.start[3])  # to the bit
    for take in (
        lambda states: rtg.ReverseSimulator(task).solve(states, [0]),
        lambda states: rtg.ReverseSimulator(task).solve(states[0], [0]),
        lambda states: rtg.forward.Box2D(task).push(states, [0]),
        task.succeeded,
    ):
        take(in_metres)
        with pytest.raises(ValueError, match=wrong):
            take(in_units)


@pytest.mark.parametrize("name", ["gathering", "push_t", "art_manip", "drawer"])
def test_each_entry_of_an_observation_has_a_name(name: str) -> None:
    task = rtg.load_task(name)
    state = task.start()
    names = task.observation_names
    before = task.observation(state[None])[0]
    assert len(names) == len(set(names)) == len(before)
    body = next(k for k in range(1, len(task.bodies)) if not task.core.fixed[k])
    state[body, 0] += 0.25
    changed = np.flatnonzero(task.observation(state[None])[0] != before)
    moved = [names[k] for k in changed if not names[k].startswith("joint")]
    assert moved == [f"{task.bodies[body]} x", f"{task.bodies[body]} x to robot"]


def test_the_starts_of_a_reverse_solve_lead_to_the_given_state(solved) -> None:
    task, goal, found = solved
    assert 10 < found.solved.sum() < task.actions
    assert set(found.status) >= {"converged", "pruned"}
    actions = np.flatnonzero(found.solved)
    starts = np.stack([found.starts[a][0] for a in actions])
    after, ok = rtg.forward.Newton(task).push(starts, actions)
    gap = np.linalg.norm(after[:, 1, :2] - goal[1, :2], axis=1)
    assert ok.all() and gap.max() < 0.1  # [m], of pushes of 1 m
    assert rtg.forward.Box2D(task).push(starts, actions)[1].all()


@pytest.mark.parametrize("engine", [rtg.forward.Newton, rtg.forward.Box2D, rtg.forward.MuJoCo])
def test_a_way_of_the_robot_is_in_metres(engine: type) -> None:
    if engine is rtg.forward.MuJoCo:
        pytest.importorskip("mujoco", reason="the extra `mujoco` is not installed")
    task = rtg.load_task("push_t")
    start = task.start()
    start[0, :2] = (-4.0, -4.0)  # nothing is near
    (after,), ok = engine(task).push_along(start[None], [(0.3, -0.4)])
    assert ok.all()
    np.testing.assert_allclose(after[0, :2], (-3.7, -4.4), atol=1e-3)
    for wrong, message in [
        ([(0.0, 0.0)], "a way of length 0.0*; legal: finite lengths above 0"),
        ([(np.nan, 1.0)], "a way of length nan; legal"),
        (np.ones((2, 2)), "1 states but 2 ways; legal: one way per state"),
    ]:
        with pytest.raises(ValueError, match=message):
            engine(task).push_along(start[None], wrong)
    with pytest.raises(ValueError, match="2 states but 1 actions; legal: one action per state"):
        engine(task).push(np.stack([start, start]), [0])


def test_a_solution_is_a_trajectory_with_controls_and_forces(solved) -> None:
    task, goal, found = solved
    steps = task.config.physics.sub_steps
    assert found.trajectory.shape == (task.actions, steps + 1, 2, 3)
    assert found.controls.shape == (task.actions, steps, 3)
    for action in np.flatnonzero(found.solved):
        np.testing.assert_array_equal(found.trajectory[action, 0], found.starts[action][0])
        np.testing.assert_allclose(found.trajectory[action, -1], goal, atol=0.05)
    missing = ~found.solved & (np.array(found.status) == "pruned")
    assert np.isnan(found.trajectory[missing]).all() and np.isnan(found.objective[missing]).all()
    assert (found.infeasibility[found.solved] < 1e-5).all()


def test_contact_forces_move_the_object_in_newtons(solved) -> None:
    """k_D/Δt² m Δx = F: of the pushes that touch the T at one face, across it."""
    task, _, found = solved
    contacts, physics = found.contacts, task.config.physics
    mass = 7.0 * 1.0  # of the T [kg]
    drag = physics.damping / physics.time_step**2 * mass
    checked = 0
    for action in np.flatnonzero(found.solved):
        for step in range(1, physics.sub_steps + 1):
            here = (contacts.solve == action) & (contacts.sub_step == step)
            sign = np.where(contacts.body[here] == 1, 1.0, -1.0)
            forces = (sign * contacts.force[here])[:, None] * contacts.normal[here]
            moved = np.diff(found.trajectory[action, step - 1 : step + 1, 1, :2], axis=0)[0]
            if len(forces) != 1 or np.linalg.norm(moved) < 0.02:
                continue
            across = forces[0] / np.linalg.norm(forces[0])
            assert np.linalg.norm(forces[0]) == pytest.approx(drag * moved @ across, rel=0.02)
            checked += 1
    assert checked > 20
    assert np.linalg.norm(contacts.normal, axis=1) == pytest.approx(1.0)


def test_solves_do_not_depend_on_their_company(solved) -> None:
    task, goal, found = solved
    action = int(np.flatnonzero(found.solved)[0])
    alone = rtg.ReverseSimulator(task).solve(goal[None], [action], threads=2)
    np.testing.assert_array_equal(alone.trajectory[0], found.trajectory[action])
    np.testing.assert_array_equal(alone.starts[0], found.starts[action])


@pytest.mark.parametrize(
    ("states", "actions", "message"),
    [
        (np.zeros((2, 3, 3)), [0, 1], r"s of shape \[2, 3, 3\]; legal: \[N, 2, 3\]"),
        (np.full((1, 2, 3), np.nan), [0], "not finite"),
        (np.zeros((1, 2, 3)), [48], "action 48; legal: 0 to 47"),
        (np.zeros((1, 2, 3)), [0, 1], "1 states but 2 actions"),
    ],
)
def test_wrong_arrays_are_named(states: np.ndarray, actions: list[int], message: str) -> None:
    task = rtg.load_task("push_t")
    for call in (rtg.ReverseSimulator(task).solve, rtg.forward.Newton(task).push):
        with pytest.raises(ValueError, match=message):
            call(states, actions)


def test_masses_are_in_kilograms_and_solutions_say_how_they_ended(solved) -> None:
    task, _, found = solved
    np.testing.assert_allclose(task.masses, [0.25 * np.pi, 7.0])  # a disc of 0.5 m, the T
    counts = [f"{found.status.count(s)} {s}" for s in dict.fromkeys(found.status)]
    assert repr(found) == f"ReverseSolutions of {task.actions} pushes: {', '.join(counts)}"
