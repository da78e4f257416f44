"""Inputs of the network for states that are equal up to a symmetry of the task."""

from pathlib import Path

import numpy as np
import pytest
from rtg import _core, paths
from rtg.envs.layouts import Layouts
from rtg.envs.training_environments import TrainingEnvironments
from rtg.learn import policy_file
from rtg.learn.ddqn import DoubleDqn
from rtg.learn.symmetry import Symmetry
from samples import train_settings


def task_of(name: str) -> _core.Task:
    return _core.Config.from_file(paths.CONFIG / f"{name}.yaml").task


def states_of(task: _core.Task, count: int = 20) -> np.ndarray:
    """Starts with objects moved and turned at random, and the robot among them."""
    rng = np.random.default_rng(3)
    states = np.stack([task.jittered_start(0.1, 1, k) for k in range(count)])
    movable = [body for body in range(task.bodies) if not task.fixed[body]]
    states[:, movable, :2] += rng.uniform(-2.0, 2.0, (count, len(movable), 2))
    states[:, movable[1:], 2] = rng.uniform(-np.pi, np.pi, (count, len(movable) - 1))
    return states


GATHERING = task_of("gathering")


@pytest.mark.parametrize("name", ["gathering", "sorting"])
def test_swaps_of_equal_objects_do_not_change_the_input(name: str) -> None:
    task = task_of(name)
    states, seen = states_of(task), Symmetry(task)
    swapped = states.copy()
    for group in task.interchangeable:
        swapped[:, group] = swapped[:, group[::-1]]
    assert not np.array_equal(task.observation(swapped), task.observation(states))
    inputs = seen(task.observation(states))
    np.testing.assert_array_equal(seen(task.observation(swapped)), inputs)
    assert len(np.unique(inputs.round(4), axis=0)) == len(states)


def test_turns_by_the_period_of_a_shape_do_not_change_the_input() -> None:
    states, seen = states_of(GATHERING), Symmetry(GATHERING)
    inputs = seen(GATHERING.observation(states))
    for turn, equal in ((np.pi / 2, True), (np.pi, True), (np.pi / 4, False)):
        turned = states.copy()
        turned[:, 2, 2] += turn
        same = np.isclose(seen(GATHERING.observation(turned)), inputs, atol=1e-4)
        assert same.all() == equal


def test_the_nearest_of_equal_objects_comes_first() -> None:
    states = states_of(GATHERING)
    inputs = Symmetry(GATHERING)(GATHERING.observation(states))
    offsets = np.stack([inputs[:, 2 + 6 * k + 4 : 2 + 6 * k + 6] for k in range(3)], axis=1)
    lengths = np.linalg.norm(offsets, axis=2)
    assert (np.diff(lengths, axis=1) >= 0.0).all()
    np.testing.assert_allclose(lengths.sum(axis=1), distances(states).sum(axis=1), rtol=1e-5)


def distances(states: np.ndarray) -> np.ndarray:
    offsets = states[:, 1:, :2] - states[:, :1, :2]
    return np.linalg.norm(offsets, axis=2) / GATHERING.relative_unit


@pytest.mark.parametrize("name", ["art_manip", "push_t", "gate"])
def test_objects_with_joints_and_single_ones_stay_as_they_are(name: str) -> None:
    task = task_of(name)
    seen = task.observation(states_of(task))
    symmetric = [k for k, period in enumerate(task.turn_periods) if period < 6.28]
    jointed = {body for parent, child, _ in task.joints for body in (parent, child)}
    assert not jointed & set(symmetric) and all(len(g) == 1 for g in task.interchangeable)
    if name == "art_manip":
        assert Symmetry(task)(seen) is seen


def changed(text: str, *pairs: tuple[str, str]) -> _core.Task:
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return _core.Config.from_text(text, "changed", []).task


def test_objects_that_are_to_stay_are_not_swapped_and_discs_have_no_angle() -> None:
    text = (paths.CONFIG / "gathering.yaml").read_text()
    assert task_of("gathering").interchangeable == [[1, 2, 3]]
    stays = changed(text, ("  goal:\n", "  goal:\n    - {kind: box, stays: 9.0}\n"))
    assert stays.interchangeable == [[1], [2], [3]]
    discs = changed(text, ("{box: [1.2, 1.2]}", "{disc: 0.6}"))
    assert discs.turn_periods[1:] == [0.0, 0.0, 0.0]
    states = states_of(discs)
    turned = states.copy()
    turned[:, 1:, 2] += 1.0
    seen = Symmetry(discs)
    np.testing.assert_array_equal(seen(discs.observation(turned)), seen(discs.observation(states)))


def test_hindsight_goals_are_swapped_with_their_objects() -> None:
    layouts = Layouts(GATHERING)
    seen = Symmetry(GATHERING, layouts)
    states = states_of(GATHERING)
    goals = layouts.goal_layouts[: len(states)]
    swapped = states[:, [0, 2, 1, 3]]
    by_object = goals.reshape(len(goals), 3, 2)[:, [1, 0, 2]].reshape(len(goals), 6)
    one = layouts.network_input(GATHERING.observation(states), goals)
    other = layouts.network_input(GATHERING.observation(swapped), by_object)
    np.testing.assert_array_equal(seen(one), seen(other))
    unlike = layouts.network_input(GATHERING.observation(swapped), goals)
    assert not np.array_equal(seen(one), seen(unlike))


@pytest.mark.parametrize("symmetry", [True, False])
def test_values_are_equal_for_equal_states_of_learner_and_policy(
    tmp_path: Path, symmetry: bool
) -> None:
    config = _core.Config.from_file(paths.CONFIG / "gathering.yaml", [])
    settings = train_settings(symmetry=symmetry, batch=8, buffer=1000)
    one = DoubleDqn(TrainingEnvironments(config, 2, 0.1, 1), settings, 0.9, 1)
    states = states_of(GATHERING)
    here = GATHERING.observation(states)
    there = GATHERING.observation(states[:, [0, 3, 1, 2]])
    assert np.allclose(one.values(here), one.values(there), atol=1e-5) == symmetry
    policy_file.write(tmp_path / "model.pt", GATHERING, settings, one.mean.state_dict())
    values = policy_file.read(tmp_path / "model.pt", GATHERING)
    np.testing.assert_allclose(values(there), one.values(there), atol=1e-6)


def test_batches_hold_such_inputs() -> None:
    config = _core.Config.from_file(paths.CONFIG / "gathering.yaml", [])
    settings = train_settings(batch=64, buffer=1000, offline=False)
    one = DoubleDqn(TrainingEnvironments(config, 2, 0.1, 1), settings, 0.9, 1)
    for _ in range(40):
        one._interact()
    batch = one.replay.sample(64)
    for seen in (batch.observations.numpy(), batch.next_observations.numpy()):
        np.testing.assert_allclose(one.symmetry(seen)[:, :2], seen[:, :2])
        lengths = [np.hypot(seen[:, 6 * k + 6], seen[:, 6 * k + 7]) for k in range(3)]
        assert (np.diff(lengths, axis=0) >= 0.0).all()
