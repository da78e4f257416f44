"""Builds the core for several processors and compares the transitions that it generates.

    same_bits.py [--transitions N]

The builds are for any x86-64 processor (two lanes of doubles, no fused instructions), for
x86-64-v3 (four lanes; the default), for this processor and, if it can run it, for x86-64-v4 (eight
lanes). Each generates the transitions of three tasks, also with a C library that believes the
processor to have neither AVX2 nor FMA. Prints a digest of each; exit status 1 if any two differ
that should not. The digests of two machines can be compared by eye. A build takes ten minutes.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

from rtg import paths

TASKS = ("gathering", "art_manip", "push_t")
PROCESSORS = ("x86-64", "x86-64-v3", "native")
OLDER_LIBRARY = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX512F,-AVX2,-FMA"}


def processors() -> tuple[str, ...]:
    """Returns the values of -march whose programs this processor can run."""
    flags = Path("/proc/cpuinfo").read_text().partition("flags")[2].partition("\n")[0].split()
    v4 = {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"}
    return (*PROCESSORS, "x86-64-v4") if v4 <= set(flags) else PROCESSORS


def build(processor: str) -> Path:
    """Returns the program generate_bench, compiled for a processor."""
    folder = paths.ROOT / "build" / f"bits-{processor}"
    configure = ["cmake", "--preset", "release", "-B", str(folder), f"-DRTG_PROCESSOR={processor}"]
    compile_it = ["ninja", "-C", str(folder), "generate_bench"]
    for command in (configure, compile_it):
        done = subprocess.run(command, cwd=paths.ROOT, capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"same_bits.py: {' '.join(command)} failed:\n{done.stdout}{done.stderr}")
    return folder / "tests" / "generate_bench"


def digest(program: Path, task: str, transitions: int, environment: dict[str, str]) -> str:
    """Returns the digest of the transitions of a task."""
    command = [program, paths.CONFIG / f"{task}.yaml", f"search.transitions={transitions}"]
    done = subprocess.run(
        command,
        env=os.environ | environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        check=True,
    )
    return f"{json.loads(done.stdout)['digest']:016x}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--transitions", type=int, default=3000, metavar="N")
    transitions = parser.parse_args().transitions
    found: dict[str, set[str]] = {task: set() for task in TASKS}
    for processor in processors():
        program = build(processor)
        for environment in ({}, OLDER_LIBRARY):
            for task in TASKS:
                one = digest(program, task, transitions, environment)
                found[task].add(one)
                library = "older" if environment else "this"
                print(f"{task:10s} {processor:10s} C library for {library:5s} {one}", flush=True)
    differ = [task for task, digests in found.items() if len(digests) > 1]
    print(f"the bits differ: {', '.join(differ)}" if differ else "all bits are the same")
    return bool(differ)


if __name__ == "__main__":
    sys.exit(main())
