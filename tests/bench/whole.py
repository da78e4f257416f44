"""Measures whole jobs, from `./run.sh TASK` to a policy that works: the time that a user waits.

    whole.py OUT [--tasks a,b] [--seeds 1,2] [--against CHECKOUT] [--smoke]

Each run is stopped by train.stop_at_success, 0.95 in three evaluations in a row by default. Its
folder is OUT/NAME/TASK-seed-N, where NAME is `this` or `other`; runs that are there already are not
made again. Prints medians over the seeds as Markdown, also to OUT/whole.md, and a gate: the wall
time of Gathering [s].

--against: a checkout of another commit that is set up, whose runs take turns with ours. All have
evaluations at equal distances then, so that one rule stops them, and further gates are the ratios
of wall time, CPU time and interactions.

--smoke makes tiny runs of the first task, which only show that it works, without gates. Exit status
1 if a gate failed.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import cpu_time
from gates import gate

ROOT = Path(__file__).resolve().parents[2]
TASKS = ("gathering", "sorting", "art_manip")
_SMOKE = (
    "--in-process",
    "--transitions",
    "500",
    "--interactions",
    "200",
    "--set",
    "train.eval_episodes=2",
)
# Evaluations of commits until 57aa8b6 are as far apart by default.
_ONE_RULE = ("--set", "train.eval_every=5000")
_LONGEST = 40.0  # wall time of Gathering [s]
_LEAST = {"interactions": 1.0, "job_wall_s": 4.0, "job_cpu_s": 4.0}  # ratios, other by this

Figures = dict[str, Any]


def run(checkout: Path, folder: Path, words: Sequence[str]) -> Figures:
    """Runs a job unless it is there. Returns its summary, with what it took from end to end."""
    note = folder / "whole.json"
    if not note.exists():
        folder.parent.mkdir(parents=True, exist_ok=True)
        begin, before = time.monotonic(), cpu_time.of_children()
        command = [str(checkout / "run.sh"), *words, "--out", str(folder)]
        with folder.with_suffix(".log").open("w") as log:
            subprocess.run(command, cwd=checkout, stdout=log, stderr=log, check=True)
        wall, cpu = time.monotonic() - begin, cpu_time.of_children() - before
        note.write_text(json.dumps({"job_wall_s": wall, "job_cpu_s": cpu}))
    summary: Figures = json.loads((folder / "summary.json").read_text())
    return {**summary, **json.loads(note.read_text())}


def middle(runs: Sequence[Figures], key: str) -> float:
    return statistics.median(float(one[key]) for one in runs)


def ratio(by_name: dict[str, list[Figures]], key: str) -> float:
    """Compares the medians of the other checkout and of this one."""
    return middle(by_name["other"], key) / middle(by_name["this"], key)


def gates_hold(runs: dict[str, dict[str, list[Figures]]]) -> bool:
    """Prints the gates and returns whether all hold."""
    held = []
    if "gathering" in runs:
        wall = middle(runs["gathering"]["this"], "job_wall_s")
        held.append(gate("whole.gathering.job_wall_s", wall, "<=", _LONGEST))
    for task, by_name in runs.items():
        if "other" in by_name:
            for key, least in _LEAST.items():
                held.append(gate(f"whole.{task}.{key}", ratio(by_name, key), ">=", least))
    return all(held)


def jobs_table(runs: dict[str, dict[str, list[Figures]]]) -> list[str]:
    """A row for each task and checkout: what its runs came to and took."""
    lines = [
        "| task | checkout | seeds | success | interactions | wall [s] | CPU [s] |",
        "|---|---|---:|---:|---:|---:|---:|",
    ]
    for task, by_name in runs.items():
        for name, found in by_name.items():
            figures = [middle(found, k) for k in ("success_rate", "interactions")]
            took = [middle(found, k) for k in ("job_wall_s", "job_cpu_s")]
            words = f"{figures[0]:.2f} | {figures[1]:,.0f} | {took[0]:.1f} | {took[1]:.1f}"
            lines.append(f"| {task} | {name} | {len(found)} | {words} |")
        if "other" in by_name:
            words = " | ".join(f"{ratio(by_name, key):.2f} ×" for key in _LEAST)
            lines.append(f"| {task} | other / this | | | {words} |")
    return lines


def stages_table(runs: dict[str, list[Figures]]) -> list[str]:
    """A row for each stage of our runs: wall and processor time by task."""
    names = list(dict.fromkeys(n for found in runs.values() for one in found for n in stages(one)))
    lines = [
        "| stage |" + "".join(f" {task}: wall [s] | CPU [s] |" for task in runs),
        "|---|" + "---:|---:|" * len(runs),
    ]
    for name in names:
        cells = [
            seconds([stages(one).get(name, {}).get(key) for one in found])
            for found in runs.values()
            for key in ("wall_s", "cpu_s")
        ]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return lines


def seconds(values: Sequence[float | None]) -> str:
    known = [value for value in values if value is not None]
    return f"{statistics.median(known):.1f}" if known else "–"


def stages(one: Figures) -> dict[str, dict[str, float]]:
    """Returns the times of a run's stages [s], as far as they are known.

    The last one is what the processes used beside the others: set-up and start, the search's own
    work, messages, pictures. Over LCM learning goes on beside generation.
    """
    found = {"start": {"wall_s": one["start_wall_s"]}}
    for part in ("generation", "learning"):
        for name, times in (one.get(f"{part}_stages") or {}).items():
            found[f"{part}: {name.replace('_', ' ')}"] = times
    known = sum(times.get("cpu_s", 0.0) for times in found.values())
    return {**found, "all else": {"cpu_s": one["job_cpu_s"] - known}}


def main(words: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(description="Measures whole jobs.")
    parser.add_argument("out", type=Path)
    parser.add_argument("--tasks", default=",".join(TASKS))
    parser.add_argument("--seeds", default="1")
    parser.add_argument("--against", type=Path)
    parser.add_argument("--smoke", action="store_true")
    args = parser.parse_args(words)
    checkouts = {"this": ROOT, **({"other": args.against.resolve()} if args.against else {})}
    tasks, seeds = args.tasks.split(","), args.seeds.split(",")
    if args.smoke:
        tasks, seeds = tasks[:1], seeds[:1]
    settings = _SMOKE if args.smoke else _ONE_RULE if args.against else ()
    runs: dict[str, dict[str, list[Figures]]] = {}
    for task in tasks:
        runs[task] = {name: [] for name in checkouts}
        for seed in seeds:
            for name, checkout in checkouts.items():
                folder = args.out.resolve() / name / f"{task}-seed-{seed}"
                line = [task, "--seed", seed, *settings]
                print(f"{name}: {' '.join(line)}", file=sys.stderr, flush=True)
                runs[task][name].append(run(checkout, folder, line))
    ours = {task: by_name["this"] for task, by_name in runs.items()}
    text = "\n".join([*jobs_table(runs), "", *stages_table(ours)]) + "\n"
    (args.out / "whole.md").write_text(text)
    print(text, flush=True)
    return 0 if args.smoke or gates_hold(runs) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
