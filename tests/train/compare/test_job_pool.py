"""Runs of a comparison side by side; shell scripts stand in for `rtg run`."""

import dataclasses
import io
import json
import shlex

import pytest
from rtg.compare import job_pool
from rtg.compare.cell_run import CellRun, prepare_runs
from rtg.compare.cells import read_grid
from rtg.compare.executors.local import LocalExecutor
from rtg.compare.grid_display import PlainGrid
from rtg.compare.job_pool import Failures, JobPool
from rtg.compare.jobs import is_claimed, try_claim
from rtg.compare.reproduce_args import parse
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
        return JobPool(runs, LocalExecutor(), args.jobs, Failures(args.out))

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


@pytest.fixture
def elsewhere(comparison, monkeypatch):
    """Gives a pool of one run and the claim of another process on it."""
    monkeypatch.setattr(job_pool, "_LOOK_EVERY", 0.0)
    pool = comparison(1, SUCCEEDS)
    return pool, try_claim(pool._jobs[0])


def phases(pool):
    """Lets the pool look around once; returns whether it waits, and the phases."""
    with PlainGrid(io.StringIO()) as shown:
        waits = pool.poll(shown)
    return waits, [row.phase for row in pool.rows()]


def test_a_run_that_another_process_works_on_is_waited_for(elsewhere):
    pool, claim = elsewhere
    assert phases(pool) == phases(pool) == (True, ["elsewhere"])
    summary = pool._jobs[0].folder / "summary.json"
    summary.parent.mkdir()
    summary.write_text(json.dumps(SUMMARY))
    claim.close()
    assert phases(pool) == (False, ["done"])
    assert pool.rows()[0].words == "success 0.50 after 400 interactions"
    assert not pool._jobs[0].log.exists()


def test_a_run_whose_other_process_was_stopped_is_taken_over(elsewhere):
    pool, claim = elsewhere
    phases(pool)
    claim.close()
    assert phases(pool) == (True, ["running"])
    assert is_claimed(pool._jobs[0])
    finish(pool)
    assert [row.phase for row in pool.rows()] == ["done"] and not is_claimed(pool._jobs[0])


def test_a_run_that_failed_in_another_process_has_failed(elsewhere, tmp_path):
    pool, claim = elsewhere
    phases(pool)
    Failures(tmp_path / "out").add(pool._jobs[0].name, "no memory")
    claim.close()
    assert phases(pool) == (False, ["failed"]) and pool.rows()[0].words == "no memory"
    assert not pool._jobs[0].log.exists()


def test_a_failure_of_an_earlier_command_does_not_count(elsewhere, tmp_path):
    pool, claim = elsewhere
    Failures(tmp_path / "out").add(pool._jobs[0].name, "no memory")
    assert phases(pool) == (True, ["elsewhere"])
    claim.close()
    assert phases(pool) == (True, ["running"])
    finish(pool)
    assert [row.phase for row in pool.rows()] == ["done"]


def test_a_run_waits_for_transitions_that_another_process_generates(elsewhere, monkeypatch):
    pool, claim = elsewhere
    claim.close()
    run = pool._jobs[0]
    monkeypatch.setattr(CellRun, "pending_generation_key", "the same")
    other = dataclasses.replace(run, folder=run.folder.with_name("seed-9"))
    claim = try_claim(other)
    assert phases(pool) == (True, ["elsewhere"])
    monkeypatch.setattr(CellRun, "pending_generation_key", None)
    claim.share_transitions()
    assert phases(pool) == (True, ["running"]) and is_claimed(other)
    claim.close()
    finish(pool)
