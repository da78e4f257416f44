"""Chooses an executor by its name on the command line."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rtg import extras
from rtg.compare.executors.executor import Executor
from rtg.compare.executors.local import LocalExecutor

EXECUTORS = ("local", "submitit", "ray")


@contextmanager
def opened(name: str, options: Mapping[str, Any], folder: Path) -> Iterator[Executor]:
    """Gives the executor `name` of EXECUTORS for jobs of the comparison `folder`.

    Raises UserError if its package is not installed, or its `options` are illegal.
    """
    flag = f"--executor {name}"
    if name == "submitit":
        extras.require("submitit", "slurm", flag)
        from rtg.compare.executors.slurm import SlurmExecutor

        yield SlurmExecutor(options, folder / ".jobs")
    elif name == "ray":
        extras.require("ray", "ray", flag)
        from rtg.compare.executors.ray_tasks import connected

        with connected(options) as executor:
            yield executor
    else:
        yield LocalExecutor()
