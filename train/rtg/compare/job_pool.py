"""Does the jobs of a comparison side by side, together with other commands on the same folder."""

from __future__ import annotations

import re
import time
from collections.abc import Sequence
from pathlib import Path

from rtg.compare.cells import read_grid, update_grid
from rtg.compare.executors.executor import TAKEN, Executor, Handle
from rtg.compare.grid_display import GridDisplay, Row
from rtg.compare.jobs import Job, is_claimed
from rtg.errors import RunError, UserError
from rtg.processes.children import kill_all, stop_all

_GRACE = 10.0  # [s] from the request to stop to the kill; a run allows its own processes less
_LOOK_EVERY = 1.0  # [s] between looks at the jobs that other processes work on
_TIMESTAMP = re.compile(r"^\[ *[\d.]+ s\] ")


class Failures:
    """Records in grid.json how jobs failed, with the end of their logs."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def add(self, name: str, words: str) -> None:
        update_grid(self._folder, lambda grid: grid.failure_by_name.update({name: words}))

    def remove(self, name: str) -> None:
        """Removes the failure of a job that is about to start again."""
        if self.words(name):
            update_grid(self._folder, lambda grid: grid.failure_by_name.pop(name, None))

    def words(self, name: str) -> str:
        """Returns how the job failed; "" if it did not."""
        return read_grid(self._folder).failure_by_name.get(name, "")


class JobPool:
    """Does `jobs` by `executor`, at most `max_parallel` of them at the same time.

    It waits for jobs that other processes work on, and takes them over if those are stopped.
    """

    def __init__(
        self,
        jobs: Sequence[Job],
        executor: Executor,
        max_parallel: int,
        failures: Failures | None = None,
    ) -> None:
        self._jobs, self._executor, self._failures = list(jobs), executor, failures
        self._max_parallel = max_parallel
        self._handles: dict[str, Handle] = {}  # the running jobs, by name
        self._rows = {job.name: _first_row(job) for job in jobs}
        self._old_words: dict[str, str] = {}  # failures known before jobs went elsewhere, by name
        self._looked_at = -_LOOK_EVERY

    def poll(self, shown: GridDisplay) -> bool:
        """Updates the states of all jobs, starts further jobs if possible and shows all states.

        Returns whether there is anything left to wait for.
        """
        for job in self._jobs:
            handle = self._handles.get(job.name)
            if handle is not None:
                self._update(job, handle)
        self._look_elsewhere()
        for job in self._jobs:
            has_room = len(self._handles) < self._max_parallel
            if has_room and self._phase(job) == "waiting" and not self._is_being_generated(job):
                self._start(job)
        shown.show(self.rows())
        return any(row.phase not in ("done", "failed") for row in self.rows())

    def rows(self) -> list[Row]:
        """Returns a row per job, in the order of the jobs."""
        return list(self._rows.values())

    def wait(self, seconds: float) -> None:
        """Waits at most `seconds` for the end of the running job that started first."""
        if self._handles:
            next(iter(self._handles.values())).wait(seconds)
        else:
            time.sleep(seconds)  # other processes work on all that is left

    def stop(self) -> None:
        """Stops all jobs so that they can be resumed; kills those still running after _GRACE."""
        stop_all(self._handles.values(), _GRACE)
        for handle in self._handles.values():
            handle.close()

    def kill(self) -> None:
        """Kills all jobs at once."""
        kill_all(self._handles.values())

    def _phase(self, job: Job) -> str:
        return self._rows[job.name].phase

    def _is_being_generated(self, job: Job) -> bool:
        """Returns whether a running job generates the transitions that `job` would generate."""
        keys = {other.pending_generation_key for other in self._jobs if other.name in self._handles}
        return job.pending_generation_key is not None and job.pending_generation_key in keys

    def _look_elsewhere(self) -> None:
        """Looks from time to time how far other processes have come with their jobs."""
        if time.monotonic() - self._looked_at < _LOOK_EVERY:
            return
        self._looked_at = time.monotonic()
        for job in self._jobs:
            if self._phase(job) == "elsewhere" and not is_claimed(job):
                words = self._failures.words(job.name) if self._failures else ""
                if words == self._old_words.get(job.name):
                    words = ""  # not of the process that has had the job meanwhile
                # Without a result and a failure, the other process was stopped.
                self._rows[job.name] = (
                    Row(job.name, "failed", words) if words and not job.done else _first_row(job)
                )

    def _go_elsewhere(self, job: Job) -> None:
        if self._failures:
            self._old_words.setdefault(job.name, self._failures.words(job.name))
        self._rows[job.name] = Row(job.name, "elsewhere")

    def _start(self, job: Job) -> None:
        try:
            handle = self._executor.start(job)
        except (UserError, RunError, OSError) as error:
            self._fail(job, str(error))
            return
        if handle is None:
            self._go_elsewhere(job)
            return
        if self._failures:
            self._failures.remove(job.name)
        self._handles[job.name] = handle
        self._rows[job.name] = Row(job.name, "running")

    def _update(self, job: Job, handle: Handle) -> None:
        status = handle.exit_status()
        if status is None:
            words = _TIMESTAMP.sub("", handle.log_tail(lines=1))
            self._rows[job.name] = Row(job.name, "running", words)
            return
        del self._handles[job.name]
        if job.done:
            self._rows[job.name] = _first_row(job)
        elif status == TAKEN:
            self._go_elsewhere(job)
        else:
            words = handle.log_tail()
            end = f"; the end of its log:\n{words}" if words else ""
            self._fail(job, handle.exit_text() + end)
        handle.close()

    def _fail(self, job: Job, words: str) -> None:
        if self._failures:
            self._failures.add(job.name, words)
        self._rows[job.name] = Row(job.name, "failed", words)


def _first_row(job: Job) -> Row:
    """Returns the row of a job that is not running: done or waiting."""
    return Row(job.name, "done", job.outcome()) if job.done else Row(job.name)
