"""Runs jobs as tasks on a Ray cluster."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import ray

from rtg.compare.executors.remote import RemoteJob, carry_out, is_free
from rtg.compare.jobs import Job
from rtg.errors import RunError, UserError

# Options of tasks that those of the user stand above. A task that loses its node begins again.
_OPTIONS = {"num_cpus": 1, "max_retries": 3}


class _RayJob(RemoteJob):
    def __init__(self, job: Job, result: ray.ObjectRef) -> None:
        super().__init__(job)
        self._result = result

    def _poll(self) -> int | None:
        if not ray.wait([self._result], timeout=0)[0]:
            return None
        try:
            return int(ray.get(self._result))
        except ray.exceptions.RayError as error:
            raise RunError(str(error)) from None

    def stop(self) -> None:
        if self.exit_status() is None:
            ray.cancel(self._result)

    def kill(self) -> None:
        if self.exit_status() is None:
            ray.cancel(self._result, force=True)


class RayExecutor:
    """Starts a task for each job."""

    def __init__(self, options: Mapping[str, Any]) -> None:
        try:
            self._task = ray.remote(**{**_OPTIONS, **options})(carry_out)
        except (TypeError, ValueError) as error:
            raise UserError(
                f"--executor ray: {error}; legal: --executor-option KEY=VALUE with an option of "
                "Ray's tasks, or address=HOST:PORT"
            ) from None

    def start(self, job: Job) -> RemoteJob | None:
        if not is_free(job):
            return None
        return _RayJob(job, self._task.remote(job))


@contextmanager
def connected(options: Mapping[str, Any]) -> Iterator[RayExecutor]:
    """Connects to a cluster that has been started, and gives its executor.

    `options`: those of Ray's tasks, and `address`, without which Ray finds the cluster of this
    machine or of RAY_ADDRESS. Raises UserError if they are illegal or there is no cluster.
    """
    task_options = dict(options)
    address = str(task_options.pop("address", "auto"))
    try:
        ray.init(address=address, log_to_driver=False, logging_level=logging.WARNING)
    except (ConnectionError, RuntimeError, ValueError) as error:
        raise UserError(
            f"--executor ray: {error}; legal: after `ray start --head` here, RAY_ADDRESS, or "
            "--executor-option address=HOST:PORT"
        ) from None
    try:
        yield RayExecutor(task_options)
    finally:
        ray.shutdown()
