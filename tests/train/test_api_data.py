"""Generation, training and policies, called from Python."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
import rtg
from rtg import paths
from rtg.errors import UserError
from rtg.files import own_data
from rtg.files.row_digest import row_digest

TINY = paths.CONFIG / "tests" / "tiny.yaml"


@pytest.fixture(scope="module")
def task() -> rtg.Task:
    return rtg.load_task(TINY)


@pytest.fixture(scope="module")
def data(task: rtg.Task) -> rtg.Transitions:
    return rtg.Transitions.joined(rtg.generate(task, 600))


def test_the_transitions_are_pushes_of_the_simulator(task, data) -> None:
    assert len(data) == 600
    after, ok = rtg.forward.Box2D(task).push(data.states, data.actions)
    assert ok.all()
    np.testing.assert_array_equal(after, data.next_states)
    np.testing.assert_array_equal(task.succeeded(data.next_states), data.success)
    assert data.success.any() and {rtg.SOURCES[k] for k in data.source} == {"tree", "branch"}


def test_transitions_are_saved_and_loaded(task, data, tmp_path) -> None:
    data.save(tmp_path / "mine.npz")
    again = rtg.Transitions.load(tmp_path / "mine.npz", task)
    for field in dataclasses.fields(data):
        np.testing.assert_array_equal(getattr(again, field.name), getattr(data, field.name))


def test_batches_come_as_they_are_found_and_do_not_depend_on_workers(task, data) -> None:
    batches = list(rtg.generate(task, 600, workers=2))
    assert len(batches) > 1
    for field in dataclasses.fields(data):
        np.testing.assert_array_equal(
            getattr(rtg.Transitions.joined(batches), field.name), getattr(data, field.name)
        )


def test_a_generation_that_nobody_takes_from_ends(task) -> None:
    batches = rtg.generate(task, 20_000)
    assert len(next(batches)) > 0
    batches.close()  # would hang if the search went on
    with pytest.raises(StopIteration):
        next(batches)


def test_illegal_settings_of_a_generation_are_refused_at_once(task) -> None:
    with pytest.raises(ValueError, match=r"search\.breadth.*legal"):
        rtg.generate(task, settings=["search.breadth=0"])


def test_a_policy_is_trained_and_loaded(task, data, tmp_path: Path) -> None:
    small = ["train.eval_every=40", "train.eval_episodes=3", "train.buffer=2000"]
    policy = rtg.train(data, task, tmp_path / "run", interactions=80, settings=small)
    states = data.states[:50]
    values = policy.values(states)
    assert values.shape == (50, task.actions)
    np.testing.assert_array_equal(policy(states), values.argmax(axis=1))
    again = rtg.load_policy(tmp_path / "run")
    np.testing.assert_array_equal(again.values(states), values)
    assert 0.0 <= again.success_rate(episodes=3) <= 1.0
    assert {"progress.csv", "training.json", "transitions.npz"} <= {
        path.name for path in (tmp_path / "run").iterdir()
    }
    for path in (tmp_path / "run", tmp_path / "run" / "transitions.npz"):
        stored = rtg.Transitions.load(path, task)
        for field in dataclasses.fields(data):
            np.testing.assert_array_equal(getattr(stored, field.name), getattr(data, field.name))
    given = own_data.of_run(tmp_path / "run")
    assert given["format"] == "arrays" and given["name"] is None
    assert given["sha256"] == row_digest(
        own_data.rows_in_metres(task.core, data.states, data.actions, data.next_states, data.source)
    )
    with pytest.raises(UserError, match="holds a learner already"):
        rtg.train(data, task, tmp_path / "run", interactions=80)


@pytest.mark.parametrize(
    ("column", "value", "message"),
    [
        ("actions", np.full(600, 99), "action 99; legal: 0 to "),
        ("states", np.zeros((600, 2, 3)), r"states of shape \[600, 2, 3\]"),
        ("states", np.zeros((5, 4, 3)), "legal: of equally many"),
        ("next_states", np.full((600, 4, 3), np.inf), "not finite"),
    ],
)
def test_wrong_data_are_refused(task, data, tmp_path, column, value, message) -> None:
    wrong = dataclasses.replace(data, **{column: value})
    with pytest.raises(ValueError, match=message):
        rtg.train(wrong, task, tmp_path / "run")
    assert not (tmp_path / "run").exists()


def test_a_folder_without_a_policy_is_named(tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"has no config\.yaml; legal: the folder of a run"):
        rtg.load_policy(tmp_path)
