"""The reverse solver against CasADi and IPOPT: peer.py BUILD_FOLDER [EVERY]

Takes each EVERY-th (20) committed problem in which bodies may touch. Checks our objective and
constraints at our solutions against CasADi's, solves the same problem with IPOPT from the same warm
start to the same tolerances, and compares objectives and CPU times. Where we say that no solution
reaches the final state, our objective counts as worse if IPOPT's solution does, and is not compared
if it does not. Needs casadi (tests/bench/requirements.txt). Exit status 1 if a gate fails.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from dataclasses import dataclass
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


@dataclass(frozen=True)
class Peer:
    """How IPOPT ended."""

    converged: bool
    reaches_end: bool  # within the tolerance
    objective: float
    cpu: float  # [s]
    iterations: int


def solve(problem: PeerProblem) -> Peer:
    """IPOPT from the warm start."""
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
    reaches_end = (
        problem.terminal_miss(np.array(found["x"]).ravel()) <= tolerances["terminal_tolerance"]
    )
    objective, iterations = float(found["f"]), int(status["iter_count"])
    return Peer(bool(status["success"]), reaches_end, objective, cpu, iterations)


class Comparison:
    """What the problems seen so far amount to; prints a line of each."""

    def __init__(self) -> None:
        self.decided, self.solved_by_peer = 0, 0
        self.disagreement = 0.0
        self.margins: list[float] = []
        self.ratios: list[float] = []
        print(" line difficulty disagree | we: status     iterations CPU [s] J | IPOPT: the same")

    def add(self, dump: Json) -> None:
        """Solves the problem with IPOPT."""
        problem = PeerProblem(dump)
        error = disagreement(problem)
        self.disagreement = float(np.maximum(self.disagreement, error))
        decided = dump["status"] in ("converged", "infeasible")
        self.decided += decided
        words = f"{dump['line']:5} {dump['difficulty']:8} {error:8.1e} | {dump['status']:15}"
        words += f"{dump['iterations']:5} {dump['cpu_s']:8.4f} {dump['objective']:9.4f} | "
        if dump["warm"] is None:
            print(words + "no warm start", flush=True)
            return
        peer = solve(problem)
        self.solved_by_peer += peer.converged
        end = "failed" if not peer.converged else "" if peer.reaches_end else "misses the end"
        print(f"{words}{peer.iterations:5} {peer.cpu:8.3f} {peer.objective:9.4f} {end}", flush=True)
        if not decided or not peer.converged:
            return
        self.ratios.append(peer.cpu / dump["cpu_s"])
        if dump["status"] == "converged":
            self.margins.append(peer.objective - dump["objective"])
        elif peer.reaches_end:
            self.margins.append(-np.inf)  # we say that there is no solution


def main(build: Path, every: int) -> int:
    """Exit status."""
    seen = Comparison()
    problems = dumped(build, every)
    for dump in problems:
        seen.add(dump)
    both: Floats = np.array(seen.margins)
    print(f"\n{len(problems)} problems, decided by us {seen.decided}, ", end="")
    print(f"solved by IPOPT {seen.solved_by_peer}")
    print(f"objectives compared: {len(both)}; ours is better in {int((both > NO_WORSE).sum())}")
    passed = [
        gate("peer.decided_by_us", seen.decided / len(problems), ">=", 0.95),
        gate("peer.disagreement", seen.disagreement, "<=", AGREEMENT),
        gate("peer.no_worse", float((both >= -NO_WORSE).mean()), ">=", 0.95),
        gate("peer.time_ratio", float(np.median(seen.ratios)), ">=", 100.0),
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
