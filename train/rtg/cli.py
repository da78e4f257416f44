"""The command line of RTG: `./run.sh ...`, `rtg ...`, `python -m rtg ...`."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from rtg import extras, paths
from rtg.errors import UserError, exit_status
from rtg.files import run_folder
from rtg.run import run_args

# Functions import modules that load slowly, so that --help and errors appear at once.


def _run(words: Sequence[str]) -> int:
    from rtg.run.run import run

    return run(run_args.parse(words, tools=list(_TOOLS)))


def _check(words: Sequence[str]) -> int:
    from rtg.run import effective_config

    parser = run_args.Parser(
        prog=f"{paths.COMMAND} check", description="Validate a task file; print what it says."
    )
    parser.add_argument("file", metavar="FILE.yaml", help="a task file, or a task of config/")
    parser.add_argument("--picture", metavar="FILE.png", help="also draw starts and goal states")
    run_args.add_set(parser, "any configuration value")
    args = parser.parse_args(words)
    file = paths.task_file(args.file)
    said = effective_config.check(file, run_args.set_values(args))
    if args.picture is not None:
        from rtg.pictures import task_picture

        config = effective_config.load(file, run_args.set_values(args))
        task_picture.draw(Path(args.picture), config)
    print(said, end="")
    return 0


def _bus_url(target: str) -> str:
    from rtg.run import effective_config

    folder = Path(target)
    if (folder / "config.yaml").is_file() or (folder.is_dir() and target not in paths.task_names()):
        file = run_folder.config_file(folder)
    else:
        file = paths.task_file(target, ", a run folder")
    return effective_config.load(file).run.bus


def _watcher(tool: str, description: str) -> argparse.ArgumentParser:
    parser = run_args.Parser(prog=f"{paths.COMMAND} {tool}", description=description)
    parser.add_argument(
        "target",
        metavar="TASK | FILE.yaml | RUN_FOLDER",
        nargs="?",
        default="gathering",
        help="whose bus to watch (gathering); all runs on it are shown",
    )
    return parser


def _seconds(word: str) -> float:
    try:
        seconds = float(word)
    except ValueError:
        seconds = -1.0
    if not 0.0 < seconds <= 1e6:
        raise UserError(
            f"--seconds {word}: not a legal duration; legal: a number of seconds above 0"
        )
    return seconds


def _spy(words: Sequence[str]) -> int:
    parser = _watcher("spy", "Watch the channels: in place on a terminal, as tables elsewhere.")
    parser.add_argument("--seconds", metavar="N", help="stop after so long (never)")
    args = parser.parse_args(words)
    seconds = None if args.seconds is None else _seconds(args.seconds)
    url = _bus_url(args.target)
    extras.require("textual", "spy", "spy")
    from rtg.bus.spy import spy

    spy(url, seconds)
    return 0


def _lcm_spy(words: Sequence[str]) -> int:
    args = _watcher("lcm-spy", "LCM's own viewer, with our message types.").parse_args(words)
    from rtg.bus.lcm_tools import lcm_spy

    lcm_spy(_bus_url(args.target))
    return 0


def _reproduce(words: Sequence[str]) -> int:
    from rtg.compare import reproduce_args

    args = reproduce_args.parse(words)
    from rtg.compare.reproduce import reproduce

    return reproduce(args)


def _plot(words: Sequence[str]) -> int:
    parser = run_args.Parser(
        prog=f"{paths.COMMAND} plot",
        description="Make report, tables and pictures of comparisons and runs anew, or the "
        "pictures of a run.",
    )
    parser.add_argument(
        "folders", metavar="DIR", type=Path, nargs="+", help="the --out of reproduce, or a run"
    )
    parser.add_argument("--out", metavar="DIR", help="where to put a report (a comparison's DIR)")
    parser.add_argument(
        "--format",
        choices=("png", "svg", "pdf"),
        default="png",
        help="of pictures; films stay GIF",
    )
    args = parser.parse_args(words)
    if args.out == "":
        raise UserError("--out: the path is empty; legal: the path of a folder")
    if len(args.folders) > 1 and args.out is None:
        raise UserError(
            "--out: is missing; legal: --out DIR for the report on several folders together"
        )
    if args.out is None and (args.folders[0] / "config.yaml").is_file():
        return _draw_run(args.folders[0], args.format)
    from rtg.compare.report_files import write_joint_report

    page = write_joint_report(args.folders, Path(args.out or args.folders[0]), args.format)
    print(f"report: {page}")
    return 0


def _draw_run(folder: Path, suffix: str) -> int:
    from rtg.compare import evaluate
    from rtg.pictures import plots
    from rtg.run.plan import plan_of
    from rtg.run.results import draw_again

    with plots.written_as(suffix):
        draw_again(plan_of(folder))
        evaluate.draw_again(folder)
    print(f"pictures: {folder}")
    return 0


def _evaluate(words: Sequence[str]) -> int:
    parser = run_args.Parser(
        prog=f"{paths.COMMAND} evaluate",
        description="Success of trained policies from other starts, with noise, other physics.",
    )
    parser.add_argument("folders", metavar="RUN", nargs="+", type=Path, help="folders of runs")
    parser.add_argument("--episodes", metavar="N", default="100", help="starts of each row (100)")
    args = parser.parse_args(words)
    if not args.episodes.isdecimal() or not 1 <= int(args.episodes) <= 100_000:
        raise UserError(f"--episodes {args.episodes}: legal: a number from 1 to 100000")
    from rtg.compare.evaluate import evaluate

    for folder in args.folders:
        print(evaluate(folder, int(args.episodes)), flush=True)
    return 0


def _view(words: Sequence[str]) -> int:
    parser = run_args.Parser(
        prog=f"{paths.COMMAND} view",
        description="Show a run in the browser, while it goes on or afterwards: scene, trees, "
        "learning curve, replay gap. For this machine alone.",
    )
    parser.add_argument(
        "folder", metavar="RUN", nargs="?", type=Path, help="the folder of a run (the newest one)"
    )
    parser.add_argument("--port", metavar="N", default="9090", help="of the page (9090), and N + 1")
    parser.add_argument("--no-browser", action="store_true", help="open no browser")
    parser.add_argument("--save", metavar="FILE.rrd", type=Path, help="write a recording instead")
    args = parser.parse_args(words)
    if not args.port.isdecimal() or not 1024 <= int(args.port) <= 65_534:
        raise UserError(f"--port {args.port}: legal: a number from 1024 to 65534")
    folder = args.folder or run_folder.newest()
    run_folder.config_file(folder)  # a wrong folder is told before a package that it would need
    extras.require("rerun", "view", "view")
    from rtg.view import view

    def say(words: str) -> None:
        print(words, flush=True)

    if args.save is not None:
        view.save(folder, args.save, say)
    else:
        view.serve(folder, int(args.port), not args.no_browser, say)
    return 0


def _export(words: Sequence[str]) -> int:
    from rtg.export.command import export

    print(export(words))
    return 0


_TOOLS: dict[str, Callable[[Sequence[str]], int]] = {
    "run": _run,
    "check": _check,
    "spy": _spy,
    "lcm-spy": _lcm_spy,
    "reproduce": _reproduce,
    "plot": _plot,
    "evaluate": _evaluate,
    "view": _view,
    "export": _export,
}


def _check_utf8(words: Sequence[str]) -> None:
    for word in words:
        try:
            word.encode()
        except UnicodeEncodeError:
            shown = os.fsencode(word).decode(errors="backslashreplace")
            raise UserError(
                f"{shown}: has a byte that is not UTF-8; legal: text in UTF-8"
            ) from None


def _command(words: Sequence[str]) -> int:
    _check_utf8(words)
    tool = _TOOLS.get(words[0]) if words else None
    return tool(words[1:]) if tool else _run(words)


def _open_standard_streams() -> None:
    """Gives closed standard streams to /dev/null, lest a file of the run takes their place."""
    while (number := os.open(os.devnull, os.O_RDWR)) <= 2:
        pass
    os.close(number)
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(number, "r" if number == 0 else "w"))


def main(words: Sequence[str] | None = None) -> int:
    """Runs the command and returns its exit status: 0 success, 2 bad input, 1 anything else."""
    words = list(sys.argv[1:] if words is None else words)
    _open_standard_streams()
    try:
        return exit_status("rtg", lambda: _command(words))
    except KeyboardInterrupt:
        print("rtg: interrupted", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
