"""Statistics of columns and colours, against NumPy on all values."""

import numpy as np
import pytest
from rtg.export import statistics

FIGURES = {
    "min": np.min,
    "max": np.max,
    "mean": np.mean,
    "std": np.std,
    "q10": lambda values, axis: np.quantile(values, 0.1, axis=axis),
    "q50": lambda values, axis: np.quantile(values, 0.5, axis=axis),
    "q99": lambda values, axis: np.quantile(values, 0.99, axis=axis),
}


@pytest.mark.parametrize("name", FIGURES)
def test_each_entry_of_a_column_has_its_own(name):
    column = np.random.default_rng(0).normal(size=(37, 3)).astype(np.float32)
    found = statistics.of_numbers(column)
    np.testing.assert_allclose(found[name], FIGURES[name](column.astype(float), axis=0))
    assert found["count"] == [37]


def test_scalars_and_truth_values_are_one_entry():
    found = statistics.of_numbers(np.array([True, False, False, True]))
    assert (found["min"], found["max"], found["mean"]) == ([0.0], [1.0], [0.5])


@pytest.mark.parametrize("name", FIGURES)
def test_colours_are_counted_over_all_pixels_of_all_images(name):
    """A quantile is a level, the smallest one below which there are so many."""
    images = np.random.default_rng(0).integers(20, 200, size=(4, 6, 8, 3)).astype(np.uint8)
    levels = sum(statistics.histogram(image) for image in images)
    found = statistics.of_images(levels, 4)
    pixels = images.reshape(-1, 3) / 255.0
    if name.startswith("q"):
        expected = np.quantile(pixels, int(name[1:]) / 100, axis=0, method="inverted_cdf")
    else:
        expected = FIGURES[name](pixels, axis=0)
    assert np.shape(found[name]) == (3, 1, 1) and found["count"] == [4]
    np.testing.assert_allclose(np.ravel(found[name]), expected, atol=1e-9)


def test_an_image_of_one_colour_has_no_spread():
    image = np.full((4, 4, 3), [0, 128, 255], np.uint8)
    found = statistics.of_images(statistics.histogram(image), 1)
    for name in ("min", "max", "mean", "q01", "q99"):
        np.testing.assert_allclose(np.ravel(found[name]), [0.0, 128 / 255, 1.0])
    np.testing.assert_allclose(np.ravel(found["std"]), 0.0, atol=1e-7)
