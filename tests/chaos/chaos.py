"""What the programs of a run stand: ./test.sh chaos [--smoke] [SCENARIO...]

Each scenario makes the same transitions while something goes wrong, in a network of its own, and
compares them with those of an undisturbed run. Prints a line per figure and gate. --smoke makes
one short round of each and leaves out the gates on time, load and growth. Exit status 1 if a gate
failed.
"""

from __future__ import annotations

import argparse
import os
import random
import statistics
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import command
import generation
import network
from command import COMMAND, TRAINER, Command
from gates import gate
from generation import Generation, disturbed
from graph import RUN, Graph, Process
from processes import cpu_seconds, resident
from rtg import paths
from rtg.files import run_folder

HERE = Path(__file__).resolve().parent
RATE = 5000  # messages of strangers [1/s]
FORGED, MALFORMED = 10**5, 10**6  # that they send beside training, in the long form


class Report:
    """Prints figures and remembers whether a gate failed."""

    def __init__(self, smoke: bool) -> None:
        self._smoke = smoke
        self.holds = True

    def least(self, name: str, value: float, bar: float) -> None:
        """Demands in the long form that a measured value is at least `bar`."""
        if self._smoke:
            print(f"chaos.{name}: {value:.3g}")
        else:
            self.holds &= gate(f"chaos.{name}", value, ">=", bar)

    def zero(self, name: str, count: int) -> None:
        """Demands that nothing of a kind has happened."""
        self.holds &= gate(f"chaos.{name}", count, "<=", 0)

    def same(self, name: str, ends: Iterable[generation.End], right: bytes) -> None:
        """Demands that all generations have the right transitions."""
        self.zero(f"{name}.wrong", sum(end.rows != right for end in ends))

    def most(self, name: str, value: float, bar: float) -> None:
        """Demands in the long form that a measured value is at most `bar`."""
        if self._smoke:
            print(f"chaos.{name}: {value:.3g}")
        else:
            self.holds &= gate(f"chaos.{name}", value, "<=", bar)


