"""Goals of the benchmarks (design 6), ratios within one run."""

from __future__ import annotations

import math
import operator
import statistics
from collections.abc import Callable, Mapping

# Time by benchmark, in whatever unit it reports (ratios take one unit): CPU time, or real time
# where several threads work. Of benchmarks in lanes it is the time per problem; PACK before the
# name gives the time of all lanes, which is what a problem takes that is alone in them.
Times = Mapping[str, float]
PACK = "all lanes of "
# Name, value, relation, goal.
Gate = tuple[str, Callable[[Times], float], str, float]


def ratio(slow: str, fast: str) -> Callable[[Times], float]:
    """Measures how many times as long the benchmark `slow` takes as `fast`."""
    return lambda times: times[slow] / times[fast]


def growth(family: str) -> Callable[[Times], float]:
    """Exponent of the time of FAMILY/N in N, by least squares."""

    def exponent(times: Times) -> float:
        own = {name: time for name, time in times.items() if name.startswith(f"{family}/")}
        sizes = [math.log(int(name.rsplit("/", 1)[1])) for name in own]
        return statistics.linear_regression(sizes, [math.log(t) for t in own.values()]).slope

    return exponent


def linearity(family: str) -> Callable[[Times], float]:
    """R² of a straight line through the times of FAMILY/N over N."""

    def squared_correlation(times: Times) -> float:
        own = {name: time for name, time in times.items() if name.startswith(f"{family}/")}
        sizes = [int(name.rsplit("/", 1)[1]) for name in own]
        correlation: float = statistics.correlation(sizes, list(own.values()))
        return correlation**2

    return squared_correlation


PEERS = ("cyclic_reduction", "klu", "hpipm")


def best_peer_by_ours(family: str, of: str = "") -> Callable[[Times], float]:
    """Compares the fastest peer's KKT solve with ours, of six bodies over 16 sub-steps."""
    return lambda times: (
        min(times[f"{family}/{peer}/16"] for peer in PEERS) / times[f"{of}{family}/lanes/16"]
    )


GATES: tuple[Gate, ...] = (
    ("kkt.throughput", best_peer_by_ours("kkt"), ">=", 15.0),
    ("kkt.latency", best_peer_by_ours("kkt", PACK), ">=", 5.0),
    ("kkt_inertia.throughput", best_peer_by_ours("kkt_inertia"), ">=", 15.0),
    ("kkt_inertia.latency", best_peer_by_ours("kkt_inertia", PACK), ">=", 5.0),
    ("sqp_iteration.growth_with_h", growth("sqp_iteration"), "<=", 1.1),
    ("beam.linear_in_breadth", linearity("beam/breadth"), ">=", 0.99),
    ("beam.linear_in_depth", linearity("beam/depth"), ">=", 0.99),
    ("beam.growth_with_breadth", growth("beam/breadth"), "<=", 1.1),
    ("beam.growth_with_depth", growth("beam/depth"), "<=", 1.1),
    ("beam.two_threads_by_one", ratio("beam/threads/1", "beam/threads/2"), ">=", 1.8),
    ("replay.two_threads_by_one", ratio("replay/threads/1", "replay/threads/2"), ">=", 1.8),
)
_HOLDS = {">=": operator.ge, "<=": operator.le}


def gate(name: str, value: float, relation: str, bound: float) -> bool:
    """Prints the line of a gate and returns whether it holds. `relation`: ">=" or "<="."""
    passed = bool(_HOLDS[relation](value, bound))
    print(f"gate {name} {value:.4g} {relation}{bound:g} {'PASS' if passed else 'FAIL'}")
    return passed


def check(times: Times) -> bool:
    """Prints a line per gate and returns whether all hold."""
    return all([gate(name, of(times), relation, bound) for name, of, relation, bound in GATES])
