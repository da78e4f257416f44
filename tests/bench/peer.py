"""The reverse solver against CasADi and IPOPT: peer.py BUILD_FOLDER [EVERY] [PUSHES]

Takes each EVERY-th (20) committed problem in which bodies may touch. Checks our objective and
constraints at our solutions against CasADi's, solves the same problem with IPOPT from the same
start to the same tolerances, and compares objectives and CPU times. Where our solution reaches the
final state objectives are compared, whether IPOPT's does or not; where we say that none does, ours
counts as worse if IPOPT's does. Of IPOPT's time the values and derivatives of the functions, which
CasADi interprets, are left out, as if they cost nothing; ours has them.

Then takes PUSHES (8) pushes of Box2D each of Gathering and Sorting and solves back from their
ends, with the objective of the preset `default` and with the printed one of `paper`. Compares the
CPU times per push found: its solution drags an object, and Box2D leads from it back to the end. A
ratio of these times needs five pushes that IPOPT finds; with fewer its gate fails.

Needs casadi (tests/bench/requirements.txt). Exit status 1 if a gate fails.
"""

from __future__ import annotations

import argparse
import json
import math
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
from rtg import _core

AGREEMENT = 1e-8  # of values
NO_WORSE = 1e-3  # of objectives


HERE = Path(__file__).parent
DRAGGED = 0.05  # least way of an object from a start that drags [m]
MISS = 0.1  # largest replay gap of a push that is found, mean over the bodies [m]
FEWEST = 5  # pushes found; a time per push of fewer says nothing


def dumped(build: Path, *what: str) -> list[Json]:
    """Problems with our solutions, of `peer_dump WHAT`."""
    command = [str(build / "tests" / "peer_dump"), *what]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.returncode)
    return [json.loads(line) for line in done.stdout.splitlines()]


def disagreement(problem: PeerProblem) -> float:
    """Largest difference of objective and constraints at our solution, relative for large ones."""
    dump = problem.dump
    parts = [problem.objective, *problem.residuals, *problem.complementarity]
    values = ca.Function("values", [problem.x], parts)(problem.unknowns(dump["solution"]))
    ours = [[dump["objective"]], *dump["residuals"][1:]]
    if problem.complementarity:
        ours += dump["complementarity"]
    worst = 0.0
    for theirs, mine in zip(values, ours, strict=True):
        own = np.array(mine)
        gap = np.abs(np.array(theirs).ravel() - own) / np.maximum(1.0, np.abs(own))
        worst = float(np.maximum(worst, gap.max(initial=0.0)))  # a NaN stays one
    return worst


@dataclass(frozen=True)
class Peer:
    """Says how IPOPT ended."""

    converged: bool
    reaches_end: bool  # within the tolerance
    objective: float
    cpu: float  # [s], without the values and derivatives of the functions
    iterations: int
    x: Floats


def solve(problem: PeerProblem) -> Peer:
    """Runs IPOPT from the start of our SQP."""
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
    found = solver(x0=problem.unknowns(problem.dump["start"]), lbg=0.0, ubg=upper)
    cpu = time.process_time() - begin
    status: dict[str, Any] = solver.stats()
    cpu -= sum(value for name, value in status.items() if name.startswith("t_proc_nlp_"))
    x = np.array(found["x"]).ravel()
    reaches_end = problem.terminal_miss(x) <= tolerances["terminal_tolerance"]
    objective, iterations = float(found["f"]), int(status["iter_count"])
    return Peer(bool(status["success"]), reaches_end, objective, cpu, iterations, x)


@dataclass(frozen=True)
class Row:
    """A problem with both solutions."""

    dump: Json  # with ours
    disagreement: float
    peer: Peer

    @property
    def decided(self) -> bool:
        """Tells whether we found a solution or found that there is none."""
        return self.dump["status"] in ("converged", "infeasible")

    @property
    def both(self) -> bool:
        """Tells whether IPOPT ended, too."""
        return self.decided and self.peer.converged

    def __str__(self) -> str:
        d, peer = self.dump, self.peer
        words = f"{d['number']:5} {d['kind']:9} {self.disagreement:8.1e} | {d['status']:15}"
        words += f"{d['iterations']:5} {d['cpu_s']:8.4f} {d['objective']:9.4f} | "
        end = "failed" if not peer.converged else "" if peer.reaches_end else "misses the end"
        return f"{words}{peer.iterations:5} {peer.cpu:8.3f} {peer.objective:9.4f} {end}"


def compared(dump: Json) -> Row:
    """Solves the problem with IPOPT."""
    problem = PeerProblem(dump)
    return Row(dump, disagreement(problem), solve(problem))


