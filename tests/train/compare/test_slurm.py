"""Jobs of Slurm: a job is told to have ended when Slurm says so, also after it was cancelled."""

from types import SimpleNamespace

import pytest

pytest.importorskip("submitit", reason="extra slurm")

from rtg.compare.executors import slurm
from rtg.processes.children import stop_all


class Queue:
    """Stands in for a submitted job, whose cluster is asked for its state."""

    def __init__(self, result=None):
        self.ended, self.result_value = False, result
        self.cancelled, self.asked = 0, 0
        self.paths = SimpleNamespace(result_pickle=self)

    def exists(self):
        return self.ended and self.result_value is not None

    def done(self, force_check):
        self.asked += force_check
        return self.ended

    def exception(self):
        assert self.exists(), "would wait for the result"

    def result(self):
        return self.result_value

    def cancel(self, check):
        self.cancelled += 1


@pytest.fixture
def clock(monkeypatch):
    clock = SimpleNamespace(now=100.0, monotonic=lambda: clock.now)
    monkeypatch.setattr(slurm, "time", clock)
    return clock


def started(queue, tmp_path, pace=None):
    job = SimpleNamespace(name="a job", log=tmp_path / "log")
    return slurm._SlurmJob(job, queue, pace or slurm._Pace())


def test_a_cancelled_job_runs_until_its_cluster_says_that_it_has_ended(tmp_path):
    queue = Queue()
    job = started(queue, tmp_path)
    stop_all([job], grace=0.0)
    assert (queue.cancelled, job.exit_status()) == (1, None)
    queue.ended = True
    assert job.exit_status() == 1
    assert job.exit_text() == "a job was lost: it was cancelled"


def test_a_job_that_was_done_before_it_was_cancelled_keeps_its_status(tmp_path):
    queue = Queue(result=0)
    job = started(queue, tmp_path)
    job.stop()
    queue.ended = True
    assert job.exit_status() == 0


def test_a_job_that_has_ended_is_not_cancelled(tmp_path):
    queue = Queue(result=3)
    queue.ended = True
    job = started(queue, tmp_path)
    job.kill()
    assert (queue.cancelled, job.exit_status()) == (0, 3)


def test_slurm_is_asked_about_cancelled_jobs_now_and_then_for_all_at_once(tmp_path, clock):
    pace, queues = slurm._Pace(), [Queue(), Queue()]
    jobs = [started(queue, tmp_path, pace) for queue in queues]
    assert [job.exit_status() for job in jobs] == [None, None]
    assert [queue.asked for queue in queues] == [0, 0]
    for job in jobs:
        job.stop()
    for now in (100.0, 101.0, 102.0):
        clock.now = now
        assert [job.exit_status() for job in jobs] == [None, None]
    assert sum(queue.asked for queue in queues) == 2
