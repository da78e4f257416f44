"""The programs of one generation, which something disturbs."""

from __future__ import annotations

import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from graph import Graph, finish, generated_in_process
from network import Network
from processes import freeze

SETTINGS = ("search.transitions=30000", "train.buffer=30000", "run.seed=3")  # about 4 s
WORKERS = ("worker 0", "worker 1")
COORDINATOR, CONSUMER = "coordinator", "consumer"
PROGRAMS = ("server", *WORKERS, COORDINATOR)  # those that may be killed: they keep no rows


class End(NamedTuple):
    """How a generation ended."""

    seconds: float
    rows: bytes  # its transitions.npz


class Generation:
    """The programs of one generation, each started again when it is killed."""

    def __init__(self, network: Network, folder: Path) -> None:
        self.graph = Graph(network, folder, *SETTINGS)
        self._start: dict[str, Callable[[], subprocess.Popen[str]]] = {
            "server": self.graph.server,
            **{name: lambda k=k: self.graph.worker(k) for k, name in enumerate(WORKERS)},
            COORDINATOR: self.graph.coordinator,
        }
        self._begun = time.monotonic()
        self._consumer = self.graph.consumer()
        self._programs = {name: start() for name, start in self._start.items()}

    def is_running(self) -> bool:
        return self.graph.is_generating()

    def kill(self, name: str) -> None:
        """Kills a program and starts it again."""
        self._programs[name].kill()
        self._programs[name].wait()
        self._programs[name] = self._start[name]()

    def pause(self, name: str, seconds: float) -> bool:
        """Freezes a program, or the consumer, for so long. Returns whether it was running."""
        return freeze({**self._programs, CONSUMER: self._consumer}[name], seconds)

    def end(self) -> End:
        """Waits for the end. Raises SystemExit if a program failed or units were given up."""
        finish(self._consumer)
        taken = time.monotonic() - self._begun
        status = self._programs[COORDINATOR].wait(60)
        if status != 0:
            raise SystemExit(f"the coordinator ended with status {status}: units were given up")
        return End(taken, self.graph.transitions())


def undisturbed(folder: Path) -> bytes:
    """Returns the transitions of the same generation without LCM."""
    return generated_in_process(folder / "direct.npz", *SETTINGS)


def disturbed(
    disturb: Callable[[Generation], None] = lambda run: None,
    before: Callable[[Network], None] = lambda network: None,
) -> End:
    """Returns the end of a generation in a network of its own."""
    with Network() as network, tempfile.TemporaryDirectory() as folder:
        before(network)
        run = Generation(network, Path(folder))
        disturb(run)
        return run.end()
