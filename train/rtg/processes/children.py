"""Child processes that never outlive their parent."""

from __future__ import annotations

import contextlib
import ctypes
import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

_PR_SET_PDEATHSIG = 1
_libc = ctypes.CDLL(None)


def _die_with(parent: int) -> Callable[[], None]:
    """For the child: the kernel kills it when the thread that started it ends."""

    def die_with_parent() -> None:
        _libc.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:  # gone before the kernel was told
            os._exit(1)

    return die_with_parent


class Node:
    """A program of the process graph in a process group of its own, its output in a log file."""

    def __init__(self, name: str, command: Sequence[str | Path], log: Path) -> None:
        """Starts at once. Main thread only: the child dies with the thread that starts it."""
        self.name = name
        self.command = [str(part) for part in command]
        self.log = log
        self.start()

    def start(self) -> None:
        """Starts the program, again if it ran before."""
        self.started = time.monotonic()
        self._gone = False
        with self.log.open("ab") as output:
            self._said_before = output.tell()
            self._process = subprocess.Popen(
                self.command,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                preexec_fn=_die_with(os.getpid()),
            )

    @property
    def pid(self) -> int:
        """Also the id of the process group."""
        return self._process.pid

    def exit_status(self) -> int | None:
        """None while it runs. What it started ends with it."""
        status = self._process.poll()
        if status is not None and not self._gone:
            self.signal_group(signal.SIGKILL)
            self._gone = True  # from now on the id may be another's
        return status

    def signal_group(self, number: int) -> None:
        """To the program and everything it started."""
        if not self._gone:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.pid, number)

    def wait(self, seconds: float) -> bool:
        """Says whether it has ended within that time."""
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            return False
        return self.exit_status() is not None

    def last_words(self, lines: int = 8) -> str:
        """The end of what it wrote to its log since it was last started."""
        said = self.log.read_bytes()[self._said_before :] if self.log.exists() else b""
        return "\n".join(said.decode(errors="replace").splitlines()[-lines:])

    def epitaph(self) -> str:
        """How it ended, for people."""
        status = self.exit_status()
        if status is not None and status < 0:
            return f"{self.name} was killed by {signal.Signals(-status).name}"
        return f"{self.name} ended with exit status {status}"


def stop_all(nodes: Iterable[Node], grace: float = 4.0) -> None:
    """SIGTERM to all, SIGKILL to the groups of those that are still there after `grace` seconds."""
    nodes = list(nodes)
    for node in nodes:
        if node.exit_status() is None:
            node.signal_group(signal.SIGTERM)
    deadline = time.monotonic() + grace
    for node in nodes:
        node.wait(max(0.0, deadline - time.monotonic()))
    kill_all(nodes)
    for node in nodes:
        node.wait(grace)


def kill_all(nodes: Iterable[Node]) -> None:
    """SIGKILL to all groups."""
    for node in nodes:
        node.signal_group(signal.SIGKILL)
