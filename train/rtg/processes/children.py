"""Child processes that end with their parent."""

from __future__ import annotations

import contextlib
import ctypes
import errno
import os
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Protocol

from rtg.errors import RunError, UserError, in_words
from rtg.processes.program_log import ProgramLog

_PR_SET_PDEATHSIG = 1
_SCANT = 1 << 20  # [bytes] of free space, with which a program that needs more may have failed
_libc = ctypes.CDLL(None)


def die_with(parent: int) -> Callable[[], None]:
    """Returns a function that the child process calls before it starts its program.

    The kernel then kills the child when the thread that started it ends. `parent`: the id of this
    process.
    """

    def die_with_parent() -> None:
        _libc.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:  # the parent ended before prctl()
            os._exit(1)

    return die_with_parent


class Node:
    """A program of a run, as a child process with its own process group and log file."""

    def __init__(
        self, name: str, command: Sequence[str | Path], log: Path, descriptors: Sequence[int] = ()
    ) -> None:
        """Starts the program, which inherits the open `descriptors`.

        Main thread only, because the child dies with its starting thread.
        """
        self.name = name
        self.log = log
        self._reaped = False
        self._logged = ProgramLog(log)
        with log.open("ab") as output:
            self._process = subprocess.Popen(
                [str(part) for part in command],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                preexec_fn=die_with(os.getpid()),
                pass_fds=descriptors,
            )

    @property
    def pid(self) -> int:
        """The process id, which is also the id of the process group."""
        return self._process.pid

    def exit_status(self) -> int | None:
        """Returns the exit status of the program; None while it runs.

        If the program has ended, kills the rest of its process group.
        """
        status = self._process.poll()
        if status is not None and not self._reaped:
            self.signal_group(signal.SIGKILL)
            self._reaped = True  # from now on the kernel may reuse the id
        return status

    def signal_group(self, number: int) -> None:
        """Sends signal `number` to the process group: the program and its descendants."""
        if not self._reaped:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.pid, number)

    def stop(self) -> None:
        """Asks the program to stop, by SIGTERM."""
        if self.exit_status() is None:
            self.signal_group(signal.SIGTERM)

    def kill(self) -> None:
        """Ends the program and its descendants at once, by SIGKILL."""
        self.signal_group(signal.SIGKILL)

    def wait(self, seconds: float) -> bool:
        """Waits at most `seconds`; returns whether the program has ended."""
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            return False
        return self.exit_status() is not None

    def log_tail(self, lines: int = 8) -> str:
        """Returns the last `lines` lines that the program has written to the log."""
        return self._logged.tail(lines)

    def new_log_lines(self) -> list[str]:
        """Returns the lines that the program has completed since the last call of this method."""
        return self._logged.new_lines()

    def exit_text(self) -> str:
        """Describes how the program ended."""
        status = self.exit_status()
        if status is not None and status < 0:
            return f"{self.name} was killed by {signal.Signals(-status).name}"
        return f"{self.name} ended with exit status {status}"

    def raise_if_failed(self) -> None:
        """Raises RunError if the program has failed, or UserError if it reported bad input.

        Exit status 2 means bad input in all programs of RTG.
        """
        status, words = self.exit_status(), self.log_tail()
        if status == 2 and words:
            raise UserError(words.splitlines()[-1])
        if status:
            end = f"; the end of {self.log}:\n{words}" if words else self.why_mute()
            raise RunError(self.exit_text() + end)

    def why_mute(self) -> str:
        """Says why the program may not have written to its log; empty if it could have."""
        try:
            with self.log.open("ab", buffering=0) as log:
                log.write(b"\n")
            if shutil.disk_usage(self.log.parent).free < _SCANT:  # its end has freed some
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        except OSError as error:
            return f"; {in_words(error, self.log)}"
        return ""


class Stoppable(Protocol):
    """A job or program that can be stopped; Node is an example."""

    def wait(self, seconds: float) -> bool:
        """Waits at most `seconds`; returns whether it has ended."""

    def stop(self) -> None:
        """Asks it to stop; it may take its time."""

    def kill(self) -> None:
        """Ends it at once."""


def stop_all(running: Iterable[Stoppable], grace: float = 4.0) -> None:
    """Asks all to stop, and kills those that still run after `grace` s."""
    running = list(running)
    for one in running:
        one.stop()
    deadline = time.monotonic() + grace
    for one in running:
        one.wait(max(0.0, deadline - time.monotonic()))
    kill_all(running)
    deadline = time.monotonic() + grace
    for one in running:
        one.wait(max(0.0, deadline - time.monotonic()))


def kill_all(running: Iterable[Stoppable]) -> None:
    """Ends all at once, with their descendants."""
    for one in running:
        one.kill()
