"""Measures what a reverse solve costs from Python, against the same call in C++.

    binding.py BUILD_FOLDER [--smoke]

A call solves all actions from one goal state, on one core; reverse_call does so in C++ and
reverse_call.py in Python, each in a process of its own. Prints thread-CPU times per task,
medians over the states of the shortest of interleaved repetitions, and a gate for each:
`binding.TASK`, the time from Python by that in C++. Both return whole solutions, Python as arrays
in metres. --smoke repeats little and leaves out the gates. Exit status 1 if a gate failed.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from gates import gate
from rtg import paths

HERE = Path(__file__).resolve().parent
TASKS = ("gathering", "push_t", "drawer")
STATES = 6


def times_of(call: Sequence[str | Path], task: str) -> list[float]:
    """Returns the CPU time of the call for each state [ms]."""
    command = [*call, paths.CONFIG / f"{task}.yaml", str(STATES)]
    done = subprocess.run(command, capture_output=True, check=True, text=True)
    return [float(line) for line in done.stdout.split()]


def main(words: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(description="Measures a reverse solve from Python.")
    parser.add_argument("build", type=Path)
    parser.add_argument("--smoke", action="store_true")
    args = parser.parse_args(words)
    held = True
    calls = ([sys.executable, HERE / "reverse_call.py"], [args.build / "tests" / "reverse_call"])
    for name in TASKS:
        rounds = [[times_of(call, name) for call in calls] for _ in range(1 if args.smoke else 9)]
        python, cpp = (
            statistics.median(min(times) for times in zip(*side, strict=True))
            for side in zip(*rounds, strict=True)
        )
        print(f"reverse solve of {name}: {python:.2f} ms from Python, {cpp:.2f} ms in C++")
        if not args.smoke:
            held &= gate(f"binding.{name}", python / cpp, "<=", 1.1)
    return 0 if held else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
