"""Pictures of one episode: a strip of its states and a film."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from rtg.draw import FAINT, PAPER, Canvas, TaskLike, episode_window, state_image

Floats = NDArray[np.float64]
Picture = NDArray[np.uint8]  # [height, width, 3]

_FRAMES_PER_PUSH = 8  # of a short episode
_FRAMES = 160  # in all, about
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
    window = episode_window(task, poses)
    tiles = []
    for k, step in enumerate(shown):
        earlier = shown[k - 1] if k else 0
        tiles.append(
            state_image(
                task,
                poses[earlier : step + 1],
                canvas=Canvas(window, 300),
                caption="start" if step == 0 else f"{step}",
                reached=success and step == last,
            )
        )
    _sheet(tiles, min(columns, len(tiles))).save(path)


def _sheet(tiles: list[Picture], columns: int) -> Image.Image:
    """The tiles row by row with thin lines between them."""
    line, side = 2, tiles[0].shape[0]
    rows = -(-len(tiles) // columns)
    size = ((side + line) * rows - line, (side + line) * columns - line)
    sheet = np.empty((*size, 3), np.uint8)
    sheet[:] = FAINT
    for k in range(rows * columns):
        y, x = (side + line) * (k // columns), (side + line) * (k % columns)
        sheet[y : y + side, x : x + side] = tiles[k] if k < len(tiles) else PAPER
    return Image.fromarray(sheet)


def film(path: Path, task: TaskLike, poses: Floats, success: bool) -> None:
    """An animated GIF of the pushes. poses [T+1, bodies, 3]."""
    last = len(poses) - 1
    window = episode_window(task, poses)
    frames, durations = [], []
    per_push = min(_FRAMES_PER_PUSH, max(2, _FRAMES // max(1, last)))

    def add(state: Floats, step: int, milliseconds: int, reached: bool = False) -> None:
        way = np.concatenate([poses[max(0, step - 3) : step + 1], state[None]])
        way[:-1, 1:] = state[1:]  # the film itself shows where the objects came from
        picture = state_image(task, way, canvas=Canvas(window), caption=f"{step}", reached=reached)
        frames.append(Image.fromarray(picture))
        durations.append(milliseconds)

    add(poses[0], 0, _HOLD_MS)
    for step in range(last):
        for frame in range(1, per_push + 1):
            state = between(poses[step], poses[step + 1], frame / per_push)
            add(state, step, _FRAME_MS)
    add(poses[last], last, 2 * _HOLD_MS, reached=success)
    palette = _side_by_side(frames[len(frames) // 2], frames[-1]).quantize(64)  # of all colours
    reduced = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    reduced[0].save(
        path, save_all=True, append_images=reduced[1:], duration=durations, loop=0, optimize=True
    )


def _side_by_side(left: Image.Image, right: Image.Image) -> Image.Image:
    return Image.fromarray(np.concatenate([np.asarray(left), np.asarray(right)], axis=1))