class Chaos:
    """The scenarios, short ones with `smoke`."""

    def __init__(self, smoke: bool) -> None:
        self._smoke = smoke
        self.report = Report(smoke)
        with tempfile.TemporaryDirectory() as folder:
            self._rows = generation.undisturbed(Path(folder))
            self._rows_of_command = command.undisturbed(Path(folder))

    def losses(self) -> None:
        """Datagrams that get lost; of the last kind 5 % come twice as well."""
        bars = {1: 1.1, 5: 1.5, 20: 4.0}  # of the time, by the percentage that is lost
        ends: dict[int, list[generation.End]] = {percent: [] for percent in (0, *bars)}
        for _ in range(1 if self._smoke else 9):
            for percent in ends:

                def lose(net: network.Network, percent: int = percent) -> None:
                    if percent:
                        net.lose(percent)
                    if percent == 20:
                        net.double(5)

                ends[percent].append(disturbed(before=lose))
        for percent, of_percent in ends.items():
            self.report.same(f"loss_{percent}", of_percent, self._rows)
        for percent, bar in bars.items():
            self.report.most(f"loss_{percent}.time", _median(ends[percent]) / _median(ends[0]), bar)

    def kills(self) -> None:
        """Kills of workers and server, about one in a second."""
        others = [name for name in generation.PROGRAMS if name != generation.COORDINATOR]
        self._kill("kills", others, 2 if self._smoke else 100)

    def coordinators(self) -> None:
        """Kills of the coordinator, which goes on from its journal."""
        self._kill("coordinators", [generation.COORDINATOR], 2 if self._smoke else 10)

    def _kill(self, name: str, victims: Sequence[str], most: int) -> None:
        done, ends, rng = 0, [], random.Random(1)

        def strike(run: Generation) -> None:
            nonlocal done
            while done < most and run.is_running():
                time.sleep(rng.uniform(0.5, 1.5))
                if run.is_running():
                    run.kill(rng.choice(victims))
                    done += 1

        while done < most:
            ends.append(disturbed(strike))
        print(f"chaos.{name}: {done} in {len(ends)} runs")
        self.report.same(name, ends, self._rows)

    def pauses(self) -> None:
        """Programs that freeze for a while: all of them in each run, at random times."""
        rounds, rng = 1 if self._smoke else 10, random.Random(1)
        names = [*generation.PROGRAMS, generation.CONSUMER]
        for seconds in (2.6,) if self._smoke else (2.6, 40.0):
            strikes: Counter[str] = Counter()

            def freeze(
                run: Generation, seconds: float = seconds, strikes: Counter[str] = strikes
            ) -> None:
                def later(name: str, delay: float) -> None:
                    time.sleep(delay)
                    strikes[name] += run.pause(name, seconds)

                # A generation takes about 4 s: later pauses would meet programs that have ended.
                threads = [
                    threading.Thread(target=later, args=(name, rng.uniform(0.3, 3.0)))
                    for name in names
                ]
                for thread in threads:
                    thread.start()
                for thread in threads:
                    thread.join()

            ends = [disturbed(freeze) for _ in range(rounds)]
            self.report.same(f"pauses_of_{seconds:g}_s", ends, self._rows)
            words = ", ".join(f"{name} {strikes[name]}" for name in names)
            print(f"chaos.pauses_of_{seconds:g}_s: {words} times")
            missed = sum(strikes[name] == 0 for name in names)
            self.report.zero(f"pauses_of_{seconds:g}_s.programs_missed", missed)

    def commands(self) -> None:
        """Kills of the trainer, and of the command with all its programs; --resume goes on."""
        most, done, wrong, rng = 2 if self._smoke else 10, 0, 0, random.Random(1)
        while done < most:
            with network.Network() as net, tempfile.TemporaryDirectory() as folder:
                run = Command(net, Path(folder) / "run")
                run.start()
                for _ in range(3):
                    time.sleep(rng.uniform(1.0, 6.0))
                    if (
                        done < most
                        and run.is_running()
                        and run.kill(rng.choice([TRAINER, COMMAND]))
                    ):
                        done += 1
                        run.start()
                run.end()
                wrong += run.transitions() != self._rows_of_command
        print(f"chaos.commands: {done} kills")
        self.report.zero("commands.wrong", wrong)

    def strangers(self) -> None:
        """Forged messages and malformed datagrams: what they cost who waits, and who works."""
        seconds = 1.0 if self._smoke else 20.0
        self._burden(seconds, lambda graph: {"server": graph.server(), "worker": graph.worker(0)})
        self._burden(
            seconds,
            lambda graph: {"coordinator": graph.coordinator(), "consumer": graph.consumer()},
        )
        forged, malformed, wrong, unheard = 0, 0, 0, 0
        end = time.monotonic() + (1.0 if self._smoke else 900.0)
        while time.monotonic() < end and (forged < FORGED or malformed < MALFORMED):
            with network.Network() as net, tempfile.TemporaryDirectory() as folder:
                run = Command(net, Path(folder) / "run")
                run.start()
                while not (run.folder / run_folder.KEY_FILE).exists():
                    time.sleep(0.01)
                name = run_folder.run_name(run.folder)
                with _strangers(net, name) as counts:
                    run.end()
                forged, malformed = forged + counts[0], malformed + counts[1]
                heard = run_folder.result(run.folder)["counters"]
                unheard += not (heard.get("bus.forged") and heard.get("bus.malformed"))
                wrong += run.transitions() != self._rows_of_command
        self.report.least("strangers.forged", forged, FORGED)
        self.report.least("strangers.malformed", malformed, MALFORMED)
        self.report.zero("strangers.unheard", unheard)
        self.report.zero("strangers.wrong", wrong)

    def _burden(self, seconds: float, start: Callable[[Graph], dict[str, Process]]) -> None:
        """Measures the load that strangers put on programs that wait, and what they keep of it."""
        with network.Network() as net, tempfile.TemporaryDirectory() as folder:
            graph = Graph(net, Path(folder))
            programs = start(graph)
            time.sleep(3.0)
            before = {name: resident(program.pid) for name, program in programs.items()}
            idle = _cpu_of(programs, seconds)
            with _strangers(net, RUN) as counts:
                time.sleep(0.5)
                busy = _cpu_of(programs, seconds)
            name = "_and_".join(programs)
            self.report.least(f"strangers.rate_at_{name}", sum(counts) / seconds, 0.9 * RATE)
            for name, program in programs.items():
                if program.poll() is not None:
                    raise SystemExit(f"the {name} has ended")
                self.report.most(f"strangers.cpu_of_{name}", busy[name] - idle[name], 0.03)
                grown = resident(program.pid) - before[name]
                self.report.most(f"strangers.growth_of_{name}_mb", grown, 5.0)

    def neighbours(self) -> None:
        """Two runs on one network."""
        with network.Network() as net, tempfile.TemporaryDirectory() as folder:
            folders = [Path(folder) / name for name in ("one", "other")]
            for one in folders:
                one.mkdir()
            runs = [Generation(net, one) for one in folders]
            self.report.same("neighbours", [run.end() for run in runs], self._rows)

    def disks(self) -> None:
        """Disks that are full before the run has ended; once there is room, --resume goes on."""
        wrong = 0
        for kilobytes in (300,) if self._smoke else (50, 100, 300, 800, 1500, 2500, 3000, 4000):
            for mode in ([],) if self._smoke else ([], ["--in-process"]):
                wrong += not _survives_a_full_disk(kilobytes, mode, self._rows_of_command)
        self.report.zero("disks.wrong", wrong)

    def soak(self) -> None:
        """Small runs for twenty minutes: what they leave behind, in memory and elsewhere."""
        seconds = 1.0 if self._smoke else 1200.0
        strays: set[str] = set()
        runs, end = 0, time.monotonic() + seconds
        with network.Network() as net, tempfile.TemporaryDirectory() as own:
            words = [sys.executable, HERE / "soak.py", str(seconds)]
            one = net.start(words, PYTHONPATH=os.environ["PYTHONPATH"], TMPDIR=own)
            while time.monotonic() < end:
                with tempfile.TemporaryDirectory() as folder:
                    before = _files()
                    run = Command(net, Path(folder) / "run")
                    run.start()
                    run.end()  # fails where a process is left
                    strays |= _files() - before
                    runs += 1
            rounds, slope = one.communicate()[0].split()[-2:]
        print(f"chaos.soak: {runs} commands, {rounds} rounds in one process")
        for stray in sorted(strays):
            print(f"chaos.soak: stray file {stray}")
        self.report.zero("soak.stray_files", len(strays))
        self.report.most("soak.growth_mb_per_h", float(slope), 1.0)


