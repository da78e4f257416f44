"""Runs jobs on a Slurm cluster, by submitit."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import submitit

from rtg.compare.executors.remote import RemoteJob, carry_out, is_free
from rtg.compare.jobs import Job
from rtg.errors import RunError, UserError

# Parameters of submitit.AutoExecutor that options of the user stand above.
_PARAMETERS = {"name": "rtg", "cpus_per_task": 1, "timeout_min": 24 * 60}


class _Work(submitit.helpers.Checkpointable):  # type: ignore[misc, unused-ignore]
    """carry_out(), begun again where its machine is taken away or its time is over."""

    def __call__(self, job: Job) -> int:
        return carry_out(job)


class _SlurmJob(RemoteJob):
    def __init__(self, job: Job, submitted: submitit.Job[int]) -> None:
        super().__init__(job)
        self._submitted = submitted

    def _poll(self) -> int | None:
        if not self._submitted.done():
            return None
        error = self._submitted.exception()
        if error is not None:
            raise RunError(str(error))
        return int(self._submitted.result())

    def stop(self) -> None:
        self.kill()

    def kill(self) -> None:
        """The cluster sees to the end: it kills what does not stop by itself in time."""
        if self.exit_status() is None:
            self._submitted.cancel(check=False)
            self._status = 1


class SlurmExecutor:
    """Submits each job to Slurm; the files of submitit lie in `folder`.

    `options`: parameters of submitit.AutoExecutor, and `cluster`: slurm, or local for processes of
    this machine. Raises UserError if they are illegal or there is no Slurm.
    """

    def __init__(self, options: Mapping[str, Any], folder: Path) -> None:
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
            return _SlurmJob(job, self._executor.submit(_Work(), job))
        except submitit.core.utils.FailedJobError as error:
            raise RunError(f"{job.name} was not submitted: {error}") from None
