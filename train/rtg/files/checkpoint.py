"""Checkpoints: nested dictionaries of tensors, arrays and plain values in one file."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import torch as th

from rtg.errors import UserError


def write(path: Path, state: dict[str, Any]) -> None:
    """Writes `state` to `path`, atomically even if the machine crashes."""
    draft = path.with_name(path.name + ".part")
    with draft.open("wb") as file:
        th.save(_portable(state), file)
        file.flush()
        os.fsync(file.fileno())
    os.replace(draft, path)


def read(path: Path) -> dict[str, Any]:
    """Reads a file that write() wrote; arrays become tensors. Executes no code from the file.

    Raises UserError if the file is missing, unreadable or damaged.
    """
    try:
        state = th.load(path, map_location="cpu", weights_only=True)
    except FileNotFoundError:
        raise UserError(
            f"{path}: no such file; legal: a checkpoint or policy file of RTG"
        ) from None
    except OSError as error:
        raise UserError(f"{path}: {error.strerror or error}; legal: a file to read") from None
    except Exception as error:  # the unpickler may raise any error on foreign bytes
        raise UserError(f"{path}: is damaged or foreign; legal: a file that RTG wrote") from error
    if not isinstance(state, dict):
        raise UserError(
            f"{path}: holds a {type(state).__name__}, not a dict; legal: a file that RTG wrote"
        )
    return state


def _portable(value: Any) -> Any:
    """Returns `value` with arrays replaced by tensors and numpy scalars by Python numbers."""
    if isinstance(value, dict):
        return {key: _portable(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_portable(part) for part in value]
    if isinstance(value, np.ndarray):
        return th.from_numpy(np.ascontiguousarray(value))
    return value.item() if isinstance(value, np.generic) else value
