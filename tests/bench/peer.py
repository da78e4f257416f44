"""The reverse solver against CasADi and IPOPT: peer.py BUILD_FOLDER [EVERY]

Takes each EVERY-th (20) committed problem in which bodies may touch. Checks our objective and
constraints at our solutions against CasADi's, solves the same problem with IPOPT from the same warm
start to the same tolerances, and compares objectives and CPU times. Where our solution reaches the
final state objectives are compared, whether IPOPT's does or not; where we say that none does, ours
counts as worse if IPOPT's does. Needs casadi (tests/bench/requirements.txt). Exit status 1 if a
gate fails.
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


@dataclass(frozen=True)
class Row:
    """A problem with both solutions."""

    dump: Json  # with ours
    disagreement: float
    peer: Peer | None  # without a warm start IPOPT is not run

    @property
    def decided(self) -> bool:
        """Whether we found a solution or that there is none."""
        return self.dump["status"] in ("converged", "infeasible")

    @property
    def both(self) -> bool:
        """Whether IPOPT ended, too."""
        return self.decided and self.peer is not None and self.peer.converged

    def __str__(self) -> str:
        d, peer = self.dump, self.peer
        words = f"{d['line']:5} {d['difficulty']:8} {self.disagreement:8.1e} | {d['status']:15}"
        words += f"{d['iterations']:5} {d['cpu_s']:8.4f} {d['objective']:9.4f} | "
        if peer is None:
            return words + "no warm start"
        end = "failed" if not peer.converged else "" if peer.reaches_end else "misses the end"
        return f"{words}{peer.iterations:5} {peer.cpu:8.3f} {peer.objective:9.4f} {end}"


def compared(dump: Json) -> Row:
    """Solves the problem with IPOPT."""
    problem = PeerProblem(dump)
    return Row(dump, disagreement(problem), solve(problem) if dump["warm"] else None)


def margin(row: Row) -> float | None:
    """By how much our objective is less than IPOPT's, if that is a comparison."""
    if row.dump["status"] == "converged":
        return float(row.peer.objective - row.dump["objective"])
    return -np.inf if row.peer.reaches_end else None  # we say that there is no solution


def main(build: Path, every: int) -> int:
    """Exit status."""
    print(" line difficulty disagree | we: status     iterations CPU [s] J | IPOPT: the same")
    rows = []
    for dump in dumped(build, every):
        rows.append(compared(dump))
        print(rows[-1], flush=True)
    both = [row for row in rows if row.both]
    margins: Floats = np.array([m for row in both if (m := margin(row)) is not None])
    decided, solved = (
        sum(r.decided for r in rows),
        sum(bool(r.peer and r.peer.converged) for r in rows),
    )
    print(f"\n{len(rows)} problems, decided by us {decided}, solved by IPOPT {solved}")
    print(f"objectives compared: {len(margins)}; ours less in {int((margins > NO_WORSE).sum())}")
    passed = [
        gate("peer.decided_by_us", decided / len(rows), ">=", 0.95),
        gate("peer.disagreement", float(np.max([r.disagreement for r in rows])), "<=", AGREEMENT),
        gate("peer.no_worse", float((margins >= -NO_WORSE).mean()), ">=", 0.95),
        gate(
            "peer.time_ratio", np.median([r.peer.cpu / r.dump["cpu_s"] for r in both]), ">=", 100.0
        ),
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
