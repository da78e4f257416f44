"""Comparisons whose runs are jobs of a cluster come to the figures of this machine."""

import os
import signal
import sys

import network
import pytest
from comparisons import PATIENCE, command, figures, finish, start, wait_for
from living import processes_of
from rtg import paths

RUNS = ("--seeds", "1,2", "--set", "train.interactions=1500", "--set", "search.shards=4")


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("local")
    finish(start(folder, ("gathering",), *RUNS))
    return folder


def assert_same(folder, undisturbed):
    """Figures, and transitions to the bit, each generation of which four jobs have found."""
    assert figures(folder) == figures(undisturbed)
    data = "gathering/ddqn_naive/seed-{}/transitions.npz"
    for seed in (1, 2):
        assert len(list((folder / "gathering/.shards").glob("*/[0-3]"))) == 8
        there, here = (place / data.format(seed) for place in (folder, undisturbed))
        assert there.read_bytes() == here.read_bytes()


def test_jobs_of_submitit(undisturbed, tmp_path):
    """Its cluster `local` is one of processes on this machine."""
    pytest.importorskip("submitit", reason="extra slurm")
    flags = ("--executor", "submitit", "--executor-option", "cluster=local")
    assert "2 of 2 runs done" in finish(start(tmp_path, ("gathering",), *RUNS, *flags))
    assert_same(tmp_path, undisturbed)


def test_a_preempted_job_of_submitit_goes_on_from_its_checkpoint(undisturbed, tmp_path):
    pytest.importorskip("submitit", reason="extra slurm")
    flags = ("--executor", "submitit", "--executor-option", "cluster=local")
    process = start(tmp_path, ("gathering",), *RUNS, "--seeds", "1", *flags)
    run = tmp_path / "gathering/ddqn_naive/seed-1"
    wait_for((run / "checkpoint/state.pt").exists, process)
    (job,) = (
        pid for pid, words in processes_of(tmp_path).items() if "submitit.core._submit" in words
    )
    os.kill(job, signal.SIGUSR2)  # as Slurm does
    assert "1 of 1 runs done" in finish(process)
    assert "learning goes on from its last checkpoint" in run.with_name("seed-1.log").read_text()
    assert figures(tmp_path) == [row for row in figures(undisturbed) if row["seed"] == "1"]


def test_tasks_of_a_ray_cluster_that_loses_a_node(undisturbed, tmp_path):
    pytest.importorskip("ray", reason="extra ray")
    network.require()
    flags = ("--executor", "ray", "--executor-option", "address=ADDRESS")
    runs = [tmp_path / f"gathering/ddqn_naive/seed-{seed}" for seed in (1, 2)]
    words = [sys.executable, paths.ROOT / "tests/system/ray_cluster.py"]
    words += [run / "checkpoint/state.pt" for run in runs]
    words += command(tmp_path, ("gathering",), *RUNS, *flags)
    python_path = str(paths.ROOT / "train")
    with network.Network() as loopback:
        process = loopback.start(words, PYTHONPATH=python_path, RAY_USAGE_STATS_ENABLED="0")
        out, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0 and "2 of 2 runs done" in out, out
    begun = [run.with_name(f"{run.name}.log").read_text().count("seed ") for run in runs]
    assert sorted(begun) == [1, 2]  # the run on the node that was killed went on elsewhere
    assert_same(tmp_path, undisturbed)
