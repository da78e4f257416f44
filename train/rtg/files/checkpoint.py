"""Checkpoints: nested dictionaries of tensors, arrays and plain values in one file."""

from __future__ import annotations

import io
import pickletools
import re
import zipfile
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import torch as th

from rtg.errors import UserError, raise_if_of_the_machine
from rtg.files import archives

_LEGAL = re.compile(
    r"torch [A-Z][a-zA-Z0-9]*Storage|torch\._utils _rebuild_tensor_v2|collections OrderedDict"
)


def write(path: Path, state: dict[str, Any]) -> None:
    """Writes `state` to `path`, atomically even if the machine crashes."""
    content = io.BytesIO()  # PyTorch hides the errors of a file
    th.save(_portable(state), content)
    with archives.written(path) as file:
        file.write(content.getbuffer())


def read(path: Path) -> dict[str, Any]:
    """Reads a file that write() wrote; arrays become tensors. Executes no code from the file.

    Raises UserError if the file is missing, unreadable or changed.
    """
    try:
        with archives.opened(path) as file:
            _check_globals(file)
            state = th.load(file, map_location="cpu", weights_only=True)
    except FileNotFoundError:
        raise UserError(
            f"{path}: no such file; legal: a checkpoint or policy file of RTG"
        ) from None
    except OSError as error:
        raise_if_of_the_machine(error, path)
        raise UserError(f"{path}: {error.strerror or error}; legal: a file to read") from None
    except Exception as error:  # the unpickler may raise any error on foreign bytes
        raise UserError(f"{path}: is damaged or foreign; legal: a file that RTG wrote") from error
    if not isinstance(state, dict):
        raise UserError(
            f"{path}: holds a {type(state).__name__}, not a dict; legal: a file that RTG wrote"
        )
    return state


def _check_globals(file: BinaryIO) -> None:
    """Raises ValueError if an archive asks for more than numbers, texts, tensors and dictionaries.

    PyTorch makes a bytearray of any length for a file of 400 bytes, and takes the names of an
    archive in either case.
    """
    if file.read(4) != b"PK\x03\x04":  # PyTorch would read what is before the archive
        raise ValueError("no archive of PyTorch")
    with zipfile.ZipFile(file) as archive:
        for entry in archive.infolist():
            if entry.filename.lower().endswith(".pkl"):
                for operation, name, _ in pickletools.genops(archive.read(entry)):
                    if operation.name == "GLOBAL" and not _LEGAL.fullmatch(str(name)):
                        raise ValueError(f"it asks for {name}")
    file.seek(0)


def _portable(value: Any) -> Any:
    """Returns `value` with arrays replaced by tensors and numpy scalars by Python numbers."""
    if isinstance(value, dict):
        return {key: _portable(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_portable(part) for part in value]
    if isinstance(value, np.ndarray):
        return th.from_numpy(np.ascontiguousarray(value))
    return value.item() if isinstance(value, np.generic) else value
