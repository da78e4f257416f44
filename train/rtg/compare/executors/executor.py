"""The interface of executors, which start the jobs of a comparison."""

from __future__ import annotations

import os
from typing import Protocol

from rtg.compare.jobs import Job
from rtg.processes.children import Stoppable

TAKEN = os.EX_TEMPFAIL  # exit status of a job that another process works on


class Handle(Stoppable, Protocol):
    """A job that an executor has started."""

    def exit_status(self) -> int | None:
        """Returns the exit status of the job; None until it has ended.

        TAKEN: another process works on the job, or generates the transitions that it needs.
        """

    def exit_text(self) -> str:
        """Describes how the job ended."""

    def log_tail(self, lines: int = 8) -> str:
        """Returns the last `lines` lines that the job has written to its log."""

    def close(self) -> None:
        """Lets other processes have the job; called once its outcome is recorded."""


class Executor(Protocol):
    """Starts jobs."""

    def start(self, job: Job) -> Handle | None:
        """Starts a job. Returns None if another process works on it or has done it by now.

        Raises UserError, RunError or OSError if the job cannot start.
        """
