"""The folder of one run: its text and JSON files, its summary."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from rtg import _core, errors, paths
from rtg.errors import UserError, raise_if_of_the_machine
from rtg.files import replay_gaps, whole_files

# Keys of every summary.json; train/SUMMARY.md explains them. A value that was not measured is null.
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
    "trees",
    "starts_reached",
    "start_depth",
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
)
# Keys of generation.json that summary.json leaves out: the data of pictures, which are too long,
# and what it has among "defects".
_LEFT_OUT = ("iterations", "pushing_iterations", "replay_gaps", "starts", "nodes", "shortfalls")

_SEAL = "sha256"  # the last member of a JSON object: see write_json()
_DIGITS = 64
_CONFIG_SEAL = "# SHA-256 of the lines above: "  # and the digits: the last line of config.yaml


@contextlib.contextmanager
def write_errors_as_user_errors(folder: Path) -> Iterator[None]:
    """Turns an OSError in the `with` block into a UserError about `folder` and --out.

    If the error names a file elsewhere, or is of the machine, it is told by errors.in_words().
    """
    try:
        yield
    except OSError as error:
        told, file = errors.in_words(error, folder), error.filename
        if not errors.is_of_the_machine(error) and (
            file is None or isinstance(file, int) or _belongs_to(Path(os.fsdecode(file)), folder)
        ):
            why = error.strerror or error
            told = UserError(f"--out: {folder}: {why}; legal: a folder to write to")
        raise told from None


def _belongs_to(file: Path, folder: Path) -> bool:
    """Returns whether `file` lies in `folder`, above it, or beside it as .NAME.lock does."""
    file, folder = file.absolute(), folder.absolute()
    beside = str(folder.parent / f".{folder.name}.")
    return (
        file.is_relative_to(folder) or folder.is_relative_to(file) or str(file).startswith(beside)
    )


def policy_files(folder: Path) -> tuple[Path, Path]:
    """Returns config.yaml and model.pt of a run. Raises UserError if one is missing."""
    config, model = config_file(folder), folder / "model.pt"
    if not model.is_file():
        raise UserError(f"{folder}: has no model.pt; legal: the folder of a run that has trained")
    return config, model


def checkpoint_file(run: Path) -> Path:
    """Returns the path of the checkpoint from which a stopped learner resumes."""
    return run / "checkpoint" / "state.pt"


def check_folder(run: Path) -> None:
    """Raises UserError if there is no folder `run`."""
    if not run.is_dir():
        wrong = "is not a folder" if run.exists() else "no such folder"
        raise UserError(f"{run}: {wrong}; legal: the folder of a run")


def config_file(run: Path) -> Path:
    """Returns the configuration of a run. Raises UserError if `run` is not the folder of one."""
    check_folder(run)
    file = run / "config.yaml"
    if not file.is_file():
        raise UserError(f"{run}: has no config.yaml; legal: the folder of a run")
    return file


# The answers of the simulators to a generation that has not ended, from which --resume goes on.
JOURNAL_FILE = "generation.journal"
KEY_FILE = "run.key"  # the secret with which the processes of a run authenticate their messages


def write_run_name(run: Path, name: str) -> None:
    """Notes in the folder of a run by which name its processes know each other on the bus."""
    write_text(run / "run_name", f"{name}\n")


def run_name(run: Path) -> str:
    """Returns the name of a run on the bus: that noted in its folder, else the folder's own."""
    file = run / "run_name"
    return read_text(file).strip() if file.exists() else run.resolve().name


def write_text(path: Path, text: str) -> None:
    """Writes `text` to `path`, atomically even if the machine crashes."""
    with whole_files.replacing(path) as file:
        file.write(text.encode())


def read_text(path: Path) -> str:
    """Reads a text file. Raises UserError if it cannot be read or is no UTF-8."""
    try:
        return whole_files.read(path).decode()
    except (OSError, UnicodeDecodeError) as error:
        raise_if_of_the_machine(error, path)
        why = (isinstance(error, OSError) and error.strerror) or "is no UTF-8"
        raise UserError(f"{path}: {why}; legal: the file as the run wrote it") from None


def write_config(path: Path, yaml: str) -> None:
    """Writes a configuration; its last line, a comment, has the SHA-256 of those above."""
    write_text(path, _with_seal(yaml))


