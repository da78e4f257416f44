"""Triangles of an outline cover it, all of it and nothing else."""

import numpy as np
import pytest
from rtg.view.meshes import triangles

SQUARE = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
T_SHAPE = np.array([[-2.0, 1], [-2, 0], [-0.3, 0], [-0.3, -3], [0.3, -3], [0.3, 0], [2, 0], [2, 1]])


def area(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    return float(np.abs(ux * vy - uy * vx).sum() / 2.0)


@pytest.mark.parametrize(
    ("rings", "expected"),
    [
        ([SQUARE], 4.0),
        ([SQUARE[::-1]], 4.0),
        ([T_SHAPE], 4.0 + 1.8),
        ([SQUARE, 0.5 * SQUARE], 3.0),
        ([SQUARE, 0.2 * SQUARE + 0.5, 0.2 * SQUARE - 0.5], 4.0 - 0.32),
    ],
    ids=["square", "clockwise", "concave", "hole", "two holes"],
)
def test_the_triangles_have_the_area_of_the_outline(rings, expected):
    assert area(*triangles(rings)) == pytest.approx(expected, rel=1e-9)
