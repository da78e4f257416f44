"""The part that executors on other machines share: the work there, and the view of it from here.

All machines see the comparison folder and the program under the same paths.
"""

from __future__ import annotations

import contextlib
import signal
import time
from abc import ABC, abstractmethod

from rtg.compare.executors.executor import TAKEN
from rtg.compare.jobs import Job, is_claimed, try_claim
from rtg.errors import RunError, StoppedError, UserError
from rtg.processes.child_run import run_child
from rtg.processes.program_log import ProgramLog

_POLL = 0.2  # [s]


def is_free(job: Job) -> bool:
    """Returns whether there is something to submit that no other process works on now."""
    return not job.done and not is_claimed(job)


def carry_out(job: Job) -> int:
    """Begins or resumes a job in a child process, on this machine, and returns its exit status.

    It is 0 if the job is done already, and TAKEN if another process works on it. Main thread only.
    """
    job.log.parent.mkdir(parents=True, exist_ok=True)
    claim = try_claim(job)
    if claim is None:
        return TAKEN
    with contextlib.closing(claim):
        if job.done:
            return 0
        try:
            command = job.command()
        except UserError as error:
            with job.log.open("a") as log:
                print(f"rtg: {error}", file=log)
            return 2

        def step(node: object) -> None:
            claim.share_transitions()
            time.sleep(_POLL)

        try:
            node = run_child(job.name, command, job.log, step, descriptors=claim.descriptors)
        except StoppedError:
            return 128 + signal.SIGTERM
        status = node.exit_status()
        assert status is not None
        return status


class RemoteJob(ABC):
    """A job that waits for a machine, or runs there by carry_out()."""

    def __init__(self, job: Job) -> None:
        self._name, self._log = job.name, ProgramLog(job.log)
        self._status: int | None = None
        self._loss = ""  # why there is no exit status of the job itself

    @abstractmethod
    def _poll(self) -> int | None:
        """Returns what carry_out() has returned; None until then.

        Raises RunError if the cluster has lost the job.
        """

    @abstractmethod
    def stop(self) -> None:
        """Asks the cluster to stop the job."""

    @abstractmethod
    def kill(self) -> None:
        """Asks the cluster to end the job at once."""

    def exit_status(self) -> int | None:
        if self._status is None:
            try:
                self._status = self._poll()
            except RunError as error:
                self._status, self._loss = 1, str(error)
        return self._status

    def exit_text(self) -> str:
        if self._loss:
            return f"{self._name} was lost: {self._loss}"
        return f"{self._name} ended with exit status {self._status}"

    def wait(self, seconds: float) -> bool:
        deadline = time.monotonic() + seconds
        while self.exit_status() is None and time.monotonic() < deadline:
            time.sleep(min(_POLL, seconds))
        return self.exit_status() is not None

    def log_tail(self, lines: int = 8) -> str:
        return self._log.tail(lines)

    def close(self) -> None:  # noqa: B027 (there is nothing to release here)
        """The process on the other machine holds the locks, and has released them by now."""
