"""Histograms of the replay gap. The bins are fixed, so that histograms of runs can be added.

The replay gap of a reverse step tells how far its forward replay ends from its given final state.
It is the mean distance of the bodies, in UNIT.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

UNIT = "m, where the robot's radius is 0.8 m"

_BINS = 100
# Bounds of the bins, [101]; a gap outside them counts in the first or the last bin.
EDGES: NDArray[np.float64] = np.geomspace(1e-4, 10.0, _BINS + 1)


def counts(gaps: Sequence[float]) -> list[int]:
    """Returns the number of gaps in each bin. [100]"""
    values = np.clip(np.asarray(gaps, float), EDGES[0], EDGES[-1])
    return [int(count) for count in np.histogram(values, EDGES)[0]]
