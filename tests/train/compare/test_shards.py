"""A generation in shards: its jobs, and the data that they make together."""

import sys
from pathlib import Path

import time_limit
from rtg.compare import reproduce_args, shards
from rtg.compare.cell_run import prepare_runs
from rtg.files import run_folder
from rtg.run import shared_transitions
from training_runs import TINY

SHARDS = 3


def runs(folder: Path, *words: str) -> list:
    given = ["--methods", "ddqn_naive", "--seeds", "1", "--out", str(folder)]
    given += ["--set", "search.transitions=400", "--set", f"search.shards={SHARDS}"]
    return prepare_runs(reproduce_args.parse([str(TINY), *given, *words]))


def do(job) -> None:
    job.log.parent.mkdir(parents=True, exist_ok=True)
    done = time_limit.run(*job.command())
    assert done.returncode == 0, done.stderr
    assert job.done


def test_the_shards_together_are_the_data_of_one_process(tmp_path: Path) -> None:
    (run,) = runs(tmp_path / "grid")
    parts, (merge,) = shards.stages([run])
    assert [part.name for part in parts] == [f"{run.name}: shard {k}" for k in range(SHARDS)]
    assert not merge.done and merge.pending_generation_key == run.generation_key
    for part in reversed(parts):
        assert not part.done
        do(part)
    do(merge)
    assert shared_transitions.is_generated(run.folder) and run.pending_generation_key is None
    assert shards.stages([run]) == ([], [])
    whole = tmp_path / "whole"
    alone = [*run.arguments, "--no-train", "--out", str(whole)]
    time_limit.run(sys.executable, "-m", "rtg", "run", *alone, check=True)
    name = "transitions.npz"
    assert (run.folder / name).read_bytes() == (whole / name).read_bytes()
    found, expected = (
        run_folder.read_json(folder / "generation.json") for folder in (run.folder, whole)
    )
    assert found["candidates"] == expected["candidates"] and found["nodes"] == expected["nodes"]


def test_runs_that_share_a_generation_share_its_shards(tmp_path: Path) -> None:
    both = runs(tmp_path, "--sweep", "train.batch=32,64")
    parts, merges = shards.stages(both)
    assert len(both) == 2 and len(parts) == SHARDS and [merge.run for merge in merges] == both[:1]


def test_a_generation_that_is_not_divided_has_none(tmp_path: Path) -> None:
    assert shards.stages(runs(tmp_path, "--set", "search.shards=1")) == ([], [])


def test_a_damaged_shard_is_refused(tmp_path: Path) -> None:
    (run,) = runs(tmp_path)
    parts, (merge,) = shards.stages([run])
    for part in parts:
        do(part)
    file = parts[1].run.folder / "transitions.npz"
    file.write_bytes(file.read_bytes()[:-1] + b"x")
    done = time_limit.run(*merge.command())
    assert done.returncode == 2 and str(file) in done.stderr
    assert not shared_transitions.is_generated(run.folder)
