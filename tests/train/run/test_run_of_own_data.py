"""Runs that learn from transitions of one's own: `--data`."""

import json

import numpy as np
import pytest
import rtg
from rtg.cli import main
from rtg.errors import UserError
from rtg.files import run_folder, versions
from rtg.run import run_args, shared_transitions
from rtg.run.plan import make_plan
from training_runs import TINY


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    task = rtg.load_task(TINY)
    path = tmp_path_factory.mktemp("data") / "mine.npz"
    rtg.Transitions.joined(rtg.generate(task, 600)).save(path)
    return path


def refused(capsys, *words):
    assert main([str(word) for word in words]) == 2
    return capsys.readouterr().err


def test_it_learns_from_them_and_goes_on_after_a_stop(file, tmp_path, capsys):
    out = tmp_path / "run"
    assert main([str(TINY), "--data", str(file), "--no-train", "--out", str(out)]) == 0
    said = capsys.readouterr().out
    words = f"600 transitions of mine.npz (SHA-256 {versions.digest(file)[:12]}…)"
    assert words in said and "own data" in said
    stored = (out / "transitions.npz").read_bytes()
    assert main(["--resume", "--out", str(out), "--interactions", "200"]) == 0
    assert (out / "transitions.npz").read_bytes() == stored
    summary = json.loads((out / "summary.json").read_text())
    with np.load(out / "transitions.npz") as rows:
        successes = int(rows["terminated"].sum())
    assert summary["data"] == {
        "format": "npz",
        "name": "mine.npz",
        "sha256": versions.digest(file),
        "transitions": 600,
        "successes": successes,
        "at_start": 0,
    }
    assert summary["mode"] is None and summary["trees"] is None
    assert (summary["transitions"], summary["offline_transitions"]) == (600, 600)
    said = capsys.readouterr().out
    assert words in said and "own data mine.npz, seed 1" in said
    assert ("bottleneck: " in said) == (summary["success_rate"] < 0.9)


def test_the_data_of_another_run_are_learned_from(file, tmp_path):
    first = tmp_path / "first"
    make_plan(run_args.parse([str(TINY), "--data", str(file), "--out", str(first)]))
    for number, word in enumerate((first, first / "transitions.npz")):
        out = tmp_path / f"{number}"
        make_plan(run_args.parse([str(TINY), "--data", str(word), "--out", str(out)]))
        assert versions.digest(out / "transitions.npz") == versions.digest(
            first / "transitions.npz"
        )
        told = run_folder.read_json(out / "generation.json")["data"]
        assert (told["format"], told["name"]) == ("run", "first/transitions.npz")
        assert told["sha256"] == versions.sealed_digest(first / "transitions.npz")


def test_a_run_without_transitions_is_refused_and_leaves_nothing(tmp_path, capsys):
    (tmp_path / "config.yaml").touch()
    said = refused(capsys, TINY, "--out", tmp_path / "run", "--data", tmp_path)
    assert f"--data {tmp_path}: holds no transitions; legal: " in said
    assert not (tmp_path / "run").exists()


def test_that_data_without_a_success_do_not_suffice_is_said(tmp_path, file, capsys):
    with np.load(file) as found:
        arrays = {name: found[name] for name in ("states", "actions", "next_states")}
    failed = ~rtg.Transitions.load(file, rtg.load_task(TINY)).success
    failures = tmp_path / "failures.npz"
    np.savez(failures, **{name: values[failed] for name, values in arrays.items()})
    out = tmp_path / "run"
    assert main([str(TINY), "--data", str(failures), "--no-train", "--out", str(out)]) == 0
    assert "bottleneck: goal: none of " in capsys.readouterr().out


def test_flags_that_contradict_it_are_refused_and_leave_nothing(file, tmp_path, capsys):
    out = tmp_path / "run"
    data = (TINY, "--out", out, "--data", file)
    assert "--transitions 5: has no effect, as the transitions are those of --data" in refused(
        capsys, *data, "--transitions", 5
    )
    assert "--generator rrbs: has no effect" in refused(capsys, *data, "--generator", "rrbs")
    assert f"--data {file}: has no effect, as run.method ddqn generates no transitions" in refused(
        capsys, *data, "--method", "ddqn"
    )
    assert not out.exists()


def test_what_is_no_data_set_of_minari_is_refused_and_leaves_nothing(tmp_path, capsys):
    pytest.importorskip("minari", reason="the extra `minari` is not installed")
    said = refused(capsys, TINY, "--out", tmp_path / "run", "--data", "no/such-v0")
    assert "--data no/such-v0: no such file or data set; legal: a .npz with states" in said
    assert not (tmp_path / "run").exists()


def test_what_cannot_be_read_is_refused_and_leaves_nothing(tmp_path, capsys):
    out = tmp_path / "run"
    said = refused(capsys, TINY, "--out", out, "--data", tmp_path / "none.npz")
    assert "none.npz: no such file; legal: a .npz of numpy with states" in said
    (tmp_path / "text.npz").write_text("text")
    said = refused(capsys, TINY, "--out", out, "--data", tmp_path / "text.npz")
    assert "text.npz: is not a transition file" in said
    assert not out.exists()


def test_a_resumed_run_has_its_data_already(file, tmp_path):
    out = tmp_path / "run"
    make_plan(run_args.parse([str(TINY), "--data", str(file), "--out", str(out)]))
    with pytest.raises(UserError, match=r"--resume goes on with the transitions of .*legal: no"):
        run_args.parse(["--resume", "--out", str(out), "--data", str(file)])
    assert make_plan(run_args.parse(["--resume", "--out", str(out)])).is_generated()


def test_lost_or_changed_transitions_are_not_replaced_by_a_search(file, tmp_path):
    out = tmp_path / "run"
    make_plan(run_args.parse([str(TINY), "--data", str(file), "--out", str(out)]))
    (out / "transitions.npz").write_bytes(b"changed")
    with pytest.raises(UserError, match="was changed since the run wrote it"):
        make_plan(run_args.parse(["--resume", "--out", str(out)]))
    for name in ("transitions.npz", "generation.json"):
        (out / name).unlink()
        with pytest.raises(UserError, match="is missing or not whole, and was given by --data"):
            make_plan(run_args.parse(["--resume", "--out", str(out)]))


def test_other_runs_do_not_take_them_for_generated_ones(file, tmp_path):
    out = tmp_path / "method" / "seed-1"
    plan = make_plan(run_args.parse([str(TINY), "--data", str(file), "--out", str(out)]))
    assert plan.is_generated()
    key = shared_transitions.generation_key(plan.config)
    assert shared_transitions.find(key, tmp_path, "seed-1") is None


def test_an_exported_data_set_of_minari_is_learned_from(file, tmp_path, monkeypatch):
    pytest.importorskip("minari", reason="the extra `minari` is not installed")
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    first, second = tmp_path / "first", tmp_path / "second"
    make_plan(run_args.parse([str(TINY), "--data", str(file), "--out", str(first)]))
    assert main(["export", "minari", str(first), "--transitions"]) == 0
    id = "rtg/gathering/own-transitions-v0"
    make_plan(run_args.parse([str(TINY), "--data", id, "--out", str(second)]))
    told = run_folder.read_json(second / "generation.json")["data"]
    assert (told["format"], told["name"], told["transitions"]) == ("minari", id, 600)
    with np.load(first / "transitions.npz") as one, np.load(second / "transitions.npz") as other:
        order = np.lexsort((one["step"], one["episode"]))
        for name in ("poses", "action", "next_poses", "terminated", "source", "observation"):
            assert np.array_equal(one[name][order], other[name])
