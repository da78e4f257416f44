"""The folder of one run: what it was made from, and its summary."""

from __future__ import annotations

import importlib.metadata
import json
import os
import platform
import shutil
import subprocess
import time
from pathlib import Path
from typing import Any

from rtg import paths, replay_gaps
from rtg.errors import UserError

# What summary.json holds at least, null where a part did not run; train/SUMMARY.md explains it.
SUMMARY_KEYS = (
    "task",
    "method",
    "seed",
    "mode",
    "workers",
    "transitions",
    "contact_share",
    "multi_body_share",
    "start_region_transitions",
    "reachable_share",
    "tree_policy_success",
    "tree_policy_length_mean",
    "candidates",
    "pruned",
    "converged",
    "iterations_median",
    "iterations_p90",
    "replay_gap_median",
    "replay_gap_p90",
    "reverse_cpu_s",
    "replay_cpu_s",
    "generate_wall_s",
    "train_wall_s",
    "interactions",
    "online_successes",
    "success_rate",
    "episode_length_mean",
    "episode_return_mean",
    "lost_transitions",
)
# Samples behind the pictures, too long for a summary.
_SAMPLES = ("replay_gaps", "nodes")
_PACKAGES = ("torch", "stable-baselines3", "gymnasium", "numpy", "lcm")
_DEBIAN = ("g++", "libeigen3-dev", "libsuitesparse-dev", "libbox2d-dev", "libyaml-cpp-dev")


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


def _output(*command: str) -> str | None:
    if shutil.which(command[0]) is None:
        return None
    done = subprocess.run(command, cwd=paths.ROOT, capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else None


def _debian_version(package: str) -> str | None:
    return _output("dpkg-query", "-W", "-f=${Version}", package)


def _processor() -> str | None:
    """Model name of the processor, as Linux tells it."""
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else None


def git_revision() -> str | None:
    """The commit that is checked out; None without git."""
    return _output("git", "rev-parse", "HEAD")


def versions() -> dict[str, Any]:
    """What a run was made with; null where it cannot be told."""
    # But for results/, where the runs of the committed report are made.
    changes = _output(
        "git", "status", "--porcelain", "--untracked-files=no", "--", ".", ":!results"
    )
    return {
        "git_revision": git_revision(),
        "git_modified": None if changes is None else bool(changes),
        "python": platform.python_version(),
        "system": platform.platform(),
        "processors": os.cpu_count(),
        "processor": _processor(),
        "memory_gib": round(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 2**30),
        "packages": {name: importlib.metadata.version(name) for name in _PACKAGES},
        "debian": {name: _debian_version(name) for name in _DEBIAN},
    }


def summary(
    run: Path, config: dict[str, Any], mode: str | None, measured: dict[str, Any]
) -> dict[str, Any]:
    """Generation and training merged; the contract's keys first, then what else was counted."""
    generation = read_json(run / "generation.json") if config["train"]["offline"] else {}
    known: dict[str, Any] = {
        **{key: value for key, value in generation.items() if key not in _SAMPLES},
        **measured,
        **read_json(run / "training.json"),
        "task": config["task"]["name"] if isinstance(config["task"], dict) else config["task"],
        "method": config["run"]["method"],
        "seed": config["run"]["seed"],
        "workers": config["run"]["workers"],
        "mode": mode,
    }
    first = {key: known.get(key) for key in SUMMARY_KEYS}
    rest = {key: value for key, value in known.items() if key not in first}
    gaps = generation.get("replay_gaps", [])
    return {**first, **rest, **({"replay_gap_counts": replay_gaps.counts(gaps)} if gaps else {})}
