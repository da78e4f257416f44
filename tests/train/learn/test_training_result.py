"""The figures of a run that has come to its end."""

import json
from pathlib import Path

import pytest
from rtg.files import dataset
from rtg.files.dataset import Rows
from rtg.learn.offline_data import FileSource, NoSource
from rtg.learn.value_check import MAX_STATES, check_values, stored_states
from training_runs import run_folder, training


def test_the_learner_is_named_where_it_learned_not_where_it_was_looked_at(
    tmp_path: Path, rows: Rows
) -> None:
    folder = run_folder(tmp_path / "run", rows)
    for runs in (2, 1):
        one = training(folder)
        one.runs = runs
        if one.has_checkpoint():
            one.restore()
        source = FileSource(folder / "transitions.npz", one.task, one.data)
        assert one.run(source, lambda: False, record=False)
        one.finish()
        found = json.loads((folder / "training.json").read_text())
        assert found["runs_in_process"] == 2
        assert "curriculum_pushes" not in found


def test_the_result_says_how_well_q_ranks_the_headings_of_stored_states(
    tmp_path: Path, rows: Rows, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the policy's values, with the learner's discount; nothing where nothing can be said."""
    folder = run_folder(tmp_path / "run", rows)
    one = training(folder)
    source = FileSource(folder / "transitions.npz", one.task, one.data)
    assert one.run(source, lambda: False, record=False)
    one.finish()
    written = json.loads((folder / "training.json").read_text())
    seen = dataset.read(folder / "transitions.npz")
    states = stored_states(seen, MAX_STATES, seed=1)
    assert len(states) == 300
    found = check_values(one.config, one.model.values, 0.95, states).summary()
    assert {name: written[name] for name in found} == pytest.approx(found)
    monkeypatch.setattr("rtg.learn.training_result.check_values", lambda *_: None)
    one.finish()
    written = json.loads((folder / "training.json").read_text())
    assert {written[name] for name in found} == {None}


def test_without_stored_states_nothing_is_said_of_the_ranks(tmp_path: Path) -> None:
    one = training(run_folder(tmp_path / "run", None, "run.method=ddqn"))
    one.finish()
    written = json.loads((one.folder / "training.json").read_text())
    assert written["offline_transitions"] == 0 and "q_rank_correlation" not in written


def test_pushes_for_starts_of_a_curriculum_are_pushes_of_learning(tmp_path: Path) -> None:
    one = training(run_folder(tmp_path / "run", None, "run.method=rcg"))
    assert one.run(NoSource(), lambda: False, record=False)
    one.finish()
    found = json.loads((one.folder / "training.json").read_text())
    assert found["learning_pushes"] == 240 + found["curriculum_pushes"] > 240
    assert one.log.rows[-1]["pushes"] == found["learning_pushes"]
