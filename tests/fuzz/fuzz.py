"""Feeds the fuzz targets: ./test.sh fuzz [--smoke]

Each target gets a million inputs (--smoke: 5,000), which libFuzzer makes from its seeds and from
what earlier runs found (build/fuzz/corpus). A crash, a hang, a fact that does not hold, or an
allocation of more than 64 MB fails: the input is in build/fuzz/found, the exit status is 1.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

BUILD = Path(__file__).resolve().parents[2] / "build" / "fuzz"
PROGRAMS = BUILD / "tests" / "fuzz"
FOUND = BUILD / "found"
INPUTS, SMOKE_INPUTS = 1_000_000, 5_000
LONGEST = 64_000  # bytes of an input, a datagram at most
LIMITS = ("-timeout=300", "-malloc_limit_mb=64", "-rss_limit_mb=2048")
DONE = re.compile(r"^#(\d+)\s+DONE\s+cov: (\d+) ft: (\d+)", re.MULTILINE)
WRITTEN = re.compile(r"Test unit written to (\S+)")


class Outcome(NamedTuple):
    """What one process of a target came to."""

    inputs: int
    edges: int  # of the code, reached by the inputs of all runs so far
    features: int  # edges with how often each was taken
    failure: str  # the end of its log, with the file of the input; empty if all went well


def names() -> list[str]:
    return sorted(path.name.removeprefix("fuzz.") for path in PROGRAMS.glob("fuzz.*"))


def start(name: str, number: int, inputs: int) -> subprocess.Popen[str]:
    corpus = BUILD / "corpus" / name
    corpus.mkdir(parents=True, exist_ok=True)
    seeds = BUILD / "seeds" / name
    subprocess.run([PROGRAMS / f"replay.{name}", "--seeds", seeds], check=True, timeout=60)
    options = [f"-runs={inputs}", f"-seed={number + 1}", f"-max_len={LONGEST}", *LIMITS]
    return subprocess.Popen(
        [PROGRAMS / f"fuzz.{name}", *options, f"-artifact_prefix={FOUND}/{name}.", corpus, seeds],
        cwd=FOUND,
        stdout=subprocess.DEVNULL,
        stderr=(FOUND / f"{name}.{number}.log").open("w"),
        text=True,
    )


def outcome(process: subprocess.Popen[str], log: Path) -> Outcome:
    status = process.wait()
    text = log.read_text(errors="replace")
    found = DONE.search(text)
    if status == 0 and found:
        return Outcome(int(found[1]), int(found[2]), int(found[3]), "")
    written = WRITTEN.search(text)
    where = f"the input is {written[1]}" if written else "it wrote no input"
    return Outcome(0, 0, 0, f"{text[-4000:]}\nstatus {status}; {where}; the log is {log}")


def run(name: str, inputs: int) -> bool:
    """Feeds a target, split over the processors, and prints its line. Returns whether it stood."""
    begun, count = time.monotonic(), os.cpu_count() or 1
    shares = [inputs // count + (k < inputs % count) for k in range(count)]
    processes = [start(name, k, share) for k, share in enumerate(shares)]
    outcomes = [outcome(p, FOUND / f"{name}.{k}.log") for k, p in enumerate(processes)]
    failures = [each.failure for each in outcomes if each.failure]
    print(
        f"fuzz {name}: {sum(each.inputs for each in outcomes):,} inputs, "
        f"{max(each.edges for each in outcomes):,} edges, "
        f"{max(each.features for each in outcomes):,} features, "
        f"{time.monotonic() - begun:.0f} s: {'FAIL' if failures else 'PASS'}",
        flush=True,
    )
    for failure in failures:
        print(failure, file=sys.stderr)
    return not failures


def main() -> int:
    parser = argparse.ArgumentParser(prog="./test.sh fuzz", description=__doc__)
    parser.add_argument("--smoke", action="store_true")
    inputs = SMOKE_INPUTS if parser.parse_args().smoke else INPUTS
    FOUND.mkdir(parents=True, exist_ok=True)
    return 0 if all([run(name, inputs) for name in names()]) else 1


if __name__ == "__main__":
    sys.exit(main())
