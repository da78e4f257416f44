"""The replay gap of a run as counts over fixed bins: short enough to keep, and to add up."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

_BINS = 100
# Bounds of the bins [m], [101]; what lies beyond counts in the first or the last.
EDGES: NDArray[np.float64] = np.geomspace(1e-4, 10.0, _BINS + 1)


def counts(gaps: Sequence[float]) -> list[int]:
    """How many of the gaps [m] lie in each bin. [100]"""
    values = np.clip(np.asarray(gaps, float), EDGES[0], EDGES[-1])
    return [int(count) for count in np.histogram(values, EDGES)[0]]
