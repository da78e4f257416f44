"""Runs the benchmarks: table.py BUILD_FOLDER OUT_FOLDER [--smoke].

Leaves rtg_bench.json (Google Benchmark's own format) and table.md in OUT_FOLDER and prints the
table, then what the reverse solver makes of the committed problems and of pushes of Box2D, which
it leaves in true_pushes.txt. Times are CPU times of one
thread, where several work real times. --smoke runs the benchmarks as briefly as can be: it shows
that they work, not how fast anything is, and leaves out the gates on time. Exit status 1 if a
benchmark refused its own result or a gate failed.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import gates

# Keys of a benchmark in Google Benchmark's JSON that are not counters of ours.
_OWN_KEYS = {
    "name",
    "aggregate_name",
    "aggregate_unit",
    "family_index",
    "per_family_instance_index",
    "run_name",
    "run_type",
    "repetitions",
    "repetition_index",
    "threads",
    "iterations",
    "real_time",
    "cpu_time",
    "time_unit",
    "error_occurred",
    "error_message",
    "label",
}


HERE = Path(__file__).parent

# Tasks whose pushes are solved back, without and with joints.
_FREE_TASKS = ("config/gathering.yaml", "config/sorting.yaml")
_JOINTED_TASKS = (
    "config/art_manip.yaml",
    "tests/bench/corpus_joints/chain.yaml",
    "config/examples/door.yaml",
)

# Benchmarks too long for --smoke; a POSIX extended regular expression, which has no \d.
_LONG = r"/256|beam/breadth/[0-9][0-9]|beam/depth/[0-9][0-9]|beam/threads"


def measure(build: Path, out: Path, smoke: bool) -> dict[str, Any]:
    """Runs the benchmarks; returns what Google Benchmark wrote."""
    file = out / "rtg_bench.json"
    command = [str(build / "tests" / "rtg_bench"), f"--benchmark_out={file}"]
    command.append("--benchmark_enable_random_interleaving=true")  # of repetitions
    if smoke:
        command += ["--benchmark_min_time=0.001", f"--benchmark_filter=-({_LONG})"]
    subprocess.run(command, check=True, stdout=sys.stderr)
    result: dict[str, Any] = json.loads(file.read_text())
    single = (None, "median")  # of benchmarks that are repeated
    result["benchmarks"] = sorted(
        (b for b in result["benchmarks"] if b.get("aggregate_name") in single),
        key=lambda b: (b["family_index"], b["per_family_instance_index"]),
    )
    result["context"]["commit"] = commit()
    file.write_text(json.dumps(result, indent=1))
    return result


def check_peers(build: Path) -> None:
    """Ends the program if a peer is missing that a gate needs."""
    command = [str(build / "tests" / "rtg_bench"), "--benchmark_list_tests"]
    listed = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout
    for peer in gates.PEERS:
        if f"kkt/{peer}/16" not in listed.splitlines():
            sys.exit(f"table.py: the benchmarks are built without {peer}; ./test.sh bench does it")


def commit() -> str:
    """Names the commit that is measured, with a mark if the files differ from it."""
    return subprocess.run(
        ["git", "describe", "--always", "--dirty"],
        cwd=HERE,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    ).stdout.strip()


def solves_the_corpus(build: Path, folder: str) -> bool:
    """Runs the reverse solver over committed problems and returns whether it met its gates."""
    command = [str(build / "tests" / "reverse_corpus"), str(HERE / folder)]
    return subprocess.run(command, check=False).returncode == 0


def finds_true_pushes(build: Path, out: Path, tasks: tuple[str, ...], *options: str) -> bool:
    """Solves back from the ends of pushes of Box2D; returns whether the gates hold. Adds to OUT."""
    files = [str(HERE.parents[1] / task) for task in tasks]
    command = [str(build / "tests" / "true_pushes"), *files, *options]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    with (out / "true_pushes.txt").open("a") as file:
        file.write(done.stdout)
    print(done.stdout, flush=True)
    return done.returncode == 0


def solver_gates(build: Path, out: Path, smoke: bool) -> bool:
    """Runs the checks of the reverse solver and returns whether their gates hold."""
    (out / "true_pushes.txt").write_text("")
    if smoke:
        passed = solves_the_corpus(build, "corpus")
        return passed & finds_true_pushes(build, out, _FREE_TASKS[:1], "--count", "20")
    return all(
        [
            solves_the_corpus(build, "corpus"),
            solves_the_corpus(build, "corpus_joints"),
            finds_true_pushes(build, out, _FREE_TASKS, "--compare"),
            finds_true_pushes(build, out, _JOINTED_TASKS),
        ]
    )


_REAL = "/real_time"  # at the end of the names of benchmarks that are measured so


def name_of(benchmark: dict[str, Any]) -> str:
    """Returns the name without how often it ran and how it was measured."""
    return re.sub(rf"/(iterations|repeats):\d+|{_REAL}$", "", benchmark["run_name"])


def time_of(benchmark: dict[str, Any]) -> float:
    """Real time of benchmarks over threads, CPU time of the others."""
    real = benchmark["run_name"].endswith(_REAL)
    time: float = benchmark["real_time" if real else "cpu_time"]
    return time


def share(benchmark: dict[str, Any]) -> float:
    """Time per candidate, of benchmarks that solve several at once."""
    candidates: float = benchmark.get("candidates", 1.0)
    return time_of(benchmark) / candidates


def all_times(benchmarks: Iterable[dict[str, Any]]) -> gates.Times:
    """Returns the times that the gates ask for."""
    times = {}
    for one in benchmarks:
        times[name_of(one)] = share(one)
        times[gates.PACK + name_of(one)] = time_of(one)
    return times


def row(benchmark: dict[str, Any]) -> str:
    """Returns the benchmark's line of the table."""
    name = name_of(benchmark)
    if benchmark.get("error_occurred"):
        return f"| `{name}` | | {benchmark['error_message']} |"
    counters = [f"{key} {value:.3g}" for key, value in benchmark.items() if key not in _OWN_KEYS]
    time = f"{time_of(benchmark):.4g} {benchmark['time_unit']}"
    return f"| `{name}` | {time} | {', '.join(counters)} |"


def table(result: dict[str, Any]) -> str:
    """The benchmarks as Markdown."""
    context = result["context"]
    lines = [
        f"{context['date']}, {context['num_cpus']} × {context['mhz_per_cpu']} MHz",
        "",
        "| benchmark | time | |",
        "|---|---:|---|",
        *(row(benchmark) for benchmark in result["benchmarks"]),
    ]
    return "\n".join(lines) + "\n"


def main(build: Path, out: Path, smoke: bool) -> int:
    """Returns the exit status."""
    out.mkdir(parents=True, exist_ok=True)
    check_peers(build)
    result = measure(build, out, smoke)
    text = table(result)
    (out / "table.md").write_text(text)
    print(text, flush=True)
    if any(benchmark.get("error_occurred") for benchmark in result["benchmarks"]):
        return 1
    passed = solver_gates(build, out, smoke)
    if not smoke:
        passed &= gates.check(all_times(result["benchmarks"]))
    return int(not passed)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2]), smoke="--smoke" in sys.argv[3:]))
