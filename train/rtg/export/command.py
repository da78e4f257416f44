"""`rtg export`: its arguments, and which format they ask for."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from rtg import paths
from rtg.errors import UserError
from rtg.run.run_args import Parser


def _parser() -> argparse.ArgumentParser:
    p = Parser(
        prog=f"{paths.COMMAND} export",
        description="Write the data of a run for other libraries: the plans found in them, "
        "replayed in the simulator, as whole episodes.",
    )
    p.add_argument("format", choices=("minari", "lerobot"))
    p.add_argument("run", metavar="RUN", type=Path, help="the folder of a run")
    p.add_argument(
        "--out",
        metavar="DIR",
        help="minari: the folder of all data sets (Minari's own); lerobot: that of this one "
        "(RUN/lerobot)",
    )
    p.add_argument(
        "--id", metavar="ID", help="minari: of the data set (rtg/TASK/GENERATOR-plans-v0)"
    )
    p.add_argument(
        "--episodes", metavar="N", help="at most so many, plans nearest to the start first (all)"
    )
    p.add_argument(
        "--transitions",
        action="store_true",
        help="minari: every stored transition instead, in the episodes that they form",
    )
    return p


def _count(word: str | None) -> int | None:
    if word is None:
        return None
    if not word.isdecimal() or not 1 <= int(word) <= 10_000_000:
        raise UserError(f"--episodes {word}: legal: a number from 1 to 10000000")
    return int(word)


def _folder(word: str | None) -> Path | None:
    if word == "":
        raise UserError("--out: the path is empty; legal: the path of a folder")
    return None if word is None else Path(word).absolute()


def export(words: Sequence[str]) -> str:
    """Carries out the command; returns what it has written, in words. Raises UserError."""
    args = _parser().parse_args(words)
    count, out = _count(args.episodes), _folder(args.out)
    from rtg.export import run_data

    if args.format == "lerobot" and (args.transitions or args.id is not None):
        wrong = "--transitions" if args.transitions else "--id"
        raise UserError(f"{wrong}: is for minari, as LeRobot wants episodes; legal: without it")
    data = run_data.read(args.run)
    if args.format == "lerobot":
        from rtg.export import lerobot_format

        return lerobot_format.write(data, out or args.run.absolute() / "lerobot", count)
    from rtg.export import minari_format

    kind = "transitions" if args.transitions else "plans"
    id = args.id or minari_format.default_id(data, kind)
    return minari_format.write(data, kind, id, out, count)
