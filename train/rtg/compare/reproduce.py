"""Runs the unfinished runs of a comparison (methods x seeds x tasks) in parallel and reports."""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

from rtg.compare import grouped_seeds
from rtg.compare.cell_run import make_ready
from rtg.compare.cells import Grid, read_grid
from rtg.compare.grid_display import GridDisplay, Row, counts, display
from rtg.compare.reproduce_args import ReproduceArgs
from rtg.errors import RunError, StoppedError, UserError
from rtg.files import run_folder
from rtg.processes.children import Node, kill_all, stop_all
from rtg.processes.interrupts import Interrupts

_POLL = 0.2  # [s]
_GRACE = 10.0  # [s] from SIGTERM to SIGKILL; a run allows its own processes less
_STAMP = re.compile(r"^\[ *[\d.]+ s\] ")


def reproduce(args: ReproduceArgs) -> int:
    """Runs the comparison, writes its report and returns the exit status.

    Raises UserError before any job starts if the arguments are illegal or do not fit the folder,
    and while it writes the report if a file of a run is damaged. Raises RunError if the user
    stopped the comparison.
    """
    runs = make_ready(args)
    with run_folder.writing_to(args.out):
        args.out.mkdir(parents=True, exist_ok=True)
    with run_folder.alone(args.out, "another reproduce"):
        grid = read_grid(args.out)
        grid.add(args.command, args.cells)
        with run_folder.writing_to(args.out):
            grid.write(args.out)
        # A run repeats the work of a job that fails in these stages.
        for stage in grouped_seeds.stages(runs, args.together):
            _run_all(args, Crew(stage, args.jobs))
        rows = _run_all(args, Crew(runs, args.jobs, Failures(grid, args.out)))
        from rtg.compare.report_files import write_report  # imports matplotlib, which takes long

        report = write_report(args.out, args.out)
    print(f"{counts(rows)}\nreport: {report}")
    return 1 if any(row.phase == "failed" for row in rows) else 0


def _run_all(args: ReproduceArgs, crew: Crew) -> list[Row]:
    """Runs all jobs and returns a row on how each ended. Raises RunError if the user stopped it."""
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


class Job(Protocol):
    """Work that a crew does in one process; CellRun is an example."""

    @property
    def name(self) -> str: ...

    @property
    def log(self) -> Path:
        """The log file of the process."""

    @property
    def done(self) -> bool:
        """Returns whether there is nothing left to do."""

    @property
    def generates(self) -> str | None:
        """The kind of transitions that the job has yet to generate; None if there are none.

        Other jobs that need the same kind wait for this job.
        """

    def command(self) -> list[str]:
        """Returns the command that begins or resumes the job, after preparing its folder."""

    def outcome(self) -> str:
        """Returns the result of a finished job in words."""


class Failures:
    """Records in grid.json how jobs failed, with the end of their logs."""

    def __init__(self, grid: Grid, folder: Path) -> None:
        self._grid, self._folder = grid, folder

    def add(self, name: str, words: str) -> None:
        self._grid.failed[name] = words
        self._grid.write(self._folder)

    def drop(self, name: str) -> None:
        """Removes the failure of a job that is about to start again."""
        if self._grid.failed.pop(name, None) is not None:
            self._grid.write(self._folder)


class Crew:
    """Runs jobs, at most `places` of them at the same time."""

    def __init__(self, jobs: Sequence[Job], places: int, failures: Failures | None = None) -> None:
        self._jobs, self._places, self._failures = list(jobs), places, failures
        self._nodes: dict[str, Node] = {}  # the running jobs, by name
        self._rows = {job.name: _first_row(job) for job in jobs}

    def tend(self, shown: GridDisplay) -> bool:
        """Records the jobs that have ended, starts jobs while there is room and shows all rows.

        Returns whether any job is running.
        """
        for job in self._jobs:
            node = self._nodes.get(job.name)
            if node is not None:
                self._look_at(job, node)
        for job in self._jobs:
            idle = len(self._nodes) < self._places
            if idle and self._rows[job.name].phase == "waiting" and not self._is_made(job):
                self._start(job)
        shown.show(self.rows())
        return bool(self._nodes)

    def rows(self) -> list[Row]:
        """Returns a row per job, in the order of the jobs."""
        return list(self._rows.values())

    def wait(self, seconds: float) -> None:
        """Waits until the running job that started first has ended, or for at most `seconds`."""
        next(iter(self._nodes.values())).wait(seconds)

    def stop(self) -> None:
        """Stops all jobs so that they can be resumed; kills those still running after _GRACE."""
        stop_all(self._nodes.values(), _GRACE)

    def kill(self) -> None:
        """Kills all jobs at once."""
        kill_all(self._nodes.values())

    def _is_made(self, job: Job) -> bool:
        """Returns whether a running job generates the transitions that `job` would generate."""
        kinds = {other.generates for other in self._jobs if other.name in self._nodes}
        return job.generates is not None and job.generates in kinds

    def _start(self, job: Job) -> None:
        if self._failures:
            self._failures.drop(job.name)
        try:
            job.log.parent.mkdir(parents=True, exist_ok=True)
            self._nodes[job.name] = Node(job.name, job.command(), job.log)
            self._rows[job.name] = Row(job.name, "running")
        except (UserError, OSError) as error:
            self._fail(job, str(error))

    def _look_at(self, job: Job, node: Node) -> None:
        if node.exit_status() is None:
            words = _STAMP.sub("", node.last_words(lines=1))
            self._rows[job.name] = Row(job.name, "running", words)
            return
        del self._nodes[job.name]
        if job.done:
            self._rows[job.name] = _first_row(job)
            return
        words = node.last_words()
        self._fail(
            job, f"{node.epitaph()}; the end of its log:\n{words}" if words else node.epitaph()
        )

    def _fail(self, job: Job, words: str) -> None:
        if self._failures:
            self._failures.add(job.name, words)
        self._rows[job.name] = Row(job.name, "failed", words)


def _first_row(job: Job) -> Row:
    """Returns the row of a job that is not running: done or waiting."""
    return Row(job.name, "done", job.outcome()) if job.done else Row(job.name)
