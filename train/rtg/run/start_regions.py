"""The regions in which bodies start whose start is drawn anew in each episode."""

from __future__ import annotations

import json

import numpy as np
from numpy.typing import NDArray

from rtg import _core

Floats = NDArray[np.float64]

_CORNERS = 64  # of a disc as it is drawn


def rings(config: _core.Config) -> dict[int, Floats]:
    """Returns the outlines of the regions by body, [V, 2] each, in the unit of poses."""
    bodies = json.loads(config.json)["task"]["bodies"]
    starts = ((body, of_body["start"]) for body, of_body in enumerate(bodies))
    return {
        body: _ring(start) * config.task.metre for body, start in starts if isinstance(start, dict)
    }


def _ring(start: dict[str, object]) -> Floats:
    """Returns the outline of a start's region in m. [V, 2]"""
    match start:
        case {"in": {"disc": {"centre": centre, "radius": float(radius) | int(radius)}}}:
            turn = np.linspace(0.0, 2.0 * np.pi, _CORNERS, endpoint=False)
            circle = np.stack([np.cos(turn), np.sin(turn)], axis=1)
            return np.asarray(centre + radius * circle, float)
        case {"in": {"polygon": ring}}:
            return np.asarray(ring, float)
        case {"x": [left, right], "y": [low, high]}:
            return np.array([[left, low], [right, low], [right, high], [left, high]], float)
    raise AssertionError(start)