SCENARIOS = (
    Chaos.losses,
    Chaos.kills,
    Chaos.coordinators,
    Chaos.pauses,
    Chaos.commands,
    Chaos.strangers,
    Chaos.neighbours,
    Chaos.disks,
    Chaos.soak,
)


def _median(ends: Iterable[generation.End]) -> float:
    return statistics.median(end.seconds for end in ends)


def _cpu_of(programs: dict[str, Process], seconds: float) -> dict[str, float]:
    """Returns the share of one core that each program uses in the next `seconds`."""
    before = {name: cpu_seconds(program.pid) for name, program in programs.items()}
    time.sleep(seconds)
    return {
        name: (cpu_seconds(program.pid) - before[name]) / seconds
        for name, program in programs.items()
    }


@contextmanager
def _strangers(net: network.Network, name: str) -> Iterator[list[int]]:
    """Lets strangers to run `name` send.

    The list has at the end how many messages were forged, and how many malformed.
    """
    words = [sys.executable, HERE / "stranger.py", command.TINY, name, str(RATE)]
    stranger = net.start(words, PYTHONPATH=str(paths.ROOT / "train"))
    assert stranger.stdout is not None and stranger.stdout.readline() == "sends\n"
    counts: list[int] = []
    try:
        yield counts
    finally:
        stranger.terminate()
        counts += map(int, stranger.communicate()[0].split())


def _survives_a_full_disk(kilobytes: int, mode: list[str], right: bytes) -> bool:
    """Returns whether a run on so small a disk ends with status 1 and words, and then goes on."""
    with network.Network() as net, tempfile.TemporaryDirectory() as folder:
        words = [folder, str(kilobytes), sys.executable, command.TINY, *mode]
        run = net.start(
            ["unshare", "--mount", HERE / "full_disk.sh", *words],
            PYTHONPATH=str(paths.ROOT / "train"),
        )
        said = run.communicate(timeout=command.PATIENCE)[0]
        rows = Path(folder) / "transitions.npz"
        if run.returncode == 0 and "No space left on device" in said and "Traceback" not in said:
            return rows.read_bytes() == right
        print(f"chaos.disks: {kilobytes} kB {mode}: status {run.returncode}: {said}")
        return False


def _files() -> set[str]:
    """Returns what there is in the folders where programs leave things."""
    folders = [tempfile.gettempdir(), "/dev/shm", str(Path.cwd()), str(Path.home())]
    return {str(path) for folder in folders for path in Path(folder).iterdir()}


def main() -> int:
    parser = argparse.ArgumentParser("chaos.py", description=__doc__.split("\n")[0])
    parser.add_argument("--smoke", action="store_true", help="briefly, no gates on time")
    names = [scenario.__name__ for scenario in SCENARIOS]
    parser.add_argument("scenarios", nargs="*", metavar="SCENARIO", help=", ".join(names))
    args = parser.parse_args()
    if unknown := set(args.scenarios) - set(names):
        parser.error(f"unknown: {', '.join(sorted(unknown))}; legal: {', '.join(names)}")
    if why := network.defect():
        print(f"chaos.py: no network namespaces here: {why}", file=sys.stderr)
        return 77
    with tempfile.TemporaryDirectory() as own:  # of which soak() sees what is left
        os.environ["TMPDIR"] = tempfile.tempdir = own
        os.environ["TORCHINDUCTOR_CACHE_DIR"] = own  # torch makes a folder for its compiler
        chaos = Chaos(args.smoke)
        for scenario in SCENARIOS:
            if not args.scenarios or scenario.__name__ in args.scenarios:
                scenario(chaos)
    return 0 if chaos.report.holds else 1


if __name__ == "__main__":
    sys.exit(main())
