"""The reverse solver against CasADi and IPOPT: peer.py BUILD_FOLDER [EVERY]

Takes each EVERY-th (20) committed problem in which bodies may touch. Checks our objective and
constraints at our solutions against CasADi's, solves the same problem with IPOPT from the same warm
start to the same tolerances, and compares objectives and CPU times. Needs casadi
(tests/bench/requirements.txt). Exit status 1 if a gate fails.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
from gates import gate
from peer_problem import Floats, Json, PeerProblem

AGREEMENT = 1e-8  # of values
NO_WORSE = 1e-3  # of objectives


def dumped(build: Path, every: int) -> list[Json]:
    """The problems with our solutions."""
    corpus = Path(__file__).parent / "corpus"
    command = [str(build / "tests" / "peer_dump"), str(corpus), str(every)]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.returncode)
    return [json.loads(line) for line in done.stdout.splitlines()]


def disagreement(problem: PeerProblem) -> float:
    """Largest difference of objective and constraints at our solution, relative for large ones."""
    dump = problem.dump
    parts = [problem.objective, *problem.residuals, *problem.complementarity]
    values = ca.Function("values", [problem.x], parts)(problem.unknowns(dump["solution"]))
    ours = [[dump["objective"]], *dump["residuals"][1:], *dump["complementarity"]]
    worst = 0.0
    for theirs, mine in zip(values, ours, strict=True):
        own = np.array(mine)
        gap = np.abs(np.array(theirs).ravel() - own) / np.maximum(1.0, np.abs(own))
        worst = float(np.maximum(worst, gap.max(initial=0.0)))  # a NaN stays one
    return worst


def solve(problem: PeerProblem) -> tuple[bool, float, float, int]:
    """IPOPT from the warm start: whether it converged, objective, CPU time [s], iterations."""
    tolerances = problem.dump["reverse"]
    constraints = ca.vertcat(*problem.residuals, *problem.complementarity, problem.gaps)
    equalities = constraints.shape[0] - problem.gaps.shape[0]
    nlp = {"x": problem.x, "f": problem.objective, "g": constraints}
    options: Json = {
        "ipopt.print_level": 0,
        "ipopt.sb": "yes",
        "print_time": False,
        "show_eval_warnings": False,
        "ipopt.max_iter": 500,
        "ipopt.max_cpu_time": 60.0,
        "ipopt.tol": tolerances["stationarity_tol"],
        "ipopt.dual_inf_tol": tolerances["stationarity_tol"],
        "ipopt.constr_viol_tol": tolerances["feasibility_tol"],
    }
    solver = ca.nlpsol("peer", "ipopt", nlp, options)
    upper = np.concatenate([np.zeros(equalities), np.full(problem.gaps.shape[0], np.inf)])
    begin = time.process_time()
    found = solver(x0=problem.unknowns(problem.dump["warm"]), lbg=0.0, ubg=upper)
    cpu = time.process_time() - begin
    status: dict[str, Any] = solver.stats()
    return bool(status["success"]), float(found["f"]), cpu, int(status["iter_count"])


def main(build: Path, every: int) -> int:
    """Exit status."""
    worst, margins, ratios = 0.0, [], []
    ours, theirs = 0, 0
    print(" line difficulty disagree | we: status     iterations CPU [s] J | IPOPT: the same")
    problems = dumped(build, every)
    for dump in problems:
        problem = PeerProblem(dump)
        error = disagreement(problem)
        worst = float(np.maximum(worst, error))
        solved = dump["status"] in ("converged", "infeasible")
        ours += solved
        words = f"{dump['line']:5} {dump['difficulty']:8} {error:8.1e} | {dump['status']:15}"
        words += f"{dump['iterations']:5} {dump['cpu_s']:8.4f} {dump['objective']:9.4f} | "
        if dump["warm"] is None:
            print(words + "no warm start", flush=True)
            continue
        success, objective, cpu, iterations = solve(problem)
        theirs += success
        end = "" if success else " failed"
        print(f"{words}{iterations:5} {cpu:8.3f} {objective:9.4f}{end}", flush=True)
        if solved and success:
            margins.append(objective - dump["objective"])
            ratios.append(cpu / dump["cpu_s"])
    both: Floats = np.array(margins)
    no_worse = float((both >= -NO_WORSE).mean())
    ratio = float(np.median(ratios))
    print(f"\n{len(problems)} problems, solved by us {ours}, by IPOPT {theirs}, both {len(both)}")
    passed = [
        gate("peer.decided_by_us", ours / len(problems), ">=", 0.95),
        gate("peer.disagreement", worst, "<=", AGREEMENT),
        gate("peer.no_worse", no_worse, ">=", 0.95),
        gate("peer.time_ratio", ratio, ">=", 100.0),
    ]
    return int(not all(passed))


def arguments() -> argparse.Namespace:
    """Of the command line; exit status 2 if they are wrong."""
    parser = argparse.ArgumentParser("peer", description=__doc__.split(":")[0], allow_abbrev=False)
    parser.add_argument("build", metavar="BUILD_FOLDER", type=Path)
    parser.add_argument("every", metavar="EVERY", type=int, nargs="?", default=20)
    return parser.parse_args()


if __name__ == "__main__":
    given = arguments()
    sys.exit(main(given.build, given.every))
