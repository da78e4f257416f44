"""transitions.npz from the rows of a run."""

from itertools import pairwise

import numpy as np
from rtg import _core, paths
from rtg.files import dataset, versions
from rtg.files.dataset import Rows
from rtg.files.recorder import Recorder
from samples import random_transitions

CONFIG = _core.Config.from_file(paths.CONFIG / "gathering.yaml", ["run.seed=7"])
TASK = CONFIG.task


def rows(begin, end):
    sample = random_transitions(50)
    return Rows(*(getattr(sample, name)[begin:end] for name in Rows._fields))


def test_the_file_is_the_same_however_the_rows_came_in(tmp_path):
    files = []
    for cuts in ([0, 50], [0, 1, 2, 30, 50]):
        recorder = Recorder(CONFIG)
        for begin, end in pairwise(cuts):
            recorder.add(rows(begin, end))
        assert recorder.count == 50
        files.append(tmp_path / f"{len(cuts)}.npz")
        recorder.write(files[-1])
    assert files[0].read_bytes() == files[1].read_bytes()
    read, origin = dataset.read_with_origin(files[0], TASK)
    assert origin == (TASK.content, 7, versions.this_commit() or "")
    assert np.array_equal(read.poses, rows(0, 50).poses)
    assert np.array_equal(read.next_observation, TASK.observation(read.next_poses))


def test_no_row_is_a_legal_data_set_too(tmp_path):
    Recorder(CONFIG).write(tmp_path / "none.npz")
    assert len(dataset.read(tmp_path / "none.npz", TASK).action) == 0


def test_a_finished_file_is_sealed_beside_the_versions_of_its_program(tmp_path):
    versions.write(tmp_path, "box2d", {"git_revision": "abc"})
    Recorder(CONFIG).finish(tmp_path / "transitions.npz")
    digest = versions.digest(tmp_path / "transitions.npz")
    assert versions.sealed_digest(tmp_path / "transitions.npz") == digest
    made_by = {"git_revision": "abc", "sha256": {"transitions.npz": digest}}
    assert versions.generator(tmp_path) == made_by
