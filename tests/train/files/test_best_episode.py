"""The file of a run's best episode, and what it says of a damaged one."""

import numpy as np
import pytest
from rtg.errors import UserError
from rtg.files import best_episode

STATES = np.arange(24.0).reshape(2, 4, 3)


@pytest.mark.parametrize("success", [True, False])
def test_what_is_written_is_read_back(tmp_path, success):
    best_episode.write(tmp_path, STATES, success)
    poses, told = best_episode.read(tmp_path, 4)
    assert np.array_equal(poses, STATES) and told is success


def test_a_file_cut_short_of_text_or_of_other_bodies_is_refused(tmp_path):
    best_episode.write(tmp_path, STATES, True)
    whole = (tmp_path / best_episode.FILE).read_bytes()
    for content, bodies in ((whole[:-30], 4), (b"", 4), (b"text", 4), (whole, 3)):
        (tmp_path / best_episode.FILE).write_bytes(content)
        with pytest.raises(UserError, match=r"best_episode\.npz: is damaged; legal: the file as"):
            best_episode.read(tmp_path, bodies)


def test_a_file_that_lacks_an_array_is_refused(tmp_path):
    np.savez(tmp_path / best_episode.FILE, poses=STATES)
    with pytest.raises(UserError, match=r"best_episode\.npz: is damaged"):
        best_episode.read(tmp_path, 4)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_states_that_are_not_finite_are_refused(tmp_path, value):
    best_episode.write(tmp_path, np.where(STATES == 5.0, value, STATES), True)
    with pytest.raises(UserError, match=r"best_episode\.npz: is damaged"):
        best_episode.read(tmp_path, 4)
