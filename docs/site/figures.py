"""Makes docs/figures/: pictures and output of the examples, and the pictures of a generation.

`python docs/site/figures.py [NAME...]` makes those named, all if none is; all take ten minutes.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import pkgutil
import sys
import tempfile
from pathlib import Path

import rtg.examples
from PIL import Image
from rtg import cli

FIGURES = Path(__file__).resolve().parents[1] / "figures"
_MODULES = (module.name for module in pkgutil.iter_modules(rtg.examples.__path__))
EXAMPLES = sorted(name for name in _MODULES if name[0].isdigit())
OF_A_RUN = ("coverage", "replay_gap", "episode")
_COLOURS = 256  # of a palette, so that files are small


def _store(picture: Path) -> None:
    target = FIGURES / picture.name
    if picture.suffix == ".gif":
        target.write_bytes(picture.read_bytes())
        return
    with Image.open(picture) as image:
        image.convert("RGB").quantize(_COLOURS).save(target, optimize=True)


def run_example(name: str) -> None:
    """Runs an example and stores its picture, and what it prints as NAME.txt."""
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as said:
        importlib.import_module(f"rtg.examples.{name}").main(Path(folder))
        (picture,) = (path for path in Path(folder).iterdir() if path.stem == name)
        _store(picture)
    (FIGURES / f"{name}.txt").write_text(said.getvalue())


def run_generation() -> None:
    """Generates the transitions of Gathering and stores the pictures of the run."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "run"
        if cli.main(["gathering", "--no-train", "--in-process", "--out", str(out)]) != 0:
            raise SystemExit("the generation failed")
        for name in OF_A_RUN:
            _store(out / f"{name}.png")


def main(names: list[str]) -> None:
    legal = [*EXAMPLES, "run"]
    if unknown := set(names) - set(legal):
        raise SystemExit(f"{sorted(unknown)}: unknown; legal: {', '.join(legal)}")
    for name in names or legal:
        print(name, flush=True)
        run_generation() if name == "run" else run_example(name)


if __name__ == "__main__":
    main(sys.argv[1:])
