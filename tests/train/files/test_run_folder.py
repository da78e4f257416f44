"""summary.json and the other files of the run folder."""

import errno
import os
import re
from pathlib import Path

import pytest
from rtg import _core, paths
from rtg.errors import RunError, UserError
from rtg.files import checkpoint, dataset, replay_gaps, run_folder, whole_files

CONFIG = _core.Config.from_file(paths.CONFIG / "gathering.yaml", ["run.seed=7", "run.workers=2"])


def write_parts(folder):
    report = {"transitions": 100, "contact_share": 0.5, "replay_gaps": [0.1], "nodes": [1]}
    run_folder.write_json(folder / "generation.json", report)
    training = {"interactions": 400, "success_rate": 0.25, "worker_restarts": 3, "epsilon": 0.1}
    run_folder.write_json(folder / "training.json", training)


def test_the_summary_merges_both_halves_and_what_was_measured(tmp_path):
    write_parts(tmp_path)
    measured = {"worker_restarts": 2, "counters": {}}
    summary = run_folder.summary(tmp_path, CONFIG, "lcm", measured)
    assert tuple(summary)[: len(run_folder.SUMMARY_KEYS)] == run_folder.SUMMARY_KEYS
    known = {key: value for key, value in summary.items() if value is not None}
    assert known == {
        "task": "gathering",
        "method": "ddqn_rtg",
        "seed": 7,
        "mode": "lcm",
        "workers": 2,
        "transitions": 100,
        "contact_share": 0.5,
        "interactions": 400,
        "success_rate": 0.25,
        "worker_restarts": 3,  # the learner knows better than the display
        "counters": {},
        "epsilon": 0.1,
        "replay_gap_counts": replay_gaps.counts([0.1]),
    }


def test_gaps_are_counted_in_bins_of_the_same_ratio():
    counts = replay_gaps.counts([0.0, 1e-4, 0.0099, 0.0101, 99.0])
    assert {at: count for at, count in enumerate(counts) if count} == {0: 2, 39: 1, 40: 1, 99: 1}


def test_the_summary_of_a_run_without_learner_has_nulls_in_its_place(tmp_path):
    run_folder.write_json(tmp_path / "generation.json", {"transitions": 100})
    summary = run_folder.summary(tmp_path, CONFIG, "in_process", {})
    assert summary["success_rate"] is None and summary["train_wall_s"] is None


def test_the_summary_has_the_keys_that_are_promised():
    contract = """task, method, seed, mode, workers, transitions, tree_transitions,
    branch_transitions, contact_share, multi_body_share, headings_per_state,
    trees, starts_reached, start_depth, replays, candidates, pruned, converged,
    iterations_median, iterations_p90, replay_gap_median, replay_gap_p90, reverse_cpu_s,
    replay_cpu_s, generate_cpu_s, generate_wall_s, train_cpu_s, train_wall_s, interactions,
    online_successes, success_rate, episode_length_mean, episode_return_mean, q_rank_correlation,
    q_error, q_spread"""
    assert set(re.findall(r"\w+", contract)) == set(run_folder.SUMMARY_KEYS)


def test_every_key_of_the_contract_is_explained():
    page = (paths.ROOT / "train/SUMMARY.md").read_text()
    assert [key for key in run_folder.SUMMARY_KEYS if f"`{key}`" not in page] == []


def test_a_file_is_replaced_whole_or_not_at_all(tmp_path):
    file = tmp_path / "summary.json"
    run_folder.write_json(file, {"a": 1})
    with pytest.raises(TypeError):
        run_folder.write_json(file, {"a": object()})
    assert run_folder.read_json(file) == {"a": 1}
    assert [path.name for path in tmp_path.iterdir()] == ["summary.json"]


