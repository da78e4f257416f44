"""Runs jobs on a Slurm cluster, by submitit."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import submitit

from rtg.compare.executors.remote import RemoteJob, carry_out, is_free
from rtg.compare.jobs import Job
from rtg.errors import RunError, UserError

# Parameters of submitit.AutoExecutor that options of the user stand above.
_PARAMETERS = {"name": "rtg", "cpus_per_task": 1, "timeout_min": 24 * 60}
_ASK_EVERY = 2.0  # [s] between questions to Slurm about cancelled jobs


class _Work(submitit.helpers.Checkpointable):  # type: ignore[misc, unused-ignore]
    """carry_out(), begun again where its machine is taken away or its time is over."""

    def __call__(self, job: Job) -> int:
        return carry_out(job)


class _Pace:
    """Limits how often Slurm is asked; it answers for all jobs at once."""

    def __init__(self) -> None:
        self._asked_at = -_ASK_EVERY

    def is_due(self) -> bool:
        """Returns whether to ask now; if so, the next time is _ASK_EVERY later."""
        now = time.monotonic()
        if now - self._asked_at < _ASK_EVERY:
            return False
        self._asked_at = now
        return True


class _SlurmJob(RemoteJob):
    """A job in Slurm's queue. Slurm sees to its end: it kills what does not stop in time."""

    def __init__(self, job: Job, submitted: submitit.Job[int], pace: _Pace) -> None:
        super().__init__(job)
        self._submitted, self._pace = submitted, pace
        self._is_cancelled = False

    def _poll(self) -> int | None:
        # By itself submitit asks about jobs that have run for hours only every ten minutes.
        if not self._submitted.done(force_check=self._is_cancelled and self._pace.is_due()):
            return None
        if self._is_cancelled and not self._submitted.paths.result_pickle.exists():
            raise RunError("it was cancelled")  # submitit would wait for the result
        error = self._submitted.exception()
        if error is not None:
            raise RunError(str(error))
        return int(self._submitted.result())

    def stop(self) -> None:
        """Cancels the job, once: a second request would disturb its end."""
        if not self._is_cancelled and self.exit_status() is None:
            self._submitted.cancel(check=False)
            self._is_cancelled = True

    def kill(self) -> None:
        self.stop()


class SlurmExecutor:
    """Submits each job to Slurm; the files of submitit lie in `folder`.

    `options`: parameters of submitit.AutoExecutor, and `cluster`: slurm, or local for processes of
    this machine. Raises UserError if they are illegal or there is no Slurm.
    """

    def __init__(self, options: Mapping[str, Any], folder: Path) -> None:
        self._pace = _Pace()
        parameters = {**_PARAMETERS, **options}
        cluster = str(parameters.pop("cluster", "slurm"))
        try:
            self._executor = submitit.AutoExecutor(folder, cluster=cluster)
            self._executor.update_parameters(**parameters)
        except (AssertionError, NameError, RuntimeError, TypeError, ValueError) as error:
            raise UserError(
                f"--executor submitit: {error}; legal: a machine with Slurm, --executor-option "
                "KEY=VALUE with a parameter of submitit.AutoExecutor, or cluster=local"
            ) from None

    def start(self, job: Job) -> RemoteJob | None:
        if not is_free(job):
            return None
        try:
            return _SlurmJob(job, self._executor.submit(_Work(), job), self._pace)
        except submitit.core.utils.FailedJobError as error:
            raise RunError(f"{job.name} was not submitted: {error}") from None
