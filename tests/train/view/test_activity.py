"""Whether a run has ended, and whether anybody works on it."""

import os

import pytest
from rtg.files import locks
from rtg.view.activity import is_going_on, is_over, state
from training_runs import run_folder
from view_runs import finished, learn

LONG_AGO = 1e6


def aged(folder):
    for file in folder.iterdir():
        os.utime(file, (LONG_AGO, LONG_AGO))
    return folder


def test_a_run_is_over_once_its_summary_is_newer_than_its_configuration(tmp_path, rows):
    folder = finished(tmp_path / "run", rows)
    assert is_over(folder) and not is_going_on(folder)
    later = os.stat(folder / "summary.json").st_mtime + 10.0
    os.utime(folder / "config.yaml", (later, later))  # as --resume writes it again
    assert not is_over(folder)


@pytest.mark.parametrize("place", range(3))
def test_a_run_goes_on_as_long_as_one_of_its_locks_is_held(tmp_path, place):
    folder = aged(run_folder(tmp_path / "run", None))
    held = locks.try_lock(locks.of_run(folder)[place])
    assert is_going_on(folder)
    held.release()
    assert not is_going_on(folder) and not is_over(folder)


def test_the_lock_of_a_job_is_found_from_within_the_run(tmp_path, monkeypatch):
    folder = aged(run_folder(tmp_path / "run", None))
    held = locks.try_lock(locks.job_lock(folder))
    monkeypatch.chdir(folder)
    assert is_going_on(folder.relative_to(folder))
    held.release()


def test_a_run_without_locks_goes_on_as_long_as_its_files_grow(tmp_path):
    folder = aged(run_folder(tmp_path / "run", None))
    assert not is_going_on(folder)
    (folder / "training_state.json").write_text("{}")
    assert is_going_on(folder)


def test_a_run_without_locks_whose_files_rest_goes_on_as_long_as_it_is_heard(tmp_path):
    folder = aged(run_folder(tmp_path / "run", None))
    assert is_going_on(folder, lambda: True) and not is_going_on(folder, lambda: False)
    held = locks.try_lock(locks.of_run(folder)[0])
    held.release()
    assert not is_going_on(folder, lambda: True)  # its lock tells


def test_only_a_lock_tells_that_a_run_has_stopped(tmp_path, monkeypatch):
    folder = aged(run_folder(tmp_path / "run", None))
    monkeypatch.setattr("rtg.view.activity.time.time", lambda: LONG_AGO + 70.0)
    assert state(folder) == "no news for 70 s, and no lock tells whether the run goes on"
    held = locks.try_lock(locks.of_run(folder)[0])
    assert state(folder) == "the run goes on"
    held.release()
    assert state(folder) == "the run was not finished (it has no summary.json)"


def test_a_learner_without_locks_ends_with_its_results(tmp_path, rows):
    folder = run_folder(tmp_path / "run", rows)
    learn(folder)
    assert is_over(folder) and not is_going_on(folder)


def test_a_run_that_has_learned_but_has_no_summary_is_not_over(tmp_path, rows):
    folder = run_folder(tmp_path / "run", rows)
    learn(folder)
    with locks.exclusive_lock(folder, "a run"):
        assert is_going_on(folder)
    assert not is_over(folder) and not is_going_on(folder)


def test_a_run_of_the_graph_script_ends_with_the_results_of_its_learner(tmp_path, rows):
    folder = run_folder(tmp_path / "run", rows)
    held = locks.try_lock(folder / locks.GRAPH_LOCK)
    assert is_going_on(folder)
    learn(folder)
    held.release()
    assert is_over(folder) and not is_going_on(folder)
