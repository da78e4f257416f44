"""Regions of starts, as pictures show them."""

import numpy as np
import pytest
from rtg import _core, paths
from rtg.run.start_regions import rings

GATHERING = (paths.CONFIG / "gathering.yaml").read_text()


def of_box1(start):
    text = GATHERING.replace("start: [-3.0, 1.13, 0.2]", f"start: {start}")
    assert text != GATHERING
    config = _core.Config.from_text(text, "a task", [])
    found = rings(config)
    assert list(found) == [1]
    drawn = np.stack([config.task.jittered_start(0.0, 1, k)[1, :2] for k in range(50)])
    return found[1] / config.task.metre, drawn / config.task.metre


def test_bodies_that_start_in_a_place_have_none():
    assert rings(_core.Config.from_text(GATHERING, "a task", [])) == {}


@pytest.mark.parametrize(
    ("start", "corners"),
    [
        ("{x: [-4, -2], y: [1, 3], theta: 0}", [[-4, 1], [-2, 1], [-2, 3], [-4, 3]]),
        ("{x: [-4, -2], y: 1, theta: 0}", [[-4, 1], [-2, 1], [-2, 1], [-4, 1]]),
        ("{in: {polygon: [[-4, 0], [-2, 0], [-3, 2]]}}", [[-4, 0], [-2, 0], [-3, 2]]),
    ],
)
def test_ranges_and_polygons_are_as_written(start, corners):
    ring, drawn = of_box1(start)
    assert np.allclose(ring, corners)
    assert (drawn >= ring.min(axis=0) - 1e-9).all() and (drawn <= ring.max(axis=0) + 1e-9).all()


def test_a_box_has_its_corners():
    ring, _ = of_box1("{in: {box: {centre: [-3, 1], size: [2, 1]}}}")
    assert sorted(map(tuple, ring)) == [(-4, 0.5), (-4, 1.5), (-2, 0.5), (-2, 1.5)]


def test_a_disc_is_round():
    ring, drawn = of_box1("{in: {disc: {centre: [-3, 1], radius: 1}}}")
    assert len(ring) >= 32
    assert np.allclose(np.linalg.norm(ring - [-3, 1], axis=1), 1.0)
    assert (np.linalg.norm(drawn - [-3, 1], axis=1) <= 1.0 + 1e-9).all()
