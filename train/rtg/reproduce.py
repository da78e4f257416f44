"""Methods x seeds x tasks: runs what is not done yet, one process per core, and reports on all."""

from __future__ import annotations

import contextlib
import fcntl
import json
import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from rtg.cell_run import CellRun, make_ready
from rtg.cells import Grid, read_grid
from rtg.errors import RunError, StoppedError, UserError
from rtg.grid_display import GridDisplay, Row, counts, display
from rtg.interrupts import Interrupts
from rtg.processes import Node, kill_all, stop_all
from rtg.reproduce_args import ReproduceArgs

_POLL = 0.2  # [s]
_GRACE = 10.0  # [s]; a run gives its own processes less
_STAMP = re.compile(r"^\[ *[\d.]+ s\] ")


def reproduce(args: ReproduceArgs) -> int:
    """Exit status. Raises UserError before anything starts, RunError if it was stopped."""
    runs = make_ready(args)
    with _alone(args.out):
        grid = read_grid(args.out)
        grid.add(args.command, args.cells)
        grid.write(args.out)
        rows = _run_all(args, runs, grid)
    from rtg.report_files import write_report  # heavy

    report = write_report(args.out, args.out)
    print(f"{counts(rows)}\nreport: {report}")
    return 1 if any(row.phase == "failed" for row in rows) else 0


@contextlib.contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Makes the folder; no two processes work in it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock = (folder / ".lock").open("w")
    except OSError as error:
        raise UserError(f"--out: {folder}: {error.strerror}; legal: a folder to write to") from None
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise UserError(
                f"--out: {folder}: another reproduce works there; wait for it"
            ) from None
        yield


def _run_all(args: ReproduceArgs, runs: Sequence[CellRun], grid: Grid) -> list[Row]:
    """How each run ended."""
    crew = Crew(args, runs, grid)
    with display(sys.stdout) as shown, Interrupts(on_demand=crew.kill) as interrupts:
        try:
            while crew.tend(shown):
                crew.wait(_POLL)
                interrupts.raise_if_requested()
        except StoppedError:
            raise RunError(f"stopped; to go on: {args.typed}") from None
        finally:
            crew.stop()
    return crew.rows()


class Crew:
    """The runs of a comparison, so many of them at work at a time."""

    def __init__(self, args: ReproduceArgs, runs: Sequence[CellRun], grid: Grid) -> None:
        self._args, self._grid = args, grid
        self._runs = list(runs)
        self._nodes: dict[str, Node] = {}  # at work
        self._rows = {run.cell.name: _first_row(run) for run in runs}

    def tend(self, shown: GridDisplay) -> bool:
        """Takes note of what has ended, starts what there is a core for; whether any is at work."""
        for run in self._runs:
            node = self._nodes.get(run.cell.name)
            if node is not None:
                self._look_at(run, node)
        for run in self._runs:
            idle = len(self._nodes) < self._args.jobs
            if idle and self._rows[run.cell.name].phase == "waiting":
                self._start(run)
        shown.show(self.rows())
        return bool(self._nodes)

    def rows(self) -> list[Row]:
        """In the order of the runs."""
        return list(self._rows.values())

    def wait(self, seconds: float) -> None:
        """Until one of those at work has ended, perhaps, or so much time has passed."""
        next(iter(self._nodes.values())).wait(seconds)

    def stop(self) -> None:
        """Ends all runs, so that they can go on."""
        stop_all(self._nodes.values(), _GRACE)

    def kill(self) -> None:
        """Ends all runs at once."""
        kill_all(self._nodes.values())

    def _start(self, run: CellRun) -> None:
        name = run.cell.name
        if self._grid.failed.pop(name, None) is not None:
            self._grid.write(self._args.out)
        run.log.parent.mkdir(parents=True, exist_ok=True)
        self._nodes[name] = Node(name, run.command(), run.log)
        self._rows[name] = Row(name, "running")

    def _look_at(self, run: CellRun, node: Node) -> None:
        name = run.cell.name
        if node.exit_status() is None:
            self._rows[name] = Row(name, "running", _STAMP.sub("", node.last_words(lines=1)))
            return
        del self._nodes[name]
        if run.done:
            self._rows[name] = _first_row(run)
            return
        words = node.last_words() or node.epitaph()
        self._grid.failed[name] = words
        self._grid.write(self._args.out)
        self._rows[name] = Row(name, "failed", f"{node.epitaph()}; the end of its log:\n{words}")


def _first_row(run: CellRun) -> Row:
    """Of a run that is not at work."""
    if not run.done:
        return Row(run.cell.name)
    summary = json.loads((run.folder / "summary.json").read_text())
    rate, interactions = summary["success_rate"], summary["interactions"]
    return Row(run.cell.name, "done", f"success {rate:.2f} after {interactions:,} interactions")
