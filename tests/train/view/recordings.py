"""Reads recordings back, as the tests of the view need them."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import rerun.chunk


class Logged(NamedTuple):
    """What was logged for one entity at one time."""

    time: float | None  # [s]; None: static
    values: dict[str, Any]  # by the name of the component, without that of its archetype


def _seconds(batch: Any, row: int) -> float | None:
    if "time" not in batch.schema.names:
        return None
    return float(batch.column("time").cast("int64")[row].as_py()) / 1e9


def read(path: Path) -> dict[str, list[Logged]]:
    """Returns what a recording holds, by entity, in the order of time."""
    found: dict[str, list[Logged]] = defaultdict(list)
    for chunk in rerun.chunk.RrdReader(path).stream().to_chunks():
        batch = chunk.to_record_batch()
        for row in range(batch.num_rows):
            values = {
                name.split(":")[-1]: column[row].as_py()
                for name, column in zip(batch.schema.names, batch.columns, strict=True)
                if ":" in name and column[row].as_py() is not None
            }
            found[chunk.entity_path.lstrip("/")].append(Logged(_seconds(batch, row), values))
    for logged in found.values():
        logged.sort(key=lambda one: -1.0 if one.time is None else one.time)
    return found


def lines(logged: list[Logged]) -> np.ndarray:
    """Returns the ends of all lines logged for an entity. [N, 2, 3]"""
    return np.array([strip for one in logged for strip in one.values["strips"]])
