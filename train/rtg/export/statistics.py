"""Statistics of the columns of a LeRobot data set, by which learners scale their inputs."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Statistics = dict[str, Any]  # by name, nested lists of numbers

_QUANTILES = {"q01": 0.01, "q10": 0.1, "q50": 0.5, "q90": 0.9, "q99": 0.99}
_LEVELS = np.arange(256) / 255.0  # of a colour


def of_numbers(column: NDArray[Any]) -> Statistics:
    """Returns the statistics of each entry of a column. [N] or [N, entries] -> [entries]"""
    values = column.reshape(len(column), -1).astype(np.float64)
    found = {
        "min": values.min(axis=0),
        "max": values.max(axis=0),
        "mean": values.mean(axis=0),
        "std": values.std(axis=0),
        **{name: np.quantile(values, at, axis=0) for name, at in _QUANTILES.items()},
    }
    return {name: array.tolist() for name, array in found.items()} | {"count": [len(values)]}


def histogram(image: NDArray[np.uint8]) -> NDArray[np.int64]:
    """Counts the pixels of each level, by channel. [height, width, 3] -> [3, 256]"""
    channels = image.reshape(-1, 3).T
    return np.stack([np.bincount(channel, minlength=256) for channel in channels])


def of_images(levels: NDArray[np.int64], frames: int) -> Statistics:
    """Returns the statistics of colours from 0 to 1, each [3, 1, 1]. `levels`: sum of histograms.

    [3, 256]
    """
    share = levels / levels.sum(axis=1, keepdims=True)
    up_to = np.cumsum(share, axis=1)
    mean = share @ _LEVELS
    found = {
        "min": _LEVELS[(levels > 0).argmax(axis=1)],
        "max": _LEVELS[255 - (levels[:, ::-1] > 0).argmax(axis=1)],
        "mean": mean,
        "std": np.sqrt(np.maximum(share @ _LEVELS**2 - mean**2, 0.0)),
        **{name: _LEVELS[(up_to >= at - 1e-12).argmax(axis=1)] for name, at in _QUANTILES.items()},
    }
    return {name: array.reshape(3, 1, 1).tolist() for name, array in found.items()} | {
        "count": [frames]
    }