def test_two_runs_of_one_second_have_two_folders(tmp_path, monkeypatch):
    monkeypatch.setattr(paths, "RUNS", tmp_path)
    monkeypatch.setattr(run_folder.time, "strftime", lambda _: "20260101-000000")
    first = run_folder.default_path("gathering")
    first.mkdir()
    second = run_folder.default_path("gathering")
    assert (first.name, second.name) == ("gathering-20260101-000000", "gathering-20260101-000000-2")


@pytest.mark.parametrize("text", ["", '{"trans', "[]"])
def test_a_damaged_report_is_named(text, tmp_path):
    file = tmp_path / "generation.json"
    file.write_text(text)
    with pytest.raises(UserError) as error:
        run_folder.read_json(file)
    assert (
        str(error.value) == f"{file}: is damaged; legal: the file as the run wrote it, or no file"
    )


def test_a_run_has_the_name_that_it_was_given_or_that_of_its_folder(tmp_path):
    assert run_folder.run_name(tmp_path) == tmp_path.name
    run_folder.write_run_name(tmp_path, "gathering-a1b2c3d4")
    assert run_folder.run_name(tmp_path) == "gathering-a1b2c3d4"


def test_the_newest_run_is_the_one_that_began_last(tmp_path, monkeypatch):
    monkeypatch.setattr(paths, "RUNS", tmp_path)
    with pytest.raises(UserError, match="holds no run; legal: the folder of a run"):
        run_folder.newest()
    for age, name in enumerate(("second", "first"), 1):
        (tmp_path / name).mkdir()
        config = tmp_path / name / "config.yaml"
        config.touch()
        os.utime(config, (1000 - age, 1000 - age))
    (tmp_path / "none").mkdir()
    assert run_folder.newest() == tmp_path / "second"


def told(folder, path):
    with pytest.raises(UserError) as error, run_folder.write_errors_as_user_errors(folder):
        path.open("r" if path.suffix == ".in" else "w")
    return str(error.value)


@pytest.mark.parametrize("name", ["out/new/file", "out", ".out.part/a", ".out.none/.lock"])
def test_an_error_of_the_target_is_one_of_the_flag(tmp_path, monkeypatch, name):
    folder = tmp_path / "out"
    folder.mkdir()
    begin = f"--out: {folder}: "
    assert told(folder, tmp_path / name).startswith(begin)
    monkeypatch.chdir(tmp_path)
    assert told(folder, Path(name)).startswith(begin)


def test_an_error_of_another_file_names_that(tmp_path):
    for name in ("font.in", "outer/font", ".outer.part/font", "none/out/file"):
        file = tmp_path / name
        assert told(tmp_path / "out", file) == (
            f"{file}: No such file or directory; legal: a file to read or write"
        )


def test_an_error_without_a_file_is_of_the_target(tmp_path):
    for error in (OSError("no number"), OSError(errno.EROFS, "read-only", 3)):
        with (
            pytest.raises(UserError, match=f"^--out: {tmp_path}: (no number|read-only); legal: "),
            run_folder.write_errors_as_user_errors(tmp_path),
        ):
            raise error


def test_no_input_is_to_blame_for_a_full_disk(tmp_path):
    with (
        pytest.raises(RunError, match=f"^{tmp_path}: full; to mend it: free some space on the"),
        run_folder.write_errors_as_user_errors(tmp_path),
    ):
        raise OSError(errno.ENOSPC, "full")


@pytest.mark.parametrize(
    "read",
    [dataset.read, checkpoint.read, run_folder.read_text, run_folder.read_json],
    ids=["transitions", "checkpoint", "text", "json"],
)
def test_few_descriptors_are_no_damage(tmp_path, monkeypatch, read):
    def exhausted(*_, **__):
        raise OSError(errno.EMFILE, "Too many open files", "codec.py")

    file = tmp_path / "file"
    file.touch()
    monkeypatch.setattr(whole_files, "opened", exhausted)
    with pytest.raises(RunError, match=f"^{file}: Too many open files; to mend it: allow more"):
        read(file)
