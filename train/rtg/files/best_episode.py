"""The episode that a run leaves: the best one of its policy, or a plan of its data."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rtg.errors import UserError

FILE = "best_episode.npz"

Floats = NDArray[np.float64]


def write(run: Path, poses: Floats, success: bool) -> None:
    """Writes the states of the episode, [T + 1, bodies, 3], and whether it succeeds."""
    np.savez(run / FILE, poses=poses, success=success)


def read(run: Path, bodies: int) -> tuple[Floats, bool]:
    """Returns the states of the episode, [T + 1, bodies, 3], and whether it succeeds.

    Raises UserError if the file is damaged, or has another number of bodies.
    """
    path = run / FILE
    try:
        with np.load(path, allow_pickle=False) as file:
            poses, success = np.asarray(file["poses"], np.float64), bool(file["success"])
        if poses.ndim != 3 or poses.shape[1:] != (bodies, 3) or not len(poses):
            raise ValueError(poses.shape)
    except (OSError, EOFError, ValueError, TypeError, KeyError, zipfile.BadZipFile):
        raise UserError(
            f"{path}: is damaged; legal: the file as the run wrote it, or no file"
        ) from None
    return poses, success
