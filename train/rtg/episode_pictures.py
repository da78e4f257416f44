"""Pictures of one episode: a strip of its states and a film."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from rtg.draw import PAPER, TaskLike, state_image

Floats = NDArray[np.float64]

_FRAMES_PER_PUSH = 8
_FRAME_MS = 45
_HOLD_MS = 1200  # at the start and at the end


def between(before: Floats, after: Floats, share: float) -> Floats:
    """The state when `share` of a push is done. [bodies, 3]

    The robot moves evenly; an object stands still until the rest of the push covers its way, then
    moves along. Exact for straight drags, good enough to watch.
    """
    way = np.linalg.norm(after[:, :2] - before[:, :2], axis=1)  # [bodies]
    stride = max(float(way[0]), 1e-9)
    rest = np.clip(way / stride, 1e-9, 1.0)  # share of the push in which a body moves
    moved = np.clip((share - (1.0 - rest)) / rest, 0.0, 1.0)
    moved[0] = share
    return before + (after - before) * moved[:, None]


def strip(path: Path, task: TaskLike, poses: Floats, success: bool, columns: int = 5) -> None:
    """Two rows at most of states from the first to the last. poses [T+1, bodies, 3]."""
    last = len(poses) - 1
    shown = np.unique(np.linspace(0, last, min(last + 1, 2 * columns)).round().astype(int))
    tiles = []
    for k, step in enumerate(shown):
        earlier = shown[k - 1] if k else 0
        tiles.append(
            state_image(
                task,
                poses[step],
                pixels=300,
                trail=poses[earlier : step + 1, 0, :2],
                caption="start" if step == 0 else f"{step}",
                reached=success and step == last,
            )
        )
    gap = 6
    columns = min(columns, len(tiles))
    rows = -(-len(tiles) // columns)
    side = tiles[0].shape[0]
    sheet = np.full(
        (rows * side + (rows - 1) * gap, columns * side + (columns - 1) * gap, 3), 255, np.uint8
    )
    sheet[:] = PAPER
    for k, tile in enumerate(tiles):
        y, x = (side + gap) * (k // columns), (side + gap) * (k % columns)
        sheet[y : y + side, x : x + side] = tile
    Image.fromarray(sheet).save(path)


def film(path: Path, task: TaskLike, poses: Floats, success: bool) -> None:
    """An animated GIF of the pushes. poses [T+1, bodies, 3]."""
    last = len(poses) - 1
    frames, durations = [], []

    def add(state: Floats, step: int, milliseconds: int, reached: bool = False) -> None:
        trail = np.vstack([poses[max(0, step - 3) : step + 1, 0, :2], state[0, :2]])
        picture = state_image(task, state, trail=trail, caption=f"{step}", reached=reached)
        frames.append(Image.fromarray(picture))
        durations.append(milliseconds)

    add(poses[0], 0, _HOLD_MS)
    for step in range(last):
        for frame in range(1, _FRAMES_PER_PUSH + 1):
            state = between(poses[step], poses[step + 1], frame / _FRAMES_PER_PUSH)
            add(state, step, _FRAME_MS)
    add(poses[last], last, 2 * _HOLD_MS, reached=success)
    palette = frames[-1].quantize(64)
    reduced = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    reduced[0].save(
        path, save_all=True, append_images=reduced[1:], duration=durations, loop=0, optimize=True
    )
