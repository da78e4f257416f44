"""Measures a generation of Gathering, and what messages cost a run.

    generation.py BUILD_FOLDER [--smoke]

Prints times, medians of repetitions that take turns, and four gates:

- `generation.serial_share`: with one thread, the time outside of the loops that several threads
  share, as a share of the whole;
- `generation.two_threads_by_one`: the time with one thread by that with two;
- `run.messages`: how much more CPU time the processes of a run over LCM use beside the stages of
  generation and learning than the same run within one process, as a share of all that the former
  use. It contains the start of these processes, and receiving;
- `run.start`: from the first line of a run over LCM to its first transition [s].

A run here is ./run.sh with the default settings and as many interactions as it takes to solve the
task. --smoke makes tiny runs and leaves out the gates. Exit status 1 if a gate failed.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import cpu_time
from gates import gate
from rtg import paths

TASK = "gathering"
ROOT = Path(__file__).resolve().parents[2]
_WHOLE = ("--interactions", "17500", "--set", "train.stop_at_success=0")
_TINY = ("--interactions", "200", "--transitions", "500", "--set", "train.eval_episodes=2")

Figures = dict[str, float]


def bench(build: Path, threads: int, smoke: bool) -> Figures:
    """Generates in one C++ process; returns wall times [s], in all and outside of the stages."""
    command = [str(build / "tests" / "generate_bench"), str(paths.CONFIG / f"{TASK}.yaml")]
    command += ["--threads", str(threads), *(["search.transitions=500"] if smoke else [])]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
    report = json.loads(done.stdout)
    shared = sum(stage["wall_s"] for stage in report["generation_stages"].values())
    return {"wall": report["generate_wall_s"], "serial": report["generate_wall_s"] - shared}


def run(smoke: bool, *words: str) -> Figures:
    """Makes a run; returns CPU times of its processes and its start [s]."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "run"
        command = [str(ROOT / "run.sh"), TASK, "--workers", "2"]
        command += [*(_TINY if smoke else _WHOLE), *words]
        before = cpu_time.of_children()
        subprocess.run([*command, "--out", str(out)], capture_output=True, check=True)
        cpu = cpu_time.of_children() - before
        summary = json.loads((out / "summary.json").read_text())
    mode = "in_process" if "--in-process" in words else "lcm"
    if summary["mode"] != mode:
        sys.exit(
            f"generation.py: the run was {summary['mode']} instead of {mode}; multicast is off"
        )
    work = sum(
        times["cpu_s"]
        for part in ("generation_stages", "learning_stages")
        for stage, times in summary[part].items()
        if stage != "receiving"
    )
    return {"cpu": cpu, "beside the stages": cpu - work, "start": summary["start_wall_s"]}


def main(words: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(description="Measures a generation.")
    parser.add_argument("build", type=Path)
    parser.add_argument("--smoke", action="store_true")
    args = parser.parse_args(words)
    found: dict[str, list[Figures]] = {"one": [], "two": [], "in process": [], "over LCM": []}
    for _ in range(1 if args.smoke else 3):
        found["one"].append(bench(args.build, 1, args.smoke))
        found["two"].append(bench(args.build, 2, args.smoke))
        found["in process"].append(run(args.smoke, "--in-process"))
        found["over LCM"].append(run(args.smoke))
    middle = {
        name: {key: statistics.median(one[key] for one in all_of_it) for key in all_of_it[0]}
        for name, all_of_it in found.items()
    }
    for name, figures in middle.items():
        print(name, ", ".join(f"{key} {value:.2f} s" for key, value in figures.items()))
    if args.smoke:
        return 0
    one, two, within, over = middle.values()
    messages = over["beside the stages"] - within["beside the stages"]
    held = (
        gate("generation.serial_share", one["serial"] / one["wall"], "<=", 0.1),
        gate("generation.two_threads_by_one", one["wall"] / two["wall"], ">=", 1.85),
        gate("run.messages", messages / over["cpu"], "<=", 0.05),
        gate("run.start", over["start"], "<=", 2.0),
    )
    return 0 if all(held) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
