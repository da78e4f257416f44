"""Locks on files, by flock(2): the kernel releases them when their holders have ended.

They work between the machines that share a file system as far as that file system has flock.

A process works with an exclusive lock. flock cannot be asked for one: /proc/locks leaves out other
machines and containers, and names other devices than stat(2) on Btrfs and overlays. is_locked()
therefore takes a shared lock for a moment, which those who want the exclusive one see through.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import time
from collections.abc import Iterator
from pathlib import Path

from rtg.errors import UserError
from rtg.files.run_folder import write_errors_as_user_errors

GRAPH_LOCK = ".graph.lock"  # of graph.sh, in the folder of its run
_MOMENT = 1e-3  # [s]


class FileLock:
    """A lock on a file. Child processes that inherit its descriptor hold it as well."""

    def __init__(self, descriptor: int) -> None:
        self.descriptor = descriptor

    def release(self) -> None:
        """Releases the lock, also for the processes that have inherited it. May be repeated."""
        if self.descriptor >= 0:
            fcntl.flock(self.descriptor, fcntl.LOCK_UN)
            os.close(self.descriptor)
            self.descriptor = -1


def try_lock(path: Path) -> FileLock | None:
    """Locks the file `path`, which it creates; returns None if somebody else has locked it.

    The file is never removed: another process might lock it between the two.
    """
    descriptor = _open(path)
    try:
        while not _takes(descriptor, fcntl.LOCK_EX):
            if not _takes(descriptor, fcntl.LOCK_SH):
                os.close(descriptor)
                return None
            fcntl.flock(descriptor, fcntl.LOCK_UN)  # others have shared locks alone: is_locked()
            time.sleep(_MOMENT)
    except OSError:
        os.close(descriptor)
        raise
    return FileLock(descriptor)


def is_locked(path: Path) -> bool:
    """Returns whether somebody has locked the file `path`, which need not exist or be writable."""
    try:
        descriptor = os.open(path, os.O_RDONLY)
    except FileNotFoundError:
        return False
    try:
        return not _takes(descriptor, fcntl.LOCK_SH)
    finally:
        os.close(descriptor)


@contextlib.contextmanager
def lock(path: Path) -> Iterator[None]:
    """Waits for the lock on the file `path`, which it creates, and holds it in the `with` block."""
    descriptor = _open(path)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


@contextlib.contextmanager
def exclusive_lock(folder: Path, holder: str) -> Iterator[None]:
    """Locks the existing `folder` against other processes during the `with` block.

    Raises UserError if another process has locked it. The message calls that process `holder`.
    """
    with write_errors_as_user_errors(folder):
        held = try_lock(_run_lock(folder))
    if held is None:
        raise UserError(
            f"--out: {folder}: {holder} uses this folder; legal: another folder, or wait"
        )
    try:
        yield
    finally:
        held.release()


def job_lock(run: Path) -> Path:
    """Returns the lock of a run's job in a comparison. It lies beside the folder `run`.

    The job makes that folder.
    """
    return run.with_name(f".{run.name}.lock")


def of_run(run: Path) -> tuple[Path, ...]:
    """Returns the locks of those who work on a run: `rtg run`, graph.sh, a job of a comparison."""
    return _run_lock(run), run / GRAPH_LOCK, job_lock(run.resolve())


def _run_lock(folder: Path) -> Path:
    return folder / ".lock"


def _takes(descriptor: int, kind: int) -> bool:
    """Takes a lock of this kind if no other one is in its way; returns whether it has."""
    try:
        fcntl.flock(descriptor, kind | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _open(path: Path) -> int:
    """Opens a file to write to, as NFS asks of what is locked."""
    return os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
