"""Writes RESULTS.md and results.png beside itself: results.py OUT_FOLDER, after ./test.sh bench.

Reads what the benchmarks left in OUT_FOLDER; every figure of the page comes from there or is worked
out from it here.
"""

from __future__ import annotations

import contextlib
import io
import json
import sys
import textwrap
from pathlib import Path
from typing import Any

import gates
import matplotlib
import numpy as np
from table import all_times, name_of, share

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = Path(__file__).parent
Benchmarks = dict[str, dict[str, Any]]
_UNIT = 48  # jobs of a unit of work (nodes/jobs/services.hpp), at most
_THREADED = ("beam", "replay")
_LABELS = {
    "lanes": "ours",
    "cyclic_reduction": "cyclic reduction",
    "klu": "KLU",
    "hpipm": "HPIPM",
}
_PAPER_MS = 51.0  # one candidate, 48 in parallel on 16 cores (App. E)


def series(benchmarks: Benchmarks, family: str) -> tuple[list[int], list[float]]:
    """Sizes and times per candidate of FAMILY/N."""
    names = [name for name in benchmarks if name.startswith(f"{family}/")]
    sizes = [int(name.rsplit("/", 1)[1]) for name in names]
    return sizes, [share(benchmarks[name]) for name in names]


def exponent(benchmarks: Benchmarks, family: str) -> float:
    """Fits the exponent of the time in the size."""
    sizes, times = series(benchmarks, family)
    return float(np.polyfit(np.log(sizes), np.log(times), 1)[0])


def cpu() -> str:
    """The processor's name."""
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    return next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))


def paragraph(*sentences: str) -> str:
    """Wraps the text as the other pages are wrapped."""
    return textwrap.fill(" ".join(sentences), 120, break_long_words=False, break_on_hyphens=False)


def machine(context: dict[str, Any], benchmarks: Benchmarks) -> str:
    """Says what it was measured on."""
    return paragraph(
        f"`./test.sh bench` at commit `{context['commit']}`, {context['date'][:10]}:",
        f"{cpu()},",
        f"{context['num_cpus']} cores at {context['mhz_per_cpu']} MHz,",
        f"GCC {context['compiler']}, {context['lanes']} lanes,",
        f"{benchmarks['peak/fma']['GFLOP/s']:.0f} GFLOP/s in registers.",
        "Times are CPU times of one thread, with several threads real times; per candidate where",
        "several are solved at once.",
        "Made by `.venv/bin/python tests/bench/results.py build/bench`, not by hand.",
    )


def gate_table(benchmarks: Benchmarks) -> str:
    """The gates of the benchmarks."""
    lines = io.StringIO()
    with contextlib.redirect_stdout(lines):
        gates.check(all_times(benchmarks.values()))
    rows = [line.split() for line in lines.getvalue().splitlines()]
    body = [
        f"| `{name}` | {value} | {goal} | {verdict} |" for _, name, value, goal, verdict in rows
    ]
    return "\n".join(["| gate | value | goal | |", "|---|---:|---:|---|", *body])


def kkt_table(benchmarks: Benchmarks) -> str:
    """KKT solves by family, method and number of sub-steps [µs]."""
    families = {
        "kkt": "row in contact, quasi-static",
        "kkt_inertia": "row in contact, inertia",
        "kkt_random": "random, all bodies coupled",
    }
    rows = [
        f"| six bodies, h = | {' | '.join(_LABELS.values())} |",
        "|---|" + "---:|" * len(_LABELS),
    ]
    for family, words in families.items():
        for h in (16, 64, 256):
            solves = [benchmarks[f"{family}/{method}/{h}"] for method in _LABELS]
            times = [share(solve) for solve in solves]
            cells = [
                f"{time:.1f} ({time / times[0]:.1f} ×, {solve['residual']:.0e})"
                for time, solve in zip(times, solves, strict=True)
            ]
            rows.append(f"| {words}, {h} | {' | '.join(cells)} |")
    return "\n".join(rows)


