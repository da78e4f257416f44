"""The folder of one run: what it was made from, and its summary."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from rtg import _core, paths
from rtg.errors import UserError
from rtg.files import replay_gaps

# What summary.json holds at least, null where a part did not run; train/SUMMARY.md explains it.
SUMMARY_KEYS = (
    "task",
    "method",
    "seed",
    "mode",
    "workers",
    "transitions",
    "tree_transitions",
    "branch_transitions",
    "contact_share",
    "multi_body_share",
    "headings_per_state",
    "start_region_transitions",
    "start_region_depth",
    "trees",
    "replays",
    "candidates",
    "pruned",
    "converged",
    "iterations_median",
    "iterations_p90",
    "replay_gap_median",
    "replay_gap_p90",
    "reverse_cpu_s",
    "replay_cpu_s",
    "generate_cpu_s",
    "generate_wall_s",
    "train_cpu_s",
    "train_wall_s",
    "interactions",
    "online_successes",
    "success_rate",
    "episode_length_mean",
    "episode_return_mean",
    "q_rank_correlation",
    "q_error",
    "q_spread",
    "lost_transitions",
)
# Samples behind the pictures, too long for a summary.
_SAMPLES = ("replay_gaps", "nodes")


@contextlib.contextmanager
def writing_to(folder: Path) -> Iterator[None]:
    """Tells what the disk refuses as a mistake of --out. Raises UserError."""
    try:
        yield
    except OSError as error:
        raise UserError(f"--out: {folder}: {error.strerror}; legal: a folder to write to") from None


@contextlib.contextmanager
def alone(folder: Path, other: str) -> Iterator[None]:
    """No two processes work in the folder, which exists. Raises UserError if `other` does."""
    with writing_to(folder):
        directory = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(directory, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise UserError(f"--out: {folder}: {other} works there; wait for it") from None
        yield
    finally:
        os.close(directory)


def checkpoint_file(run: Path) -> Path:
    """Where the learner goes on from, once it has been stopped."""
    return run / "checkpoint" / "state.pt"


def write_text(path: Path, text: str) -> None:
    """Replaces the file at once or not at all, also if the machine goes down."""
    draft = path.with_name(f".{path.name}.{os.getpid()}")
    with draft.open("w") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    draft.replace(path)


def write_json(path: Path, value: Any) -> None:
    """Indented, keys in the given order, in one step."""
    write_text(path, json.dumps(value, indent=2, ensure_ascii=False) + "\n")


def read_json(path: Path) -> dict[str, Any]:
    """Empty if there is no such file. Raises UserError if it is damaged."""
    if not path.is_file():
        return {}
    try:
        value = json.loads(path.read_text())
    except ValueError:
        value = None
    if not isinstance(value, dict):
        raise UserError(f"{path}: damaged; legal: as the run left it, or none")
    return value


def result(run: Path) -> dict[str, Any]:
    """summary.json of a run that has learned to its end; of any other, empty. Raises UserError if
    it is damaged."""
    found = read_json(run / "summary.json")
    if found.get("interactions") is None:
        return {}
    if not isinstance(found.get("success_rate"), float):
        raise UserError(f"{run / 'summary.json'}: no success_rate; legal: as the run left it")
    return found


def default_path(task: str) -> Path:
    """runs/TASK-TIME, with a number behind it if that second has one already."""
    base = paths.RUNS / f"{task}-{time.strftime('%Y%m%d-%H%M%S')}"
    path, count = base, 1
    while path.exists():
        count += 1
        path = base.with_name(f"{base.name}-{count}")
    return path


def summary(
    run: Path, config: _core.Config, mode: str | None, measured: dict[str, Any]
) -> dict[str, Any]:
    """Generation and training merged; the contract's keys first, then what else was counted."""
    generation = read_json(run / "generation.json") if config.train.offline else {}
    known: dict[str, Any] = {
        **{key: value for key, value in generation.items() if key not in _SAMPLES},
        **measured,
        **read_json(run / "training.json"),
        "task": config.task.name,
        "method": config.run.method,
        "seed": config.run.seed,
        "workers": config.run.workers,
        "mode": mode,
    }
    first = {key: known.get(key) for key in SUMMARY_KEYS}
    rest = {key: value for key, value in known.items() if key not in first}
    gaps = generation.get("replay_gaps", [])
    return {**first, **rest, **({"replay_gap_counts": replay_gaps.counts(gaps)} if gaps else {})}
