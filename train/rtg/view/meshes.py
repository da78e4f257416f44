"""Triangles that fill the outline of a body or of a mark of the goal."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.path import Path
from matplotlib.tri import Triangulation
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_PIECES = 40  # number of pieces into which the extent of the outline would be cut


def _cut(ring: Floats, length: float) -> Floats:
    """Returns the ring with its edges cut into pieces of at most `length`. [V, 2] -> [W, 2]"""
    pieces = []
    for begin, end in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        count = max(1, int(np.ceil(np.linalg.norm(end - begin) / length)))
        pieces.append(begin + (end - begin) * np.arange(count)[:, None] / count)
    return np.concatenate(pieces)


def triangles(rings: Sequence[Floats]) -> tuple[Floats, Ints]:
    """Fills an outer ring without the holes that follow it. Returns vertices and triangles.

    A Delaunay triangulation has all edges of a polygon once they are cut into pieces that are short
    enough. The triangles outside the polygon are left out.
    rings [V, 2] each -> [W, 2], [T, 3] indices of vertices
    """
    rings = [np.asarray(ring, float) for ring in rings]
    length = float(np.ptp(rings[0], axis=0).max()) / _PIECES
    vertices = np.concatenate([_cut(ring, length) for ring in rings])
    found = np.asarray(Triangulation(*vertices.T).triangles, np.int64)
    centres = vertices[found].mean(axis=1)
    inside = Path(rings[0]).contains_points(centres)
    for hole in rings[1:]:
        inside &= ~Path(hole).contains_points(centres)
    return vertices, found[inside]
