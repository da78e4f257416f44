"""The episode that a run leaves: the best one of its policy, or a plan of its data."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rtg.errors import UserError
from rtg.files import archives

FILE = "best_episode.npz"

Floats = NDArray[np.float64]


def write(run: Path, poses: Floats, success: bool) -> None:
    """Writes the states of the episode, [T + 1, bodies, 3], and whether it succeeds."""
    with archives.written(run / FILE) as file:
        np.savez(file, poses=poses, success=success)


def read(run: Path, bodies: int) -> tuple[Floats, bool]:
    """Returns the states of the episode, [T + 1, bodies, 3], and whether it succeeds.

    Raises UserError if the file is damaged, or has another number of bodies.
    """
    path = run / FILE
    try:
        found = archives.arrays(path, ("poses", "success"))
        poses, success = np.asarray(found["poses"], np.float64), bool(found["success"])
        if poses.ndim != 3 or poses.shape[1:] != (bodies, 3) or not len(poses):
            raise ValueError(poses.shape)
        if not np.isfinite(poses).all():
            raise ValueError("not finite")
    except (OSError, ValueError, TypeError, KeyError):
        raise UserError(
            f"{path}: is damaged; legal: the file as the run wrote it, or no file"
        ) from None
    return poses, success