def scaling_table(benchmarks: Benchmarks) -> str:
    """Cost over every size that can be chosen."""
    times = all_times(benchmarks.values())
    two = {what: times[f"{what}/threads/1"] / times[f"{what}/threads/2"] for what in _THREADED}
    by_h, by_bodies = (exponent(benchmarks, f) for f in ("sqp_iteration", "sqp_iteration_bodies"))
    fits = {what: gates.linearity(f"beam/{what}")(times) for what in ("breadth", "depth")}
    rows = [
        ("h, sub-steps of a push", "8, 256", "linear", f"h^{by_h:.2f} per SQP iteration"),
        (
            "M, bodies in a row",
            "2, 16",
            "M³ of elimination",
            f"M^{by_bodies:.2f} per SQP iteration",
        ),
        ("B, breadth", "4, 64", "linear", f"R² = {fits['breadth']:.4f}"),
        ("D, depth", "4, 24", "linear", f"R² = {fits['depth']:.4f}"),
        ("threads, beam search", "1, 2", "2 ×", f"{two['beam']:.2f} ×"),
        ("threads, replay of 64 pushes", "1, 2", "2 ×", f"{two['replay']:.2f} ×"),
    ]
    lines = [f"| {' | '.join(row)} |" for row in rows]
    return "\n".join(["| in | from, to | on paper | measured |", "|---|---|---|---|", *lines])


def plots(benchmarks: Benchmarks) -> None:
    """results.png."""
    panels = [
        ("kkt/{}", "h, sub-steps", "KKT solve [µs]", True),
        ("sqp_iteration", "h, sub-steps", "SQP iteration [µs]", True),
        ("sqp_iteration_bodies", "M, bodies", "SQP iteration [µs]", True),
        ("beam/breadth", "B, four layers", "beam search [ms]", False),
        ("beam/depth", "D, breadth eight", "beam search [ms]", False),
    ]
    figure, axes = plt.subplots(1, len(panels), figsize=(17, 3.4), layout="constrained")
    for axis, (family, size, time, logarithmic) in zip(axes, panels, strict=True):
        methods = list(_LABELS) if "{}" in family else [""]
        for method in methods:
            sizes, times = series(benchmarks, family.format(method))
            axis.plot(sizes, times, "o-", label=_LABELS.get(method))
        if logarithmic:
            axis.set(xscale="log", yscale="log")
            ticks = sizes if len(sizes) < 7 else sizes[::2]
            axis.set_xticks(ticks, [str(n) for n in ticks])
            axis.minorticks_off()
        else:
            axis.set(xlim=0, ylim=0)
        axis.set(xlabel=size, ylabel=time)
        axis.grid(alpha=0.3)
    axes[0].legend(fontsize=8)
    figure.savefig(HERE / "results.png", dpi=110)


def many_workers(benchmarks: Benchmarks) -> str:
    """Tells what the measurements say about more workers than there were."""
    one = benchmarks["beam/threads/1"]
    layer, serial = one["layer_ms"], one["layer_ms"] * one["search_share"]
    breadth = round(one["nodes_per_layer"])
    jobs = 48 * breadth * (1.0 - benchmarks["action48"]["pruned"])
    most = jobs / benchmarks["kkt/lanes/16"]["candidates"]
    fastest = layer / (serial + (layer - serial) / most)
    rows = ["| workers | layer [ms] | faster by |", "|---:|---:|---:|"]
    for workers in (1, 2, 4, 16, 64, 256, 1000):
        time = serial + (layer - serial) / min(workers, most)
        rows.append(f"| {workers} | {time:.0f} | {layer / time:.1f} |")
    before = paragraph(
        f"A layer of {breadth} nodes takes {layer:.0f} ms on one core. The search itself, which is",
        f"serial, has {serial:.0f} ms of them ({100.0 * one['search_share']:.1f} %).",
        f"The solves that survive pruning, about {jobs:.0f}, and their replays are independent.",
        f"Handed out by a worker's lanes they keep at most {most:.0f} workers busy at once, in the",
        f"units of up to {_UNIT} that go over LCM {jobs / _UNIT:.0f}.",
        "Worked out from these figures of one core, with equal work for all and messages for",
        "nothing:",
    )
    after = paragraph(
        f"So a thousand workers on one tree are no faster than {most:.0f}, {fastest:.0f} × one:",
        "the serial part and the last solves are what is left of a layer.",
        "More breadth keeps more workers busy but does not move that bound, as both parts are",
        "linear in it; trees of their own, one per few dozen workers, do.",
    )
    return "\n\n".join([before, "\n".join(rows), after])


