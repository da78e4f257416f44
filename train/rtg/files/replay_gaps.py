"""Histograms of the replay gap over fixed bins: short, and those of several runs can be added."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

_BINS = 100
# Bounds of the bins [m], [101]; a gap outside them counts in the first or the last bin.
EDGES: NDArray[np.float64] = np.geomspace(1e-4, 10.0, _BINS + 1)


def counts(gaps: Sequence[float]) -> list[int]:
    """Returns the number of gaps [m] in each bin. [100]"""
    values = np.clip(np.asarray(gaps, float), EDGES[0], EDGES[-1])
    return [int(count) for count in np.histogram(values, EDGES)[0]]
