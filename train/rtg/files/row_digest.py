"""The digest of a sequence of transitions, which both sides of their stream compute.

It is the SHA-256 of the rows one after another, of each: poses [bodies, 3] float64, action int32,
next poses, success int8, source int8, little-endian. The coordinator has it in generation.json.
"""

from __future__ import annotations

import hashlib
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

KEY = "rows_sha256"  # in generation.json
_BLOCK = 4096  # rows


class Columns(Protocol):
    """The columns of N transitions, as of dataset.Rows."""

    @property
    def poses(self) -> NDArray[np.float64]: ...  # [N, bodies, 3]
    @property
    def action(self) -> NDArray[np.int32]: ...  # [N]
    @property
    def next_poses(self) -> NDArray[np.float64]: ...  # [N, bodies, 3]
    @property
    def terminated(self) -> NDArray[np.bool_]: ...  # [N]
    @property
    def source(self) -> NDArray[np.int8]: ...  # [N]


def row_digest(rows: Columns) -> str:
    """Returns the digest of transitions, in hexadecimal digits."""
    found, count, state = hashlib.sha256(), len(rows.action), rows.poses.shape[1:]
    columns = {
        "poses": (rows.poses, "<f8", state),
        "action": (rows.action, "<i4"),
        "next_poses": (rows.next_poses, "<f8", state),
        "success": (rows.terminated, "i1"),
        "source": (rows.source, "i1"),
    }
    packed = np.dtype([(name, *kind) for name, (_, *kind) in columns.items()])
    for begin in range(0, count, _BLOCK):
        block = np.empty(min(_BLOCK, count - begin), packed)
        for name, (column, *_) in columns.items():
            block[name] = column[begin : begin + _BLOCK]
        found.update(block.tobytes())
    return found.hexdigest()
