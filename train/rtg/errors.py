"""Errors that end a command early. The docstring of each names the exit status that follows."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TextIO

from rtg import _core


class UserError(Exception):
    """Bad input: a flag, a file or a folder.

    The message names the input and the legal values. Exit status 2.
    """


class RunError(Exception):
    """The run failed. The message names the cause and where to look for details. Exit status 1."""


class StoppedError(Exception):
    """The user stopped the run. The command turns this error into a RunError: exit status 1."""


# Of the machine, not of the input: what to do when it runs out.
_REMEDIES = {
    errno.ENOSPC: "free some space on the disk",
    errno.EDQUOT: "free some space of the quota",
    errno.EFBIG: "allow longer files (ulimit -f)",
    errno.EMFILE: "allow more open files (ulimit -n)",
    errno.ENFILE: "close files of other programs",
    errno.ENOMEM: "free some memory",
    errno.EAGAIN: "allow more processes (ulimit -u)",
    errno.EIO: "replace the disk, or mount it again",
}


def is_of_the_machine(error: OSError) -> bool:
    """Returns whether a resource of the machine is at its end, so that no input is to blame."""
    return error.errno in _REMEDIES


def raise_if_of_the_machine(error: Exception, file: Path) -> None:
    """Raises `error`, met when `file` was used, as in_words() has it if it is_of_the_machine()."""
    if isinstance(error, OSError) and is_of_the_machine(error):
        raise in_words(OSError(error.errno, error.strerror), file) from error


def in_words(error: OSError, file: str | os.PathLike[str] | None = None) -> UserError | RunError:
    """Returns the error that tells of `error` with the file, else `file`, and what to do.

    It is a RunError if a resource of the machine is at its end, else a UserError.
    """
    cause = error.strerror or str(error)  # libraries raise some without a number
    named = error.filename  # str, bytes or path; a number if it has only a descriptor
    if named is not None and not isinstance(named, int):
        file = os.fsdecode(named)
    where = f"{file}: {cause}" if file else cause
    if is_of_the_machine(error):
        return RunError(f"{where}; to mend it: {_REMEDIES[error.errno or 0]}")
    return UserError(f"{where}; legal: a file to read or write")


@contextlib.contextmanager
def fields_of(file: Path) -> Iterator[None]:
    """Turns an error in the `with` block, which uses what `file` holds, into a UserError about it.

    For files that are whole, but do not hold what they should.
    """
    try:
        yield
    except UserError:
        raise
    except (LookupError, TypeError, ValueError, AttributeError, RuntimeError) as error:
        why = f"{type(error).__name__}: {error}".splitlines()[0]
        raise UserError(
            f"{file}: has other fields than it should ({why}); legal: the file as the run wrote it"
        ) from error


def exit_status(program: str, command: Callable[[], int]) -> int:
    """Returns the exit status of `command`, or the one that follows from its error.

    Prints the error after the name of the program. ConfigError is bad input, too. If nobody reads
    the output any more, as behind `| head`, the command ends quietly, with status 1.
    """
    try:
        try:
            status = command()
        except SystemExit as end:  # of argparse, after --help
            status = end.code if isinstance(end.code, int) else 0
        sys.stdout.flush()  # Python would flush at its end, where no handler catches errors
        return status
    except BrokenPipeError:
        _discard(sys.stdout)
        return 1
    except MemoryError as error:
        return _say(program, RunError(f"too little memory: {error}"))
    except OSError as error:
        return _say(program, in_words(error))
    except (UserError, RunError, _core.ConfigError) as error:
        return _say(program, error)


def _say(program: str, error: Exception) -> int:
    """Prints the error and returns its exit status."""
    status = 1 if isinstance(error, RunError) else 2
    for stream, words in ((sys.stdout, ""), (sys.stderr, f"{program}: {error}\n")):
        try:
            stream.write(words)
            stream.flush()
        except OSError:
            _discard(stream)
            status = 1
    return status


def _discard(stream: TextIO) -> None:
    """Directs a stream nowhere: what it still holds cannot be written."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
