"""Whole files: replaced completely or not at all, read only if they are regular files."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

_LONGEST = 2**28  # bytes of a text


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[BinaryIO]:
    """Yields a new file, to write and read, that takes the place of `path` after the `with` block.

    It survives a crash of the machine. If the block raises, `path` stays as it was. An OSError
    without a file's name gets that of `path`.
    """
    draft = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        with draft.open("w+b") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        draft.replace(path)
        _sync(path.parent)
    except OSError as error:
        if error.filename in (None, str(draft)):
            error.filename, error.filename2 = str(path), None
        raise
    finally:
        with contextlib.suppress(OSError):
            draft.unlink()


def _sync(folder: Path) -> None:
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


@contextlib.contextmanager
def opened(path: Path) -> Iterator[BinaryIO]:
    """Yields a file to read: no device, which may never end, no FIFO, which may never begin.

    Raises OSError.
    """
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    mode = os.fstat(descriptor).st_mode
    if not stat.S_ISREG(mode):
        os.close(descriptor)
        if stat.S_ISDIR(mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
        raise OSError(errno.EINVAL, "Is no regular file", str(path))
    with os.fdopen(descriptor, "rb") as file:
        yield file


def read(path: Path) -> bytes:
    """Returns the content of a file of text. Raises OSError, also if it is absurdly long."""
    with opened(path) as file:
        size = os.fstat(file.fileno()).st_size
        if size > _LONGEST:
            raise OSError(errno.EINVAL, f"Is longer than {_LONGEST} bytes", str(path))
        return file.read(size)  # which takes as much memory at once


def grow(path: Path) -> None:
    """Makes a file longer.

    Raises OSError. It tells why a library could not, if that one hides the cause.
    """
    with path.open("ab") as file:
        file.write(bytes(2**20))
