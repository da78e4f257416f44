"""Runs of a comparison side by side; shell scripts stand in for `rtg run`."""

import io
import json
import shlex

import pytest
from rtg import cli
from rtg.compare.cell_run import CellRun, prepare_runs
from rtg.compare.cells import read_grid
from rtg.compare.grid_display import PlainGrid
from rtg.compare.reproduce import Failures, JobPool
from rtg.compare.reproduce_args import parse
from rtg.files import run_folder
from rtg.run import effective_config, run_args
from training_runs import TINY

SUMMARY = {"success_rate": 0.5, "interactions": 400}
SUCCEEDS = (
    "mkdir -p $OUT; cp $CONFIG $OUT/config.yaml; "
    f"echo {shlex.quote(json.dumps(SUMMARY))} > $OUT/summary.json"
)
FAILS = "echo working; echo no memory; exit 3"


@pytest.fixture
def comparison(tmp_path, monkeypatch):
    """Gives a pool for three seeds whose runs do what the scripts say, one script each."""

    def make(jobs, *scripts):
        words = [str(TINY), "--methods", "ddqn_rtg", "--seeds", str(len(scripts))]
        args = parse([*words, "--jobs", str(jobs), "--out", str(tmp_path / "out")])
        runs = prepare_runs(args)
        for run, script in zip(runs, scripts, strict=True):
            config = tmp_path / f"{run.cell.seed}.yaml"
            parsed = run_args.parse(run.arguments)
            config.write_text(effective_config.load(parsed.file, parsed.overrides).yaml)
            places = f"OUT={shlex.quote(str(run.folder))}; CONFIG={shlex.quote(str(config))}"
            commands[run.folder] = ["sh", "-c", f"{places}; {script}"]
        return JobPool(runs, args.jobs, Failures(read_grid(args.out), args.out))

    commands = {}
    monkeypatch.setattr(CellRun, "command", lambda run: commands[run.folder])
    return make


def finish(pool):
    """The most runs that were ever at work together."""
    most = 0
    with PlainGrid(io.StringIO()) as shown:
        while pool.poll(shown):
            most = max(most, [row.phase for row in pool.rows()].count("running"))
            pool.wait(0.05)
    return most


def test_a_run_that_fails_leaves_the_others_alone_and_says_why(comparison, tmp_path):
    pool = comparison(1, SUCCEEDS, FAILS, SUCCEEDS)
    assert finish(pool) == 1
    assert [row.phase for row in pool.rows()] == ["done", "failed", "done"]
    assert pool.rows()[0].words == "success 0.50 after 400 interactions"
    name = "tiny/ddqn_rtg/seed-2"
    words = f"{name} ended with exit status 3; the end of its log:\nworking\nno memory"
    assert pool.rows()[1].words == words
    assert read_grid(tmp_path / "out").failure_by_name == {name: words}


def test_of_a_run_that_ended_without_a_word_earlier_words_are_not_repeated(comparison, tmp_path):
    finish(comparison(1, FAILS))
    pool = comparison(1, "kill -9 $$")
    finish(pool)
    assert pool.rows()[0].words == "tiny/ddqn_rtg/seed-1 was killed by SIGKILL"


def test_a_run_that_cannot_start_leaves_the_others_alone(comparison, tmp_path):
    pool = comparison(1, SUCCEEDS, SUCCEEDS)
    label = tmp_path / "out/tiny/ddqn_rtg/seed-1.log"
    label.mkdir(parents=True)
    finish(pool)
    assert [row.phase for row in pool.rows()] == ["failed", "done"]
    assert "seed-1.log" in pool.rows()[0].words


def test_a_failed_run_gets_another_chance_and_a_done_one_is_left(comparison, tmp_path):
    finish(comparison(2, SUCCEEDS, FAILS))
    pool = comparison(2, "echo again; exit 1", SUCCEEDS)
    finish(pool)
    assert [row.phase for row in pool.rows()] == ["done", "done"]
    assert read_grid(tmp_path / "out").failure_by_name == {}


def test_so_many_are_at_work_as_there_are_jobs(comparison):
    assert finish(comparison(2, *[f"sleep 0.3; {SUCCEEDS}"] * 3)) == 2


def test_of_runs_that_need_the_same_transitions_one_generates_them(
    comparison, monkeypatch, tmp_path
):
    needs_transitions = property(lambda run: None if run.done else "the same")
    monkeypatch.setattr(CellRun, "pending_generation_key", needs_transitions)
    generates = shlex.quote(str(tmp_path / "generates"))
    alone = f"mkdir {generates} || exit 4; sleep 0.3; rmdir {generates}; {SUCCEEDS}"
    pool = comparison(3, alone, alone, alone)
    finish(pool)
    assert [row.phase for row in pool.rows()] == ["done"] * 3


def test_a_run_that_is_stopped_has_not_failed(comparison, tmp_path):
    pool = comparison(1, "echo begun; sleep 1000")
    with PlainGrid(io.StringIO()) as shown:
        pool.poll(shown)
        while "begun" not in (tmp_path / "out/tiny/ddqn_rtg/seed-1.log").read_text():
            pool.wait(0.05)
    pool.stop()
    assert read_grid(tmp_path / "out").failure_by_name == {}
    assert pool.rows()[0].phase == "running"


def test_two_commands_do_not_work_in_one_folder(tmp_path, capsys):
    with run_folder.exclusive_lock(tmp_path, "nobody"):
        assert cli.main(["reproduce", str(TINY), "--out", str(tmp_path)]) == 2
    assert "another reproduce uses this folder" in capsys.readouterr().err


@pytest.mark.parametrize("folder", ["/proc/rtg", "/proc"])
def test_a_folder_that_cannot_be_written_is_named(folder, capsys):
    assert cli.main(["reproduce", str(TINY), "--out", folder]) == 2
    assert capsys.readouterr().err.startswith(f"rtg: --out: {folder}: ")