def read_config(path: Path) -> str:
    """Reads a configuration. Raises UserError if it was changed since write_config() wrote it.

    Those of users, and of earlier versions of RTG, have no digest that could tell.
    """
    text = read_text(path)
    above, _, last = text[:-1].rpartition("\n")
    # A changed bit leaves one of the two, the words or the digits.
    has_seal = _CONFIG_SEAL in last or re.search(f"[0-9a-f]{{{_DIGITS}}}", last)
    if has_seal and text != _with_seal(f"{above}\n"):
        raise UserError(
            f"{path}: was changed since the run wrote it, as its last line tells; legal: as it was "
            "written; for other settings, a copy without that line and a new run"
        )
    return text


def _with_seal(yaml: str) -> str:
    return f"{yaml}{_CONFIG_SEAL}{hashlib.sha256(yaml.encode()).hexdigest()}\n"


def plain_json(value: Any) -> str:
    """Returns indented JSON for other programs. Keys keep their order."""
    return json.dumps(value, indent=2, ensure_ascii=False) + "\n"


def write_json(path: Path, value: Mapping[str, Any], indent: int | None = 2) -> None:
    """Writes a JSON object that read_json() is to read, atomically. Keys keep their order.

    The last member, "sha256", is the SHA-256 of all bytes before its digits.
    """
    text = json.dumps({**value, _SEAL: ""}, indent=indent, ensure_ascii=False)
    begin, end = text[: text.rindex('"')], text[text.rindex('"') :]
    write_text(path, f"{begin}{hashlib.sha256(begin.encode()).hexdigest()}{end}\n")


def read_json(path: Path) -> dict[str, Any]:
    """Reads a JSON object; {} if there is no file.

    Raises UserError if it was changed since write_json() wrote it. Objects of others, and those of
    earlier versions of RTG, have no digest that could tell.
    """
    try:
        content = whole_files.read(path)
        return _unsealed(content)
    except (FileNotFoundError, NotADirectoryError):
        return {}
    except OSError as error:
        raise_if_of_the_machine(error, path)
        raise UserError(f"{path}: {error.strerror}; legal: a file to read, or no file") from None
    except (ValueError, RecursionError):
        raise UserError(
            f"{path}: is damaged; legal: the file as the run wrote it, or no file"
        ) from None


def _unsealed(content: bytes) -> dict[str, Any]:
    """Returns the object that write_json() wrote, or a foreign one. Raises ValueError."""
    value = json.loads(content.decode())
    if not isinstance(value, dict):
        raise ValueError(value)
    last = next(reversed(value), "")
    digits = value.get(last)
    # A changed bit leaves one of the two, the name or the length.
    if last == _SEAL or (isinstance(digits, str) and len(digits) == _DIGITS):
        begin = content.rstrip(b'"\n }')[:-_DIGITS]
        if last != _SEAL or hashlib.sha256(begin).hexdigest() != digits:
            raise ValueError(digits)
        del value[_SEAL]
    return value


def result(run: Path) -> dict[str, Any]:
    """Returns the content of summary.json, or {} if the run has not finished learning.

    Raises UserError if the file is damaged.
    """
    found = read_json(run / "summary.json")
    if found.get("interactions") is None:
        return {}
    if not isinstance(found.get("success_rate"), float):
        raise UserError(
            f"{run / 'summary.json'}: has no success_rate; legal: the file as the run wrote it"
        )
    return found


def default_path(task: str) -> Path:
    """Returns the path runs/TASK-TIME, with a number appended if that path exists."""
    base = paths.RUNS / f"{task}-{time.strftime('%Y%m%d-%H%M%S')}"
    path, count = base, 1
    while path.exists():
        count += 1
        path = base.with_name(f"{base.name}-{count}")
    return path


def newest() -> Path:
    """Returns the folder in runs/ that began last. Raises UserError if there is none."""
    found = list(paths.RUNS.glob("*/config.yaml"))
    if not found:
        raise UserError(f"RUN: {paths.RUNS} holds no run; legal: the folder of a run")
    return max(found, key=lambda file: file.stat().st_mtime_ns).parent


def summary(
    run: Path, config: _core.Config, mode: str | None, measured: dict[str, Any]
) -> dict[str, Any]:
    """Returns the content of summary.json: all figures of generation and training.

    SUMMARY_KEYS come first, then all other keys. `measured` adds further figures by key. `mode`:
    "in_process", "lcm", or None without generation. Raises UserError if a file of the run is
    damaged.
    """
    generation = read_json(run / "generation.json") if config.train.offline else {}
    known: dict[str, Any] = {
        **{key: value for key, value in generation.items() if key not in _LEFT_OUT},
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
    with errors.fields_of(run / "generation.json"):
        gaps = generation.get("replay_gaps", [])
        counts = {"replay_gap_counts": replay_gaps.counts(gaps)} if gaps else {}
    return {**first, **rest, **counts}