def margin(row: Row) -> float | None:
    """Returns by how much our objective is less than IPOPT's; None if that is no comparison."""
    if row.dump["status"] == "converged":
        return float(row.peer.objective - row.dump["objective"])
    return -np.inf if row.peer.reaches_end else None  # we say that there is no solution


def over_the_corpus(build: Path, every: int) -> bool:
    """Compares objectives and times, and returns whether the gates hold."""
    rows = []
    for dump in dumped(build, "corpus", str(HERE / "corpus"), str(every)):
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
    ratios = [row.peer.cpu / row.dump["cpu_s"] for row in both]
    return all(
        [
            gate("peer.decided_by_us", decided / len(rows), ">=", 0.95),
            gate("peer.disagreement", max(r.disagreement for r in rows), "<=", AGREEMENT),
            gate("peer.no_worse", float((margins >= -NO_WORSE).mean()), ">=", 0.95),
            gate("peer.time_ratio", float(np.median(ratios)), ">=", 100.0),
        ]
    )


@dataclass
class Pushes:
    """Pushes that a solver finds, and the CPU time of all its solves [s]."""

    found: int = 0
    cpu: float = 0.0

    def add(self, problem: PeerProblem, x: Floats, cpu: float, box2d: Any) -> None:
        """Counts the solution `x`; none is empty."""
        self.cpu += cpu
        if x.size == 0:
            return
        start, end = problem.start_state(x), np.array(problem.dump["state"]).reshape(-1, 3)
        drags = np.hypot(*(start - end)[1:, :2].T).max() >= DRAGGED
        after, ok = box2d.push(start[None], np.array([problem.dump["action"]]))
        gap = np.hypot(*(after[0] - end)[:, :2].T).mean()
        self.found += bool(drags and ok[0] and gap <= MISS)

    @property
    def per_found(self) -> float:
        """CPU time per push found [s]."""
        return self.cpu / self.found if self.found else np.inf


def times_ours(peer: Pushes, ours: Pushes) -> float:
    """How many times our time per push found the peer takes.

    If the peer found too few, says so and returns NaN, with which no gate holds.
    """
    if peer.found >= FEWEST:
        return peer.per_found / ours.per_found
    print(f"IPOPT: found {peer.found}, fewer than {FEWEST}, so that a ratio of times says nothing")
    return math.nan


def over_true_pushes(build: Path, count: int) -> bool:
    """Compares times per push found, and returns whether the gates hold."""
    print(f"\n{'':24} pushes  we: found  CPU/found [ms] | IPOPT: the same | disagree")
    passed = True
    ours: dict[str, Pushes] = {}
    for preset in ("default", "paper"):
        we, ipopt, worst = Pushes(), Pushes(), 0.0
        for task in ("gathering", "sorting"):
            config = HERE.parents[1] / "config" / f"{task}.yaml"
            box2d = _core.Simulator(_core.Config.from_file(config))
            for dump in dumped(build, "pushes", str(config), str(count), preset):
                problem = PeerProblem(dump)
                worst = max(worst, disagreement(problem))
                x = problem.unknowns(dump["solution"])
                we.add(problem, x if dump["status"] == "converged" else x[:0], dump["cpu_s"], box2d)
                peer = solve(problem)
                ipopt.add(problem, peer.x if peer.converged else peer.x[:0], peer.cpu, box2d)
        ours[preset] = we
        print(
            f"{preset:24} {2 * count:6} {we.found:10} {1e3 * we.per_found:15.1f} |"
            f" {ipopt.found:5} {1e3 * ipopt.per_found:10.0f} | {worst:.1e}",
            flush=True,
        )
        passed &= gate(f"peer.pushes_disagreement.{preset}", worst, "<=", AGREEMENT)
        ratio = times_ours(ipopt, ours["default"])
        passed &= gate(f"peer.time_per_push_found.{preset}", ratio, ">=", 100.0)
    return passed


def main(build: Path, every: int, pushes: int) -> int:
    """Returns the exit status."""
    print("   no kind      disagree | we: status     iterations CPU [s] J | IPOPT: the same")
    return int(not all([over_the_corpus(build, every), over_true_pushes(build, pushes)]))


def arguments() -> argparse.Namespace:
    """Reads the command line; ends with exit status 2 if it is wrong."""
    parser = argparse.ArgumentParser("peer", description=__doc__.split(":")[0], allow_abbrev=False)
    parser.add_argument("build", metavar="BUILD_FOLDER", type=Path)
    parser.add_argument("every", metavar="EVERY", type=int, nargs="?", default=20)
    parser.add_argument("pushes", metavar="PUSHES", type=int, nargs="?", default=8)
    return parser.parse_args()


if __name__ == "__main__":
    given = arguments()
    sys.exit(main(given.build, given.every, given.pushes))
