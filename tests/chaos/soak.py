"""Generates and trains in one process, again and again: SECONDS. Prints how its memory grows.

The last line has the number of rounds and the slope of the resident memory [MB/h], by least
squares, the first quarter left out, in which allocators and caches fill.
"""

from __future__ import annotations

import statistics
import sys
import tempfile
import time
from pathlib import Path

import rtg
from processes import resident
from rtg import paths

SMALL = ("train.checkpoint_every=100", "train.eval_every=100")


def main(seconds: float) -> None:
    task = rtg.load_task(paths.CONFIG / "tests" / "tiny.yaml", SMALL)
    begin = time.monotonic()
    hours: list[float] = []
    megabytes: list[float] = []
    while len(hours) < 3 or hours[-1] * 3600 < seconds:
        data = rtg.Transitions.joined(rtg.generate(task, 600))
        with tempfile.TemporaryDirectory() as folder:
            rtg.train(data, task, Path(folder) / "run", interactions=100)
        hours.append((time.monotonic() - begin) / 3600)
        megabytes.append(resident())
    late = len(hours) // 4
    print(len(hours), statistics.linear_regression(hours[late:], megabytes[late:]).slope)


if __name__ == "__main__":
    main(float(sys.argv[1]))
