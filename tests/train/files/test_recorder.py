"""transitions.npz from the rows of a run."""

from itertools import pairwise

import numpy as np
from rtg import _core, paths
from rtg.files import dataset
from rtg.files.dataset import Rows
from rtg.files.recorder import Recorder
from samples import random_transitions

TASK = _core.Config.from_file(paths.CONFIG / "gathering.yaml").task


def rows(begin, end):
    sample = random_transitions(50)
    return Rows(*(getattr(sample, name)[begin:end] for name in Rows._fields))


def test_the_file_is_the_same_however_the_rows_came_in(tmp_path):
    files = []
    for cuts in ([0, 50], [0, 1, 2, 30, 50]):
        recorder = Recorder(TASK)
        for begin, end in pairwise(cuts):
            recorder.add(rows(begin, end))
        assert recorder.count == 50
        files.append(tmp_path / f"{len(cuts)}.npz")
        recorder.write(files[-1])
    assert files[0].read_bytes() == files[1].read_bytes()
    read = dataset.read(files[0], TASK.bodies, TASK.headings)
    assert np.array_equal(read.poses, rows(0, 50).poses)
    assert np.array_equal(read.next_observation, TASK.observation(read.next_poses))


def test_no_row_is_a_legal_data_set_too(tmp_path):
    Recorder(TASK).write(tmp_path / "none.npz")
    assert len(dataset.read(tmp_path / "none.npz", TASK.bodies).action) == 0
