"""Writes the frames of episodes, one after another, as one film."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from rtg import extras

CODEC, PIXEL_FORMAT = "h264", "yuv420p"
# Every other frame is whole, so that a learner that jumps to one decodes two at most.
_OPTIONS = {"g": "2", "crf": "23", "preset": "medium", "bf": "0"}


class Film:
    """An mp4 file that frames are added to. A context manager, which finishes the file."""

    def __init__(self, path: Path, fps: int, side: int) -> None:
        """`side`: width and height of the frames, an even number."""
        self._av: Any = extras.imported("av", "lerobot", "export lerobot")
        self._container = self._av.open(str(path), "w")
        self._stream = self._container.add_stream("libx264", rate=fps, options=_OPTIONS)
        self._stream.width = self._stream.height = side
        self._stream.pix_fmt = PIXEL_FORMAT
        self._stream.codec_context.time_base = Fraction(1, fps)
        self._stream.codec_context.thread_count = 1
        self._count = 0

    def __enter__(self) -> Self:
        return self

    def add(self, image: NDArray[np.uint8]) -> None:
        """Appends a frame. [side, side, 3]"""
        frame = self._av.VideoFrame.from_ndarray(np.ascontiguousarray(image), format="rgb24")
        frame.pts, frame.time_base = self._count, self._stream.codec_context.time_base
        self._count += 1
        self._container.mux(self._stream.encode(frame))

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is None and self._count:
            self._container.mux(self._stream.encode())
        self._container.close()
