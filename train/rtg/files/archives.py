"""Archives (.npz, .pt): zip files whose comment is the SHA-256 of all bytes before it.

Any reader of such files reads them. Those of other programs, and of earlier versions of RTG, have
no comment, and no digest to be checked.
"""

from __future__ import annotations

import contextlib
import hashlib
import math
import os
import zipfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from rtg import errors
from rtg.files import whole_files

# The last record of a zip file: its first bytes, and its length without the comment, whose length
# is in its last two bytes.
_END, _END_LENGTH = b"PK\x05\x06", 22
_DIGITS = 64
_BLOCK = 2**20
_HEADERS = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
}


def room(size: int) -> int:
    """Returns the bytes to which a file of `size` bytes may unpack."""
    return 2**26 + 4 * size


@contextlib.contextmanager
def written(path: Path) -> Iterator[BinaryIO]:
    """Yields a file for a zip archive without comment, which replaces `path` with its digest."""
    with whole_files.replacing(path) as file:
        yield file
        file.seek(-2, os.SEEK_END)
        file.write(_DIGITS.to_bytes(2, "little"))
        file.write(_digest(file, file.tell()))


@contextlib.contextmanager
def opened(path: Path) -> Iterator[BinaryIO]:
    """Yields an archive to read.

    Raises OSError; ValueError if it is none, differs from what was written, or would unpack to more
    than four times its size.
    """
    with whole_files.opened(path) as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(max(0, size - _END_LENGTH - _DIGITS))
        tail = file.read()
        end = tail[-_END_LENGTH:]
        is_bare = end.startswith(_END) and end.endswith(b"\0\0")  # it ends, and has no comment
        if not is_bare and not (
            tail.startswith(_END) and _digest(file, size - _DIGITS) == tail[-_DIGITS:]
        ):
            raise ValueError("no archive, or changed since it was written")
        try:
            with zipfile.ZipFile(file) as archive:
                unpacked = sum(entry.file_size for entry in archive.infolist())
        except Exception as error:  # zipfile raises any error on foreign bytes
            if isinstance(error, OSError) and errors.is_of_the_machine(error):
                raise
            raise ValueError(str(error)) from None
        if unpacked > room(size):
            raise ValueError(f"it would unpack to {unpacked} bytes")
        file.seek(0)
        yield file


def arrays(path: Path, names: Iterable[str]) -> dict[str, NDArray[Any]]:
    """Returns those arrays of a .npz that are asked for and there. Raises as opened() does."""
    with opened(path) as file:
        try:
            with np.load(file, allow_pickle=False) as archive:
                there = [name for name in names if name in archive]
                for name in there:
                    _check_size(archive.zip, name)
                found = {name: archive[name] for name in there}
        except OSError:
            raise
        except Exception as error:  # numpy and zipfile raise any error on foreign bytes
            raise ValueError(str(error)) from None
    if not all(isinstance(array, np.ndarray) for array in found.values()):
        raise ValueError("it holds other files than arrays")
    return found


def _check_size(archive: zipfile.ZipFile, name: str) -> None:
    """Raises ValueError if an array would take more bytes than its entry has.

    numpy allocates what the header tells of before it reads on.
    """
    entry = archive.getinfo(f"{name}.npy" if f"{name}.npy" in archive.namelist() else name)
    with archive.open(entry) as member:
        version = np.lib.format.read_magic(member)
        if version not in _HEADERS:
            raise ValueError(f"array '{name}' has a header of version {version}")
        shape, _, dtype = _HEADERS[version](member)
    count = math.prod(shape) * max(1, dtype.itemsize)
    if not 0 <= count <= entry.file_size:
        raise ValueError(
            f"array '{name}' has {entry.file_size} bytes, not the {count} of its header"
        )


def _digest(file: BinaryIO, count: int) -> bytes:
    """Returns the SHA-256 of the first `count` bytes, as digits; leaves the file behind them."""
    found = hashlib.sha256()
    file.seek(0)
    while count and (block := file.read(min(count, _BLOCK))):
        found.update(block)
        count -= len(block)
    return found.hexdigest().encode()
