"""Behaviour cloning: what is imitated, the loss, a mapping that it learns."""

import json
from pathlib import Path

import numpy as np
import pytest
import torch as th
from rtg.files.dataset import SOURCES, Rows, Transitions
from rtg.learn import trainer
from rtg.learn.cloning import Cloning, imitated
from rtg.learn.offline_data import FileSource
from rtg.learn.replay import Batch
from samples import random_transitions, train_settings
from test_ddqn import SETTINGS
from toy import Line
from training_runs import run_folder, training

BC = ("run.method=bc_rtg",)
HERE = np.array([[k / 4, 1, 0] for k in range(5)], np.float32)  # the states of the line
WANTED = np.array([3, 1, 7, 0, 5])  # an action for each


def cloning(**changes: object) -> Cloning:
    settings = train_settings(**{**SETTINGS, "interact": False, "learner": "cloning", **changes})
    return Cloning(Line(), settings, discount=0.9, seed=0)


def rows_of(source: str, actions: np.ndarray) -> Transitions:
    """Makes a row in each state of the line."""
    n = len(actions)
    nothing = np.zeros(n, np.float32)
    return Transitions(
        poses=np.zeros((n, 2, 3)),
        action=actions.astype(np.int32),
        next_poses=np.zeros((n, 2, 3)),
        reward=nothing,
        terminated=nothing > 0,
        observation=HERE,
        next_observation=HERE,
        source=np.full(n, SOURCES.index(source), np.int8),
    )


def test_steps_of_trees_are_imitated_and_nothing_else() -> None:
    data = random_transitions(100)._replace(source=(np.arange(100) % len(SOURCES)).astype(np.int8))
    kept = imitated(data)
    places = [k for k in range(100) if SOURCES[k % len(SOURCES)] == "tree"]
    for found, column in zip(kept, data, strict=True):
        np.testing.assert_array_equal(found, column[places])


def test_the_loss_is_the_cross_entropy_of_the_actions(monkeypatch: pytest.MonkeyPatch) -> None:
    """-log of the share of e^f(a) among all eight, mean over both rows."""
    one, told = cloning(network="plain"), []
    with th.no_grad():
        one.online.head.weight.zero_()
        one.online.head.bias.copy_(th.tensor([1.0, 2.0, 1.0, 4.0, 1.0, 1.0, 1.0, 1.0]).log())
    monkeypatch.setattr(one, "_backward", told.append)
    seen, column = th.zeros(2, 3), th.zeros(2, 1)
    one._compute_gradient(Batch(seen, th.tensor([[1], [3]]), seen, column, column, column, 2))
    assert told[0].item() == pytest.approx((np.log(12 / 2) + np.log(12 / 4)) / 2, rel=1e-5)


def test_it_learns_what_the_steps_do_and_not_what_their_branches_do() -> None:
    """Each step has four branches, all with the same worse action."""
    one = cloning(learning_rate=1e-3)
    branches = [rows_of("branch", (WANTED + 1) % 8)] * 4
    for part in [rows_of("tree", WANTED), *branches]:
        one.replay.add_offline(imitated(part))
    for _ in range(60):
        one.learn_offline()
    np.testing.assert_array_equal(one.values(HERE).argmax(axis=1), WANTED)


def test_a_run_imitates_the_trees_of_its_transitions(tmp_path: Path, rows: Rows) -> None:
    folder = run_folder(tmp_path / "run", rows, *BC)
    trees = rows.source == SOURCES.index("tree")
    assert 0 < trees.sum() < len(trees)
    assert trainer.main([str(folder), "--no-stream"]) == 0
    found = json.loads((folder / "training.json").read_text())
    assert found["imitated_transitions"] == trees.sum()
    assert found["offline_transitions"] == len(trees)
    one = training(folder)
    one.restore()
    np.testing.assert_array_equal(
        one.model.replay.offline.rows["action"][: trees.sum()], rows.action[trees]
    )


def test_data_without_steps_to_imitate_end_the_run(tmp_path: Path, rows: Rows, capsys) -> None:
    walks = rows._replace(source=np.full_like(rows.source, SOURCES.index("walk")))
    folder = run_folder(tmp_path / "run", walks, *BC)
    assert trainer.main([str(folder), "--no-stream"]) == 1
    assert "none of the 2000 transitions can be learned from" in capsys.readouterr().err


def test_logits_are_not_written_down_as_values(tmp_path: Path, rows: Rows) -> None:
    folder = run_folder(tmp_path / "run", rows, *BC)
    one = training(folder)
    source = FileSource(folder / "transitions.npz", one.task, one.data)
    assert one.run(source, lambda: False, record=False)
    one.finish()
    assert not {name for name in one.log.rows[-1] if name.startswith("q_")}
    written = json.loads((folder / "training.json").read_text())
    assert not {name for name in written if name.startswith("q_")}
