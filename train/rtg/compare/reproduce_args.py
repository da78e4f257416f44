"""Parses the flags of `./run.sh reproduce` into the cells of a comparison."""

from __future__ import annotations

import argparse
import itertools
import json
import os
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rtg import _core, paths
from rtg.compare.ablations import ablations
from rtg.compare.cells import Cell
from rtg.compare.executors.choice import EXECUTORS
from rtg.compare.methods import METHODS, REFERENCE, SEEDLESS, TASKS
from rtg.errors import UserError
from rtg.learn import log_sinks
from rtg.run.run_args import LOG_HELP, Override, Parser, add_set
from rtg.run.run_args import parse as parse_run

DEFAULT_SEEDS = "5"
# Settings of --quick: every part runs, but on budgets too small for results.
QUICK_SETTINGS = (
    "search.transitions=30000",
    "train.interactions=30000",
    "train.transitions_before_learning=10000",
    "train.eval_every=2500",
    "train.eval_episodes=20",
    "train.checkpoint_every=5000",
)
MAX_SEEDS = 1000
MAX_JOBS = 1000
# Keys that --set must not change -> the flag to use instead.
RESERVED_KEYS = {
    "run.seed": "--seeds",
    "run.method": "--methods",
    "run.in_process": "none, every run is in one process",
    "run.workers": "none, --jobs says how many runs at a time",
}
QUICK_METHODS = ("ddqn_naive", REFERENCE)

EPILOG = f"""\
methods: {", ".join(METHODS)}

examples:
  ./run.sh reproduce --quick
  ./run.sh reproduce gathering sorting --methods ddqn_naive,ddqn_rtg --seeds 5
  ./run.sh reproduce gathering --sweep train.offline_share=0.1,0.25,0.5,0.75,-1
  ./run.sh reproduce sorting --ablations --seeds 1

The same command again goes on where it was stopped. Report and pictures: DIR/report.md."""


@dataclass(frozen=True)
class ReproduceArgs:
    """A call of `rtg reproduce`."""

    files: dict[str, Path]  # by task name
    cells: tuple[Cell, ...]
    settings: tuple[str, ...]  # KEY=VALUE, for all cells
    jobs: int
    executor: str  # of choice.EXECUTORS
    executor_options: Mapping[str, Any]
    together: bool  # seeds of a method learn in one process even without a GPU
    sinks: tuple[str, ...]  # of log_sinks.SINKS
    out: Path
    command: str  # with all flags that affect the results, for the report
    command_line: str  # the command as the user typed it


