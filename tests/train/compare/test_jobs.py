"""Who works on which job."""

import os
import sys

import pytest
from rtg.compare.cell_run import CellRun, prepare_runs
from rtg.compare.jobs import is_claimed, try_claim
from rtg.compare.reproduce_args import parse
from rtg.files.locks import job_lock
from rtg.processes.children import Node
from training_runs import TINY


@pytest.fixture
def runs(tmp_path):
    words = [str(TINY), "--methods", "ddqn_naive", "--seeds", "1,2", "--out", str(tmp_path)]
    return prepare_runs(parse([*words, "--sweep", "train.batch=8,16"]))


def test_a_job_has_one_process(runs):
    claim = try_claim(runs[0])
    assert try_claim(runs[0]) is None and is_claimed(runs[0])
    claim.close()
    claim.close()
    assert not is_claimed(runs[0])


def test_who_asks_for_a_claim_takes_none(runs):
    assert not is_claimed(runs[0])
    assert not any(job_lock(folder).exists() for folder in runs[0].folders)


def test_runs_of_other_seeds_are_independent(runs):
    assert try_claim(runs[0]) and try_claim(runs[1])


def test_runs_with_the_same_transitions_wait_until_they_are_generated(runs, monkeypatch):
    claim, other = try_claim(runs[0]), runs[2]
    assert other.pending_generation_key == runs[0].pending_generation_key
    claim.share_transitions()
    assert is_claimed(other)
    monkeypatch.setattr(CellRun, "pending_generation_key", None)
    claim.share_transitions()
    monkeypatch.undo()
    assert not is_claimed(other) and is_claimed(runs[0])


def test_what_cannot_be_claimed_as_a_whole_is_not_claimed_at_all(runs, tmp_path):
    claim = try_claim(runs[2])
    assert try_claim(runs[0]) is None  # as its transitions are being generated
    claim.close()
    assert not is_claimed(runs[0])


def test_a_claim_lasts_as_long_as_the_process_that_inherits_it(runs, tmp_path):
    claim = try_claim(runs[0])
    wait = [sys.executable, "-c", "import signal; signal.pause()"]
    node = Node("heir", wait, tmp_path / "log", claim.descriptors)
    for descriptor in claim.descriptors:  # as at the death of this process
        os.close(descriptor)
    assert is_claimed(runs[0])
    node.kill()
    assert node.wait(60.0) and not is_claimed(runs[0])