def candidates(benchmarks: Benchmarks) -> str:
    """All candidates of a state."""
    ours = benchmarks["action48"]
    return paragraph(
        f"On one core {share(ours):.1f} ms with the preset `default`:",
        f"{100 * ours['converged']:.1f} % of those that survive pruning converge, in",
        f"{ours['iterations_median']:.0f} iterations in the median.",
        f"The published figure is {_PAPER_MS:g} ms for one candidate, with 48 in parallel on",
        "16 cores of another machine.",
    )


def pushes(out: Path) -> str:
    """Pushes found by both presets, and the time of each."""
    before = paragraph(
        "From the ends of pushes of Box2D that move an object by half a metre or more: the pushes",
        "that a preset finds (its start drags an object, and Box2D leads from it back to the end),",
        "and the CPU time of all solves per push found. A gate for each task asks for the share of",
        "the pushes found; another compares these times, where `paper` has found five or more.",
        "`tests/bench/true_pushes.cpp` says what the columns are.",
    )
    return before + "\n\n```\n" + (out / "true_pushes.txt").read_text().strip() + "\n```"


def printed(file: Path) -> str:
    """What another benchmark printed, word for word."""
    return f"```\n{file.read_text().strip()}\n```"


def main(out: Path) -> None:
    """Writes the page."""
    result = json.loads((out / "rtg_bench.json").read_text())
    benchmarks = {name_of(one): one for one in result["benchmarks"]}
    plots(benchmarks)
    own = benchmarks["kkt/hpipm/16"]
    newton = paragraph(
        "µs per problem on one core, in parentheses how many times ours, and the residual",
        "‖K x - r‖ / (‖r‖ + ‖x‖). Factorisation and solution; the peers do not pay for assembling",
        "the blocks, for orderings, symbolic analysis and copies into their own formats. They",
        "solve one problem at a time; ours is a share of all lanes, and alone in them it takes the",
        "time of all (the gates of latency). HPIPM takes explicit dynamics, whose",
        f"elimination is in its time: of {own['cpu_time']:.0f} µs on the quasi-static row over 16",
        f"sub-steps {own['own_us']:.0f} µs are its own part. It comes from casadi's wheel, whose",
        "BLASFEO is built for any processor; one built for this one would make that part shorter.",
    )
    sections = [
        "# Results of the benchmarks",
        machine(result["context"], benchmarks),
        "## Gates",
        gate_table(benchmarks),
        "## The 48 candidates of a state",
        candidates(benchmarks),
        "The same from Python and in C++, and gates of their ratio (`tests/bench/binding.py`):",
        printed(out / "binding.txt"),
        "## Pushes solved back",
        pushes(out),
        "## Newton systems",
        newton,
        kkt_table(benchmarks),
        "## Scaling",
        scaling_table(benchmarks),
        "![Times over h, M, B and D](results.png)",
        "## Learner",
        paragraph(
            "Times of a gradient step on one core, and its gates; `tests/bench/learner.py` says",
            "what they are.",
        ),
        printed(out / "learner.txt"),
        "## Generation and messages",
        paragraph(
            "Times of a generation of Gathering and of whole runs of it, and their gates;",
            "`tests/bench/generation.py` says what they are.",
        ),
        printed(out / "generation.txt"),
        "## Whole jobs",
        paragraph(
            "From `./run.sh TASK` to a policy that solves 95 of 100 held-out starts in three",
            "evaluations in a row; `tests/bench/whole.py` says what the columns are.",
        ),
        (out / "whole" / "whole.md").read_text().strip(),
        "## A thousand workers",
        many_workers(benchmarks),
    ]
    (HERE / "RESULTS.md").write_text("\n\n".join(sections) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
