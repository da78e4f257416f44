"""Comparisons as the user types them, on budgets that take seconds."""

import csv
import os
import subprocess
import sys
import time

from rtg import paths

PATIENCE = 300.0  # [s]; longer is a hang
SMALL = (
    "search.transitions=1500",
    "search.breadth=8",
    "search.depth=4",
    "train.interactions=600",
    "train.transitions_before_learning=500",
    "train.batch=32",
    "train.eval_every=200",
    "train.eval_episodes=2",
    "train.checkpoint_every=100",
)
WORDS = ["--quick", "--methods", "ddqn_naive", "--jobs", "2"]
WORDS += [word for setting in SMALL for word in ("--set", setting)]
TWO = ("gathering", "sorting")
HOW = {
    "start_wall_s",
    "run_wall_s",
    "run_cpu_s",
    "generate_wall_s",
    "generate_cpu_s",
    "train_wall_s",
    "train_cpu_s",
    "reverse_cpu_s",
    "replay_cpu_s",
    "runs_in_process",
}
COSTS = {"cpu_s", "cpu_s_to_95", "whole_cpu_s"}  # processor time, too


def command(folder, tasks=(), *words):
    return [sys.executable, "-m", "rtg", "reproduce", *tasks, *WORDS, *words, "--out", folder]


def start(folder, tasks=(), *words):
    return subprocess.Popen(
        command(folder, tasks, *words),
        cwd=paths.ROOT,
        env={**os.environ, "PYTHONPATH": str(paths.ROOT / "train")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def finish(process):
    out, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, err
    return out


def wait_for(condition, process):
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert process.poll() is None, process.stderr.read()
        assert time.monotonic() < deadline
        time.sleep(0.02)


def rows(folder, name="runs.csv"):
    """The rows of a table for programs, of which runs.csv has one for each run."""
    with (folder / name).open() as file:
        return list(csv.DictReader(file))


def figures(folder):
    """All numbers of the tables of TWO tasks but those on how they were come by."""
    both = [*rows(folder), *rows(folder, "curves.csv")]
    found = [row for row in both if row["task"] in TWO]
    assert set(found[0]) >= HOW
    return [{key: value for key, value in row.items() if key not in HOW | COSTS} for row in found]
