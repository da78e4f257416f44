"""What the programs of a run stand: ./test.sh chaos [--smoke]

Each scenario generates the same transitions while something goes wrong, in a network of its own,
and compares them with those of an undisturbed run. Prints a line per figure and gate. --smoke makes
one short round of each and leaves out the gates on time. Exit status 1 if a gate failed.
"""

from __future__ import annotations

import argparse
import random
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import network
from gates import gate
from graph import Graph, generated_in_process, lost
from rtg import paths

HERE = Path(__file__).resolve().parent
LONG = ("search.transitions=12000", "run.seed=3")
WORKERS = 2


class Run:
    """The programs of one generation, each started again when it is killed."""

    def __init__(self, net: network.Network, folder: Path) -> None:
        self.graph = Graph(net, folder, *LONG)
        self._start: dict[str, Callable[[], subprocess.Popen[str]]] = {
            "server": self.graph.server,
            **{f"worker {k}": lambda k=k: self.graph.worker(k) for k in range(WORKERS)},
            "coordinator": self.graph.coordinator,
        }
        self.begun = time.monotonic()
        self.consumer = self.graph.consumer()
        self.programs = {name: start() for name, start in self._start.items()}

    def is_generating(self) -> bool:
        return self.graph.is_generating()

    def kill(self, name: str) -> None:
        """Kills a program and starts it again."""
        self.programs[name].kill()
        self.programs[name].wait()
        self.programs[name] = self._start[name]()

    def pause(self, name: str, seconds: float) -> None:
        self.programs[name].send_signal(signal.SIGSTOP)
        time.sleep(seconds)
        self.programs[name].send_signal(signal.SIGCONT)

    def end(self) -> tuple[float, int, bytes]:
        """Waits for the end. Returns its time [s], how many rows were lost, and all rows."""
        rows_lost = lost(self.consumer)
        taken = time.monotonic() - self.begun
        status = self.programs["coordinator"].wait(60)
        if status != 0:
            raise SystemExit(f"the coordinator ended with status {status}: units were given up")
        return taken, rows_lost, self.graph.transitions()


def undisturbed(folder: Path) -> bytes:
    return generated_in_process(folder / "direct.npz", *LONG)


def disturbed(
    disturb: Callable[[Run], None], before: Callable[[network.Network], None] = lambda net: None
) -> tuple[float, int, bytes]:
    with network.Network() as net, tempfile.TemporaryDirectory() as folder:
        before(net)
        run = Run(net, Path(folder))
        disturb(run)
        return run.end()


def nothing(run: Run) -> None:
    """Lets a run go its way."""


class Report:
    """Prints figures and remembers whether a gate failed."""

    def __init__(self, right: bytes, smoke: bool) -> None:
        self._right, self._smoke = right, smoke
        self.holds = True

    def same(self, name: str, ends: list[tuple[float, int, bytes]]) -> None:
        """Demands that all runs have lost no row and have the right ones."""
        wrong = sum(rows_lost != 0 or rows != self._right for _, rows_lost, rows in ends)
        self.holds &= gate(f"chaos.{name}.wrong", wrong, "<=", 0)

    def ratio(self, name: str, value: float, bar: float) -> None:
        if self._smoke:
            print(f"chaos.{name}: {value:.3f}")
        else:
            self.holds &= gate(f"chaos.{name}", value, "<=", bar)


def median_time(ends: list[tuple[float, int, bytes]]) -> float:
    return statistics.median(end[0] for end in ends)


def losses(report: Report, rounds: int) -> None:
    """Datagrams that get lost."""
    base = [disturbed(nothing) for _ in range(rounds)]
    for percent, bar in ((1, 1.1), (5, 1.5), (20, 4.0)):
        ends = [disturbed(nothing, lambda net, p=percent: net.lose(p)) for _ in range(rounds)]
        report.same(f"loss_{percent}", ends)
        report.ratio(f"loss_{percent}.time", median_time(ends) / median_time(base), bar)


def kills(report: Report, most: int) -> None:
    """Kills of workers and server, about one in a second."""
    victims = ["server", *(f"worker {k}" for k in range(WORKERS))]
    done, ends, rng = 0, [], random.Random(1)

    def strike(run: Run) -> None:
        nonlocal done
        while done < most and run.is_generating():
            time.sleep(rng.uniform(0.5, 1.5))
            if run.is_generating():
                run.kill(rng.choice(victims))
                done += 1

    while done < most:
        ends.append(disturbed(strike))
    print(f"chaos.kills: {done} in {len(ends)} runs")
    report.same("kills", ends)


def pauses(report: Report, lengths: tuple[float, ...]) -> None:
    """Programs that freeze for a while."""
    for seconds in lengths:
        ends = []
        for name in ("server", "worker 0", "coordinator"):

            def freeze(run: Run, name: str = name, seconds: float = seconds) -> None:
                time.sleep(0.7)
                run.pause(name, seconds)

            ends.append(disturbed(freeze))
        report.same(f"pauses_of_{seconds:g}_s", ends)


def strangers(report: Report, seconds: float) -> None:
    """Forged messages and malformed datagrams, five thousand in a second."""
    sent = 0

    def attack(run: Run) -> None:
        nonlocal sent
        words = [sys.executable, HERE / "stranger.py", run.graph.config, "system-test"]
        stranger = run.graph.network.start(
            [*words, "5000", str(seconds)], PYTHONPATH=str(paths.ROOT / "train")
        )
        sent += int(stranger.communicate()[0])

    ends = [disturbed(attack)]
    print(f"chaos.strangers: {sent} messages")
    report.same("strangers", ends)


def two_at_once(report: Report) -> None:
    """Two runs on one network."""
    with network.Network() as net, tempfile.TemporaryDirectory() as folder:
        folders = [Path(folder) / name for name in ("one", "other")]
        for one in folders:
            one.mkdir()
        runs = [Run(net, one) for one in folders]
        report.same("two_runs", [run.end() for run in runs])


def main() -> int:
    parser = argparse.ArgumentParser("chaos.py", description=__doc__.split("\n")[0])
    parser.add_argument("--smoke", action="store_true", help="briefly, no gates on time")
    smoke = parser.parse_args().smoke
    if why := network.defect():
        print(f"chaos.py: no network namespaces here: {why}", file=sys.stderr)
        return 77
    with tempfile.TemporaryDirectory() as folder:
        report = Report(undisturbed(Path(folder)), smoke)
    losses(report, 1 if smoke else 5)
    kills(report, 2 if smoke else 100)
    pauses(report, (2.6,) if smoke else (2.6, 40.0))
    strangers(report, 1.0 if smoke else 20.0)
    two_at_once(report)
    return 0 if report.holds else 1


if __name__ == "__main__":
    sys.exit(main())
