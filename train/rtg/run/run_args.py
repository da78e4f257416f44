"""The flags of `./run.sh` and the configuration values that they set."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rtg import _core, paths
from rtg.errors import UserError
from rtg.files import run_folder
from rtg.learn import log_sinks

EPILOG = """\
examples:
  ./run.sh                                     the whole job on Gathering
  ./run.sh gathering --no-train                only generate transitions
  ./run.sh --method her                        a learner to compare with
  ./run.sh config/mine.yaml --seed 3 --out runs/mine
  ./run.sh --set search.breadth=32 --print-config

tools:
  ./run.sh check FILE.yaml                     validate a task file and print what it says
  ./run.sh view [RUN]                          show a run in the browser, live or afterwards
  ./run.sh spy                                 watch the channels of a run in the terminal
  ./run.sh lcm-spy                             the same with LCM's own viewer (needs Java)
  ./run.sh evaluate RUN...                     success of their policies elsewhere, as tables
  ./run.sh export minari RUN                   its data for other libraries; or lerobot
  ./run.sh reproduce [TASK...]                 methods x seeds on tasks, and a report
  ./run.sh plot DIR... [--format pdf]          that report, or the pictures of a run, anew

exit status: 0 success, 2 bad input, 1 anything else"""

LOG_HELP = f"also log what progress.csv has, optional packages: {', '.join(log_sinks.SINKS)}"
# Flag -> configuration key.
_KEYS = {
    "workers": "run.workers",
    "method": "run.method",
    "generator": "search.generator",
    "transitions": "search.transitions",
    "interactions": "train.interactions",
    "seed": "run.seed",
}


@dataclass(frozen=True)
class Override:
    """A configuration value from the command line."""

    typed: str  # as the user typed it: "--workers 4"
    setting: str  # as the configuration loader takes it: "run.workers=4"


@dataclass(frozen=True)
class RunArgs:
    """The parsed arguments of `rtg run`."""

    file: Path
    overrides: tuple[Override, ...]
    out: Path | None
    train: bool
    data: str | None  # as typed: a .npz, a run, or a Minari data set
    resume: bool
    print_config: bool
    sinks: tuple[str, ...]  # of log_sinks.SINKS


class Parser(argparse.ArgumentParser):
    """An argument parser without abbreviations. Raises UserError with the usage for a mistake."""

    def __init__(self, **options: Any) -> None:
        super().__init__(allow_abbrev=False, **options)

    def error(self, message: str) -> None:  # type: ignore[override]
        usage = " ".join(self.format_usage().split()).removeprefix("usage: ")
        raise UserError(f"{message}; legal: {usage}")


def _ids(names: Sequence[str]) -> str:
    return ", ".join(names)


def parser() -> argparse.ArgumentParser:
    """Returns the parser of the arguments of `rtg run`."""
    p = Parser(
        prog=paths.COMMAND,
        description="From goal states to a trained policy: generate reverse transitions, train, "
        "evaluate, and leave the results in a run folder.",
        epilog=EPILOG.replace("./run.sh", paths.COMMAND),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    p.add_argument("task", nargs="?", help="a task of config/ or a FILE.yaml (gathering)")
    p.add_argument(
        "--in-process", action="store_true", help="run everything in one process, without LCM"
    )
    p.add_argument("--workers", metavar="N", help="reverse workers; 0: one per core")
    p.add_argument("--method", metavar="ID", help=f"{_ids(_core.METHODS)} (ddqn_rtg)")
    p.add_argument(
        "--generator",
        metavar="ID",
        help=f"of transitions: {_ids(_core.GENERATORS)} (rrbs, the reverse simulator)",
    )
    p.add_argument(
        "--data",
        metavar="FILE",
        help="learn from these transitions instead of generated ones: a .npz, another run, or the "
        "id or folder of a Minari data set",
    )
    p.add_argument("--transitions", metavar="N", help="transitions to generate")
    p.add_argument("--interactions", metavar="N", help="environment steps of the learner")
    p.add_argument("--no-train", action="store_true", help="stop after the generation")
    p.add_argument("--seed", metavar="N", help="seed of all random numbers")
    p.add_argument("--out", metavar="DIR", help="the run folder (runs/TASK-TIME)")
    p.add_argument("--resume", action="store_true", help="go on with the run in --out DIR")
    p.add_argument("--log", metavar="NAMES", help=LOG_HELP)
    add_set(p, "any configuration value")
    p.add_argument("--print-config", action="store_true", help="print all values and stop")
    return p


def _task_file(task: str | None, tools: Sequence[str]) -> Path:
    return paths.task_file("gathering" if task is None else task, ", a tool (--help)", tools)


def add_set(p: argparse.ArgumentParser, what: str) -> None:
    """Adds the flag --set, which can be repeated, with the help text `what`."""
    p.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help=what)


def set_values(args: argparse.Namespace) -> list[Override]:
    """Returns what the flags --set change."""
    return [Override(f"--set {setting}", setting) for setting in args.set]


def _overrides(args: argparse.Namespace) -> tuple[Override, ...]:
    found = set_values(args)
    for flag, key in _KEYS.items():
        value = getattr(args, flag)
        if value is not None:
            found.append(Override(f"--{flag} {value}", f"{key}={value}"))
    if args.in_process:
        found.append(Override("--in-process", "run.in_process=true"))
    return tuple(found)


def parse(argv: Sequence[str], tools: Sequence[str] = ()) -> RunArgs:
    """Parses and checks the arguments. Raises UserError, or SystemExit(0) after --help.

    `tools`: the words that may have been meant in the place of a task.
    """
    if argv and not argv[0].startswith("-"):
        _task_file(argv[0], tools)  # reports a misspelt tool before mistakes in its arguments
    args = parser().parse_args(argv)
    if args.out == "":
        raise UserError("--out: the path is empty; legal: the path of a folder")
    out = None if args.out is None else Path(args.out).absolute()
    if args.resume:
        if out is None:
            raise UserError(
                "--resume: --out is missing; legal: --resume --out DIR with the folder of a run"
            )
        if args.task is not None:
            raise UserError(f"{args.task}: --resume goes on with the task of {out}; legal: no TASK")
        if args.data is not None:
            raise UserError(
                f"--data {args.data}: --resume goes on with the transitions of {out}; legal: no "
                "--data"
            )
        file = run_folder.config_file(out)
    else:
        file = _task_file(args.task, tools)
        if out is not None and out.exists() and not out.is_dir():
            raise UserError(f"--out: {out} is not a folder; legal: a new or an empty folder")
        if out is not None and out.is_dir() and any(out.iterdir()):
            raise UserError(
                f"--out: {out} is not empty; legal: a new or an empty folder, or --resume"
            )
    return RunArgs(
        file=file,
        overrides=_overrides(args),
        out=out,
        train=not args.no_train,
        data=args.data,
        resume=args.resume,
        print_config=args.print_config,
        sinks=log_sinks.parse(args.log),
    )