def parser() -> Parser:
    """Returns the parser of the flags."""
    p = Parser(
        prog=f"{paths.COMMAND} reproduce",
        description="Run methods x seeds on tasks, one process per core, and write a report.",
        epilog=EPILOG.replace("./run.sh", paths.COMMAND),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    p.add_argument("tasks", metavar="TASK", nargs="*", help=f"tasks or files ({' '.join(TASKS)})")
    what = "what to compare (all; of a sweep and ablations: ddqn_rtg)"
    p.add_argument("--methods", metavar="a,b", help=what)
    p.add_argument("--seeds", metavar="N|1,2,3", help=f"how many, or which ({DEFAULT_SEEDS})")
    p.add_argument("--jobs", metavar="N", help="runs at a time (one per core; of a cluster: all)")
    p.add_argument("--executor", choices=EXECUTORS, default="local", help="where (this machine)")
    p.add_argument(
        "--executor-option",
        metavar="KEY=VALUE",
        action="append",
        default=[],
        help="for submitit or Ray, such as timeout_min=600, slurm_partition=cpu or num_gpus=0.25",
    )
    p.add_argument("--out", metavar="DIR", help="folder of the comparison (runs/reproduce)")
    p.add_argument("--quick", action="store_true", help="small budgets, one seed: minutes")
    p.add_argument(
        "--sweep",
        metavar="KEY=V1,V2",
        action="append",
        default=[],
        help="compare these values of a key",
    )
    p.add_argument(
        "--ablations",
        action="store_true",
        help="also with single settings of the search switched off or at the other end of their "
        "range, with each departure from the preset paper taken back, and with that preset",
    )
    p.add_argument("--log", metavar="NAMES", help=LOG_HELP)
    p.add_argument(
        "--together", action="store_true", help="a method's seeds learn in one process, as on a GPU"
    )
    add_set(p, "any configuration value, for all runs")
    return p


def _parse_number(flag: str, word: str, least: int, most: int, legal: str = "") -> int:
    if not (word.isascii() and word.isdigit() and least <= int(word) <= most):
        legal = legal or f"a number from {least} to {most}"
        raise UserError(f"{flag} {word or repr(word)}: not a legal number; legal: {legal}")
    return int(word)


def parse_seeds(words: str) -> tuple[int, ...]:
    """Parses a number N (seeds 1 to N) or a list 1,2,3. Raises UserError."""
    if "," not in words:
        legal = f"a number from 1 to {MAX_SEEDS}, or a list 1,2,3"
        return tuple(range(1, 1 + _parse_number("--seeds", words, 1, MAX_SEEDS, legal)))
    seeds = [
        _parse_number("--seeds", word, 0, 2**31 - 1, "a list 1,2,3")
        for word in words.strip(",").split(",")
    ]
    return tuple(dict.fromkeys(seeds))


def _methods(args: argparse.Namespace) -> tuple[str, ...]:
    """Returns the methods to compare. Raises UserError for an unknown one."""
    if args.methods is None:
        reference_only = args.sweep or args.ablations
        return QUICK_METHODS if args.quick else (REFERENCE,) if reference_only else METHODS
    found = tuple(dict.fromkeys(args.methods.split(",")))
    for method in found:
        if method not in METHODS:
            raise UserError(
                f"--methods {method}: no method of that name{_core.suggestion(method, METHODS)}; "
                f"legal: {','.join(METHODS)}"
            )
    return found


def _seeds(args: argparse.Namespace) -> str:
    """Returns the value of --seeds as typed, or its default."""
    default = "1" if args.quick else DEFAULT_SEEDS
    return default if args.seeds is None else str(args.seeds)


def _files(words: Sequence[str]) -> dict[str, Path]:
    files: dict[str, Path] = {}
    for word in dict.fromkeys(words):
        path = paths.task_file(word).absolute()
        if path.stem in files:
            raise UserError(
                f"{word}: {path.stem} is named twice; legal: tasks with different file names"
            )
        files[path.stem] = path
    return files


def parse_sweep(words: str) -> tuple[str, ...]:
    """Splits KEY=V1,V2 into (KEY=V1, KEY=V2). Raises UserError."""
    key, sign, values = words.partition("=")
    found = [f"{key}={value}" for value in values.split(",")]
    if not (key and sign) or any(bad in words for bad in "/@ ") or "" in values.split(","):
        raise UserError(
            f"--sweep {words}: not a legal axis; legal: KEY=V1,V2, values without blank, / or @"
        )
    if key.startswith("run.") or key == "task":
        raise UserError(
            f"--sweep {words}: {key} cannot be swept; legal: keys outside of run and task"
        )
    return tuple(dict.fromkeys(found))


def _check_keys(sweeps: Sequence[tuple[str, ...]]) -> None:
    """Raises UserError if two sweeps have the same key."""
    seen = set[str]()
    for key in (sweep[0].partition("=")[0] for sweep in sweeps):
        if key in seen:
            raise UserError(f"--sweep {key}: is given twice; legal: once, {key}=V1,V2")
        seen.add(key)


def _cells(args: argparse.Namespace, files: dict[str, Path]) -> tuple[Cell, ...]:
    """Returns the cells: tasks x methods x settings x seeds. Raises UserError.

    SEEDLESS runs with the first seed alone.
    """
    sweeps = [parse_sweep(sweep) for sweep in args.sweep]
    _check_keys(sweeps)
    if args.ablations and sweeps:
        raise UserError("--ablations: cannot be combined with --sweep; legal: one of the two")
    found = []
    for task, method in itertools.product(files, _methods(args)):
        changes = list(itertools.product(*sweeps))
        if args.ablations:
            changes = ablations(files[task], _common(args, method))
        seeds = parse_seeds(_seeds(args))
        axes = changes, seeds[:1] if method == SEEDLESS else seeds
        found += [Cell(task, method, changed, seed) for changed, seed in itertools.product(*axes)]
    return tuple(found)


def _settings(args: argparse.Namespace) -> tuple[str, ...]:
    """Returns the settings of all cells. Raises UserError if --set names a key of RESERVED_KEYS."""
    for setting in args.set:
        if (key := setting.partition("=")[0]) in RESERVED_KEYS:
            raise UserError(
                f"--set {setting}: reproduce sets this key itself; legal: {RESERVED_KEYS[key]}"
            )
    return (*(QUICK_SETTINGS if args.quick else ()), *args.set)


def _common(args: argparse.Namespace, method: str) -> list[Override]:
    """Returns the overrides that all runs of a method share."""
    of_method = parse_run(["--method", method]).overrides
    return [*of_method, *(Override(f"--set {setting}", setting) for setting in _settings(args))]


def _executor_options(args: argparse.Namespace) -> dict[str, Any]:
    """Returns the options of the executor; values are JSON where they can be, else text.

    Raises UserError.
    """
    found: dict[str, Any] = {}
    for word in args.executor_option:
        key, sign, value = word.partition("=")
        if not (key and sign) or args.executor == "local":
            raise UserError(
                f"--executor-option {word}: is none of --executor {args.executor}; legal: KEY=VALUE"
                " of the executors submitit and ray"
            )
        try:
            found[key] = json.loads(value)
        except ValueError:
            found[key] = value
    return found


def _jobs(args: argparse.Namespace) -> int:
    """Returns how many runs are at work at a time. Raises UserError."""
    if args.jobs is not None:
        return _parse_number("--jobs", args.jobs, 1, MAX_JOBS)
    return len(os.sched_getaffinity(0)) if args.executor == "local" else MAX_JOBS


def parse(words: Sequence[str]) -> ReproduceArgs:
    """Parses the command line. Raises UserError, or SystemExit(0) after --help."""
    args = parser().parse_args(words)
    tasks = args.tasks or TASKS
    files = _files(tasks)
    cells = _cells(args, files)
    if args.out == "":
        raise UserError("--out: the path is empty; legal: the path of a folder")
    flags = ["--methods", ",".join(_methods(args)), "--seeds", _seeds(args)]
    flags += [*["--quick"] * args.quick, *["--ablations"] * args.ablations]
    flags += [word for sweep in args.sweep for word in ("--sweep", sweep)]
    flags += [word for setting in args.set for word in ("--set", setting)]
    return ReproduceArgs(
        files=files,
        cells=cells,
        settings=_settings(args),
        jobs=_jobs(args),
        executor=args.executor,
        executor_options=_executor_options(args),
        together=args.together,
        sinks=log_sinks.parse(args.log),
        out=Path(args.out or paths.RUNS / f"reproduce{'-quick' * args.quick}").absolute(),
        command=shlex.join([paths.COMMAND, "reproduce", *tasks, *flags]),
        command_line=shlex.join([paths.COMMAND, "reproduce", *words]),
    )
