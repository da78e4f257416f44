"""Compares, bit by bit, the transitions that builds for several processors generate.

    same_bits.py BUILD_FOLDER

BUILD_FOLDER is that of the release build, which is for x86-64-v3. It runs as it is, with the
libraries that a processor with nothing more than x86-64-v3 would get, and emulated on such a
processor by QEMU; beside it a build for this processor, which takes some minutes. Prints the
digest of the transitions for each and three tasks, as the report of a run has it, and whether a
processor below x86-64-v3 is refused. Exit status 1 if any two differ, or if it is not.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
TASKS = ("gathering", "sorting", "art_manip")
# As tests/nodes/beam_coordinator/same_bits_test.cpp.
SMALL = ("search.transitions=300", "search.breadth=4", "search.depth=3")
LARGE = ("search.transitions=3000",)
# Which variants of its functions the C library and BLAS choose.
LIBRARIES = {
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX512F,-AVX512BW,-AVX512CD,-AVX512DQ,-AVX512VL",
    "OPENBLAS_CORETYPE": "Haswell",
}
EMULATED = ("qemu-x86_64", "-cpu", "Haswell")
TOO_OLD = ("qemu-x86_64", "-cpu", "Nehalem")


class Machine(NamedTuple):
    """A build and the processor on which it runs."""

    name: str
    program: Path
    prefix: Sequence[str] = ()
    environment: Mapping[str, str] = {}
    sizes: Sequence[Sequence[str]] = (SMALL, LARGE)


def build(processor: str) -> Path:
    """Returns the folder of a build for a processor."""
    folder = ROOT / "build" / f"bits-{processor}"
    configure = ["cmake", "--preset", "release", "-B", str(folder), f"-DRTG_PROCESSOR={processor}"]
    for command in (configure, ["ninja", "-C", str(folder), "generate_bench"]):
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"same_bits.py: {' '.join(command)} failed:\n{done.stdout}{done.stderr}")
    return folder


def digest(machine: Machine, task: str, settings: Sequence[str]) -> str:
    """Returns the digest of the transitions of a task."""
    command = [*machine.prefix, str(machine.program), f"{ROOT}/config/{task}.yaml", *settings]
    done = subprocess.run(
        command,
        env=os.environ | machine.environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        check=True,
    )
    return str(json.loads(done.stdout)["rows_sha256"])


def refuses(program: Path) -> bool:
    """Returns whether a program ends with a line and status 2 on a processor that is too old."""
    command = [*TOO_OLD, str(program)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    lines = [line for line in done.stderr.splitlines() if not line.startswith("qemu-x86_64: ")]
    return done.returncode == 2 and len(lines) == 1 and "this processor lacks" in lines[0]


def main(release: Path) -> int:
    program = Path("tests", "generate_bench")
    machines = (
        Machine("x86-64-v3", release / program),
        Machine("its libraries", release / program, environment=LIBRARIES),
        Machine("emulated", release / program, prefix=EMULATED, sizes=(SMALL,)),
        Machine("native", build("native") / program),
    )
    found: dict[tuple[str, str], set[str]] = {}
    for machine in machines:
        for settings in machine.sizes:
            for task in TASKS:
                one = digest(machine, task, settings)
                found.setdefault((task, settings[0]), set()).add(one)
                print(f"{task:10s} {settings[0]:24s} {machine.name:14s} {one}", flush=True)
    differ = [" ".join(which) for which, digests in found.items() if len(digests) > 1]
    print(f"the bits differ: {', '.join(differ)}" if differ else "all bits are the same")
    refused = refuses(release / program)
    print(f"a processor below x86-64-v3 is {'' if refused else 'not '}refused")
    return int(bool(differ) or not refused)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
