"""The digest of transitions, which the coordinator computes as well."""

import numpy as np
import pytest
from rtg import _core
from rtg.errors import RunError, UserError
from rtg.files import dataset, row_digest, run_folder
from rtg.files.dataset import Rows
from rtg.files.recorder import Recorder
from rtg.files.row_digest import row_digest as digest
from training_runs import TINY

CONFIG = _core.Config.from_file(TINY)
POSES = np.arange(12.0).reshape(2, 2, 3)
PAIR = Rows(
    poses=POSES,
    action=np.array([7, -1], np.int32),
    next_poses=POSES + 0.5,
    reward=np.array([0, 1], np.float32),
    terminated=np.array([False, True]),
    source=np.array([0, 3], np.int8),
)


def test_it_is_that_of_the_coordinator():
    """The same number stands in tests/nodes/beam_coordinator/row_digest_test.cpp."""
    assert digest(PAIR) == ("ebd427d999e3a719e0aec00709a23a16bcdb9d3f7e53dab123a71687d72a3542")


@pytest.mark.parametrize("column", ["poses", "action", "next_poses", "terminated", "source"])
def test_it_differs_where_a_column_does(column):
    changed = getattr(PAIR, column).copy()
    changed[-1] = np.flip(changed[-1]) if changed.ndim > 1 else ~changed[-1]
    assert digest(PAIR._replace(**{column: changed})) != digest(PAIR)


def test_rows_are_not_worth_more_together_than_one_by_one(monkeypatch):
    whole = digest(PAIR)
    monkeypatch.setattr(row_digest, "_BLOCK", 1)
    assert digest(PAIR) == whole


@pytest.fixture
def recorder(rows):
    made = Recorder(CONFIG)
    made.add(rows)
    return made


def test_transitions_that_were_not_generated_are_not_recorded(tmp_path, recorder):
    file, report = tmp_path / "transitions.npz", tmp_path / "generation.json"
    run_folder.write_json(report, {row_digest.KEY: "0" * 64})
    with pytest.raises(RunError, match=rf"^{report}: .* not the 2000 that arrived"):
        recorder.finish(file)
    assert not file.exists()
    run_folder.write_json(report, {row_digest.KEY: recorder.digest()})
    recorder.finish(file)
    dataset.read(file)


def test_a_set_of_which_the_report_does_not_tell_is_refused(tmp_path, recorder):
    file, report = tmp_path / "transitions.npz", tmp_path / "generation.json"
    recorder.finish(file)
    run_folder.write_json(report, {row_digest.KEY: "0" * 64})
    with pytest.raises(UserError, match=rf"^{file}: holds other transitions than generation.json"):
        dataset.read(file, CONFIG.task)
