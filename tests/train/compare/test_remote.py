"""Jobs of a comparison on another machine; shell scripts stand in for `rtg run`."""

import json

import pytest
from rtg.compare.cell_run import CellRun, prepare_runs
from rtg.compare.executors.executor import TAKEN
from rtg.compare.executors.remote import RemoteJob, carry_out, is_free
from rtg.compare.jobs import is_claimed, try_claim
from rtg.compare.reproduce_args import parse
from rtg.errors import RunError, UserError
from training_runs import TINY


@pytest.fixture
def run(tmp_path):
    words = [str(TINY), "--methods", "ddqn_rtg", "--seeds", "1", "--out", str(tmp_path)]
    return prepare_runs(parse(words))[0]


@pytest.fixture
def script(monkeypatch):
    """Sets what the job does."""

    def does(words):
        monkeypatch.setattr(CellRun, "command", lambda run: ["sh", "-c", words])

    return does


def test_a_job_is_claimed_while_it_runs_and_free_afterwards(run, script, tmp_path):
    lock = run.folder.with_name(".seed-1.lock")
    script(f"flock --nonblock {lock} true; echo $?; exit 3")
    assert carry_out(run) == 3
    assert run.log.read_text() == "1\n" and not is_claimed(run)


def test_a_job_of_another_process_is_left_alone(run, script):
    script("exit 3")
    claim = try_claim(run)
    assert carry_out(run) == TAKEN and not run.log.exists()
    claim.close()


def test_a_job_that_is_done_is_left_alone(run, script):
    script("exit 3")
    run.folder.mkdir(parents=True)
    summary = {"success_rate": 0.5, "interactions": 400}
    (run.folder / "summary.json").write_text(json.dumps(summary))
    assert carry_out(run) == 0


def test_what_keeps_a_job_from_starting_is_in_its_log(run, monkeypatch):
    def refuse(run):
        raise UserError("no such task")

    monkeypatch.setattr(CellRun, "command", refuse)
    assert carry_out(run) == 2
    assert run.log.read_text() == "rtg: no such task\n" and not is_claimed(run)


class Lost(RemoteJob):
    """A job whose cluster says nothing at first and then that it has lost it."""

    polls = 0

    def _poll(self):
        self.polls += 1
        if self.polls > 1:
            raise RunError("its machine is gone")

    def stop(self):
        pytest.fail("is not asked for")

    kill = stop


def test_a_job_that_its_cluster_has_lost_has_failed(run):
    lost = Lost(run)
    assert lost.exit_status() is None
    assert lost.wait(60.0) and lost.exit_status() == 1
    assert lost.exit_text() == "tiny/ddqn_rtg/seed-1 was lost: its machine is gone"


def test_the_words_of_a_job_are_those_since_its_start(run):
    run.log.parent.mkdir(parents=True)
    run.log.write_text("of an earlier start\n")
    job = Lost(run)
    assert job.log_tail() == ""
    run.log.write_text(run.log.read_text() + "one\ntwo\n")
    assert job.log_tail() == "one\ntwo" and job.log_tail(lines=1) == "two"


def test_only_what_is_free_and_not_done_is_worth_a_place_in_the_queue(run):
    assert is_free(run)
    claim = try_claim(run)
    assert not is_free(run)
    claim.close()
    run.folder.mkdir()
    summary = {"success_rate": 0.5, "interactions": 400}
    (run.folder / "summary.json").write_text(json.dumps(summary))
    assert not is_free(run)
