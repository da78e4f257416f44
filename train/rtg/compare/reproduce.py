"""Performs the runs of a comparison (methods x seeds x tasks) in parallel and writes its report."""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

from rtg.compare import grouped_seeds
from rtg.compare.cell_run import prepare_runs
from rtg.compare.cells import Grid, read_grid
from rtg.compare.grid_display import GridDisplay, Row, counts, display
from rtg.compare.reproduce_args import ReproduceArgs
from rtg.errors import RunError, StoppedError, UserError
from rtg.files import run_folder
from rtg.processes.children import Node, kill_all, stop_all
from rtg.processes.interrupts import Interrupts

_POLL = 0.2  # [s]
_GRACE = 10.0  # [s] from SIGTERM to SIGKILL; a run allows its own processes less
_TIMESTAMP = re.compile(r"^\[ *[\d.]+ s\] ")


def reproduce(args: ReproduceArgs) -> int:
    """Runs the comparison, writes its report and returns the exit status.

    Raises UserError before the first run if the arguments are illegal or do not fit the folder.
    Raises UserError after the last run if a file of a run is damaged. Raises RunError if the user
    stopped the comparison.
    """
    runs = prepare_runs(args)
    with run_folder.write_errors_as_user_errors(args.out):
        args.out.mkdir(parents=True, exist_ok=True)
    with run_folder.exclusive_lock(args.out, "another reproduce"):
        grid = read_grid(args.out)
        grid.add(args.command, args.cells)
        with run_folder.write_errors_as_user_errors(args.out):
            grid.write(args.out)
        # If a job of these stages fails, the run itself does the work again.
        for stage in grouped_seeds.stages(runs, args.together):
            _run_all(args, JobPool(stage, args.jobs))
        rows = _run_all(args, JobPool(runs, args.jobs, Failures(grid, args.out)))
        from rtg.compare.report_files import write_report  # imports matplotlib, which takes long

        report = write_report(args.out, args.out)
    print(f"{counts(rows)}\nreport: {report}")
    return 1 if any(row.phase == "failed" for row in rows) else 0


def _run_all(args: ReproduceArgs, pool: JobPool) -> list[Row]:
    """Does all jobs and returns the final row of each. Raises RunError if the user stopped them."""
    with display(sys.stdout) as shown, Interrupts(on_second_signal=pool.kill) as interrupts:
        try:
            while pool.poll(shown):
                pool.wait(_POLL)
                interrupts.raise_if_requested()
        except StoppedError:
            raise RunError(f"stopped; to go on: {args.command_line}") from None
        finally:
            pool.stop()
    return pool.rows()


class Job(Protocol):
    """Work that a pool does in one process; CellRun is an example."""

    @property
    def name(self) -> str: ...

    @property
    def log(self) -> Path:
        """The log file of the process."""

    @property
    def done(self) -> bool:
        """Returns whether there is nothing left to do."""

    @property
    def pending_generation_key(self) -> str | None:
        """The key of the transitions that the job must still generate; None if none.

        Other jobs that need the same transitions wait for this job.
        """

    def command(self) -> list[str]:
        """Returns the command that begins or resumes the job; prepares its folder before."""

    def outcome(self) -> str:
        """Returns the result of a finished job in words."""


class Failures:
    """Records in grid.json how jobs failed, with the end of their logs."""

    def __init__(self, grid: Grid, folder: Path) -> None:
        self._grid, self._folder = grid, folder

    def add(self, name: str, words: str) -> None:
        self._grid.failure_by_name[name] = words
        self._grid.write(self._folder)

    def remove(self, name: str) -> None:
        """Removes the failure of a job that is about to start again."""
        if self._grid.failure_by_name.pop(name, None) is not None:
            self._grid.write(self._folder)


class JobPool:
    """Does `jobs`, at most `max_parallel` of them at the same time."""

    def __init__(
        self, jobs: Sequence[Job], max_parallel: int, failures: Failures | None = None
    ) -> None:
        self._jobs, self._max_parallel, self._failures = list(jobs), max_parallel, failures
        self._nodes: dict[str, Node] = {}  # the running jobs, by name
        self._rows = {job.name: _first_row(job) for job in jobs}

    def poll(self, shown: GridDisplay) -> bool:
        """Updates the states of all jobs, starts further jobs if possible and shows all states.

        Returns whether any job is running.
        """
        for job in self._jobs:
            node = self._nodes.get(job.name)
            if node is not None:
                self._update(job, node)
        for job in self._jobs:
            has_room = len(self._nodes) < self._max_parallel
            if (
                has_room
                and self._rows[job.name].phase == "waiting"
                and not self._is_being_generated(job)
            ):
                self._start(job)
        shown.show(self.rows())
        return bool(self._nodes)

    def rows(self) -> list[Row]:
        """Returns a row per job, in the order of the jobs."""
        return list(self._rows.values())

    def wait(self, seconds: float) -> None:
        """Waits at most `seconds` for the end of the running job that started first."""
        next(iter(self._nodes.values())).wait(seconds)

    def stop(self) -> None:
        """Stops all jobs so that they can be resumed; kills those still running after _GRACE."""
        stop_all(self._nodes.values(), _GRACE)

    def kill(self) -> None:
        """Kills all jobs at once."""
        kill_all(self._nodes.values())

    def _is_being_generated(self, job: Job) -> bool:
        """Returns whether a running job generates the transitions that `job` would generate."""
        keys = {other.pending_generation_key for other in self._jobs if other.name in self._nodes}
        return job.pending_generation_key is not None and job.pending_generation_key in keys

    def _start(self, job: Job) -> None:
        if self._failures:
            self._failures.remove(job.name)
        try:
            job.log.parent.mkdir(parents=True, exist_ok=True)
            self._nodes[job.name] = Node(job.name, job.command(), job.log)
            self._rows[job.name] = Row(job.name, "running")
        except (UserError, OSError) as error:
            self._fail(job, str(error))

    def _update(self, job: Job, node: Node) -> None:
        if node.exit_status() is None:
            words = _TIMESTAMP.sub("", node.log_tail(lines=1))
            self._rows[job.name] = Row(job.name, "running", words)
            return
        del self._nodes[job.name]
        if job.done:
            self._rows[job.name] = _first_row(job)
            return
        words = node.log_tail()
        self._fail(
            job, f"{node.exit_text()}; the end of its log:\n{words}" if words else node.exit_text()
        )

    def _fail(self, job: Job, words: str) -> None:
        if self._failures:
            self._failures.add(job.name, words)
        self._rows[job.name] = Row(job.name, "failed", words)


def _first_row(job: Job) -> Row:
    """Returns the row of a job that is not running: done or waiting."""
    return Row(job.name, "done", job.outcome()) if job.done else Row(job.name)
