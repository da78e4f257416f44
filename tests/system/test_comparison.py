"""A whole comparison as the user types it, on three tasks and budgets that take seconds."""

import json
import signal

import pytest
from comparisons import PATIENCE, TWO, figures, finish, rows, start, wait_for
from living import processes_of, wait_until_all_are_gone


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("comparison") / "undisturbed"
    return folder, finish(start(folder))


def test_a_comparison_of_all_tasks_ends_with_a_report(undisturbed):
    folder, out = undisturbed
    assert out.splitlines()[-2:] == ["3 of 3 runs done, 0 running", f"report: {folder}/report.md"]
    assert [(run["task"], run["method"], run["interactions"]) for run in rows(folder)] == [
        (task, "ddqn_naive", "600") for task in ("gathering", "sorting", "art_manip")
    ]
    for name in ("curves_sorting.png", "strip_art_manip.png", "film_gathering.gif"):
        assert f"]({name})" in (folder / "report.md").read_text()


def test_the_reference_is_compared_with_its_rival(tmp_path):
    finish(start(tmp_path, ("gathering",), "--methods", "ddqn_naive,ddqn_rtg"))
    page = (tmp_path / "report.md").read_text()
    pooled, run_time = page.split("## All tasks together")[1].split("## Run time")
    rival, reference = (f"| `{method}` | 1 | 0.000 |" for method in ("ddqn_naive", "ddqn_rtg"))
    assert rival in pooled and reference in pooled
    assert "too few seeds to tell from `ddqn_naive`" in page.split("## Beside `ddqn_rtg`")[1]
    summary = json.loads((tmp_path / "gathering/ddqn_rtg/seed-1/summary.json").read_text())
    assert summary["pushing_converged"] > 0 and "| gathering | `ddqn_rtg` |" in run_time


def test_each_run_keeps_to_one_process(undisturbed):
    folder, _ = undisturbed
    summary = json.loads((folder / "sorting/ddqn_naive/seed-1/summary.json").read_text())
    assert (summary["workers"], summary["mode"]) == (1, "in_process")
    assert summary["runs_in_process"] == 1


def test_killed_and_begun_again_it_comes_to_the_same_figures(undisturbed, tmp_path):
    folder = tmp_path / "disturbed"
    process = start(folder, TWO)
    saved = folder / "gathering/ddqn_naive/seed-1/checkpoint/state.pt"
    wait_for(saved.exists, process)
    process.kill()
    process.communicate(timeout=PATIENCE)
    wait_until_all_are_gone(folder, PATIENCE)
    assert not (saved.parents[1] / "summary.json").exists()
    finish(start(folder, TWO))
    assert figures(folder) == figures(undisturbed[0])
    log = saved.parents[1].with_name("seed-1.log").read_text()
    assert "the transitions are there already" in log


def test_two_commands_share_the_work_and_the_report(undisturbed, tmp_path):
    """Each run has one process, and the report of the last has the runs of both."""
    one, other = start(tmp_path, TWO), start(tmp_path, ("sorting", "art_manip"))
    for process in (one, other):
        finish(process)
    logs = [log.read_text() for log in tmp_path.glob("*/ddqn_naive/seed-1.log")]
    assert len(logs) == 3 and all(log.count("seed 1: ") == 1 for log in logs)
    assert [run["task"] for run in rows(tmp_path)] == ["gathering", "sorting", "art_manip"]
    assert figures(tmp_path) == figures(undisturbed[0])


def test_a_command_takes_over_the_runs_of_one_that_is_killed(undisturbed, tmp_path):
    one = start(tmp_path, ("gathering",))
    wait_for((tmp_path / "gathering/ddqn_naive/seed-1/checkpoint/state.pt").exists, one)
    other = start(tmp_path, TWO)
    seen = other.stdout.readline()
    while "gathering/ddqn_naive/seed-1: elsewhere" not in seen:
        seen = other.stdout.readline()
        assert seen, other.stderr.read()
    one.kill()
    one.communicate(timeout=PATIENCE)
    assert "2 of 2 runs done" in finish(other)
    assert figures(tmp_path) == figures(undisturbed[0])


def test_seeds_that_learn_together_come_to_the_same_figures(undisturbed, tmp_path):
    methods = ("--methods", "ddqn,ddqn_naive", "--seeds", "1,2")
    out = finish(start(tmp_path, ("gathering",), *methods, "--together"))
    assert "gathering/ddqn: 2 seeds learn: done (learned)" in out
    assert "gathering/ddqn_naive: 2 seeds learn: done (learned)" in out
    assert "4 of 4 runs done" in out
    for run in tmp_path.glob("gathering/*/seed-[12]"):
        assert json.loads((run / "summary.json").read_text())["runs_in_process"] == 2
    alone, found = (
        [row for row in figures(folder) if (row["task"], row["seed"]) == ("gathering", "1")]
        for folder in (undisturbed[0], tmp_path)
    )
    assert [row for row in found if row["method"] == "ddqn_naive"] == alone


def test_runs_that_differ_in_the_learner_share_their_transitions(undisturbed, tmp_path):
    sweep = ("--sweep", "train.batch=32,16")
    finish(start(tmp_path, ("gathering",), *sweep))
    runs = [tmp_path / f"gathering/ddqn_naive@train.batch={batch}/seed-1" for batch in (32, 16)]
    logs = [run.with_name("seed-1.log").read_text() for run in runs]
    assert [("the transitions are there already" in log) for log in logs] == [False, True]
    assert runs[0].joinpath("transitions.npz").samefile(runs[1] / "transitions.npz")
    alone = [row for row in figures(undisturbed[0]) if row["task"] == "gathering"]
    found = [row for row in figures(tmp_path) if row["method"].endswith("=32")]
    assert [{**row, "method": "ddqn_naive"} for row in found] == alone


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_stops_all_runs_and_says_how_to_go_on(tmp_path, number):
    folder = tmp_path / "stopped"
    process = start(folder, TWO, "--set", "train.interactions=1000000")
    wait_for((folder / "sorting/ddqn_naive/seed-1/training_state.json").exists, process)
    process.send_signal(number)
    _, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 1
    assert err.startswith("rtg: stopped; to go on: ./run.sh reproduce gathering sorting --quick ")
    assert err.endswith(f" --out {folder}\n")
    assert processes_of(folder) == {}
    assert json.loads((folder / "grid.json").read_text())["failed"] == {}
