"""What the files of a run folder tell, and when."""

import json

import numpy as np
import pytest
from rtg import _core
from rtg.errors import UserError
from rtg.files import checked_table
from rtg.view.run_events import BestEpisode, Evaluation, Gaps, RunEvents, Steps
from view_runs import GENERATION, LEARNING, episode, finished, generated, learn


def events(folder):
    return RunEvents(folder, _core.Config.from_file(folder / "config.yaml"))


def of(kind, found):
    return [event for event in found if isinstance(event, kind)]


def test_the_transitions_are_spread_over_the_time_of_the_generation(tmp_path, rows):
    found = of(Steps, events(generated(tmp_path / "run", rows)).new())
    assert np.concatenate([event.numbers for event in found]).tolist() == list(range(2000))
    assert np.array_equal(np.concatenate([event.rows.poses for event in found]), rows.poses)
    assert found[0].at == 0.0 and GENERATION * 0.9 < found[-1].at < GENERATION


def test_a_learner_in_the_same_process_begins_after_the_generation(tmp_path, rows):
    found = of(Evaluation, events(finished(tmp_path / "run", rows)).new())
    assert [event.at for event in found] == [GENERATION + wall for wall in LEARNING]
    assert [event.row["success_rate"] for event in found] == [0.4, 0.8]


def test_over_lcm_it_begins_with_it(tmp_path, rows):
    folder = generated(tmp_path / "run", rows, "run.in_process=false")
    learn(folder)
    assert [event.at for event in of(Evaluation, events(folder).new())] == list(LEARNING)


def test_the_replay_gaps_come_bit_by_bit(tmp_path, rows):
    found = of(Gaps, events(generated(tmp_path / "run", rows)).new())
    sizes = [len(event.gaps) for event in found]
    assert sizes == sorted(sizes) and sizes[-1] == 100 and len(set(sizes)) > 10
    assert found[-1].at == GENERATION


def test_the_episode_comes_last(tmp_path, rows):
    watched = events(finished(tmp_path / "run", rows))
    last = watched.new()[-1]
    assert isinstance(last, BestEpisode) and last.at == watched.end == GENERATION + LEARNING[-1]
    assert np.array_equal(last.states, episode()) and last.success and last.is_learned


def test_what_is_new_is_told_once(tmp_path, rows):
    folder = generated(tmp_path / "run", rows)
    watched = events(folder)
    assert of(Steps, watched.new())
    assert watched.new() == []
    learn(folder)
    assert len(of(Evaluation, watched.new())) == 2
    file = folder / "progress.csv"
    table = checked_table.plain(file.read_text())
    file.write_text(checked_table.checked(table + table.splitlines()[-1] + "\n"))
    assert len(of(Evaluation, watched.new())) == 1


def test_a_run_without_training_leaves_a_plan(tmp_path, rows):
    folder = generated(tmp_path / "run", rows)
    np.savez(folder / "best_episode.npz", poses=episode(), success=True)
    watched = events(folder)
    assert of(BestEpisode, watched.new()) == []  # the file may not be whole
    (folder / "summary.json").write_text("{}")
    (last,) = watched.new()
    assert isinstance(last, BestEpisode) and not last.is_learned


@pytest.mark.parametrize(
    "states", [np.zeros((0, 4, 3)), np.zeros((2, 3, 3)), np.zeros((2, 4))], ids=str
)
def test_an_episode_of_another_shape_is_refused(tmp_path, rows, states):
    folder = finished(tmp_path / "run", rows)
    np.savez(folder / "best_episode.npz", poses=states, success=True)
    with pytest.raises(UserError, match=r"best_episode\.npz: is damaged; legal: the file as"):
        events(folder).new()


def test_a_damaged_report_is_named(tmp_path, rows):
    folder = generated(tmp_path / "run", rows)
    (folder / "generation.json").write_text(json.dumps({"generate_wall_s": 1.0})[:-3])
    with pytest.raises(UserError, match=r"generation\.json: is damaged"):
        events(folder).new()


@pytest.mark.parametrize("text", ["wall_s\n1\n", "interactions\n1\n", "interactions,wall_s\n,1\n"])
def test_a_curve_that_lacks_interactions_or_times_is_named(tmp_path, rows, text):
    folder = generated(tmp_path / "run", rows)
    (folder / "progress.csv").write_text(text)
    with pytest.raises(UserError, match=r"progress\.csv: has other fields"):
        events(folder).new()


def test_a_report_of_another_kind_is_named(tmp_path, rows):
    folder = generated(tmp_path / "run", rows)
    (folder / "generation.json").write_text(json.dumps({"generate_wall_s": [1.0]}))
    with pytest.raises(UserError, match=r"generation\.json: has other fields"):
        events(folder).new()
