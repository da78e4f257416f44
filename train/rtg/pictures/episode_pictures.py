"""Pictures of one episode: a strip (a sequence of its states) and a film."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from rtg.pictures.draw import (
    FAINT,
    INK,
    OVERSAMPLING,
    PAPER,
    TaskLike,
    Tile,
    Window,
    episode_window,
    kind_colours,
    state_image,
)

Floats = NDArray[np.float64]
Picture = NDArray[np.uint8]  # [height, width, 3]

_COLUMNS = 5  # largest number of columns of a strip
_FRAMES_PER_PUSH = 8  # largest number; long episodes have fewer
_FRAMES = 160  # approximate length of a film
_TILE_SIDE = 300  # of a state in a sheet [pixel]
_FILM_SIDE = 360  # [pixel]
_FRAME_MS = 45
_HOLD_MS = 1200  # at the start; twice as long at the end


def interpolate(task: TaskLike, before: Floats, after: Floats, share: float) -> Floats:
    """Interpolates between the states `before` and `after` a push. [bodies, 3]

    `share`: elapsed share of the push. The robot moves at constant speed. An object rests until the
    remaining push is as long as the path of the object. Then it moves as fast as the robot. Bodies
    connected by joints begin to move together. This is exact if the robot pushes objects straight
    ahead, else an approximation.
    """
    path_lengths = np.linalg.norm(after[:, :2] - before[:, :2], axis=1)  # [bodies]
    for _ in task.joints:  # the longest path spreads along every chain of joints
        for parent, child, _ in task.joints:
            path_lengths[[parent, child]] = max(path_lengths[parent], path_lengths[child])
    push_length = max(float(path_lengths[0]), 1e-9)
    moving_share = np.clip(path_lengths / push_length, 1e-9, 1.0)  # at the end of the push
    progress = np.clip((share - (1.0 - moving_share)) / moving_share, 0.0, 1.0)
    progress[0] = share
    return before + (after - before) * progress[:, None]


def heading(title: str, width: int) -> Picture:
    """Draws `title` as a line of text, as large as fits into `width` pixels."""
    largest = 18.0 * OVERSAMPLING  # [pixel]
    length = ImageFont.load_default(size=largest).getlength(title)
    size = min(largest, largest * 0.95 * width * OVERSAMPLING / length)
    band = Image.new("RGB", (width * OVERSAMPLING, round(1.5 * largest)), PAPER)
    font = ImageFont.load_default(size=size)
    place = (0.4 * size, 0.75 * largest)
    ImageDraw.Draw(band).text(place, title, fill=INK, font=font, anchor="lm")
    return np.asarray(band.reduce(OVERSAMPLING))


def key(task: TaskLike, width: int) -> Picture:
    """Draws a swatch and the name of each kind of object, in lines that fit into `width`.

    [height, width, 3], in pixels; the height is 0 without objects.
    """
    colours = kind_colours(task)
    if not colours:
        return np.empty((0, width, 3), np.uint8)
    largest, whole = 14.0 * OVERSAMPLING, width * OVERSAMPLING  # [pixel]
    font = ImageFont.load_default(size=largest)
    letters = {kind: font.getlength(kind) / largest + 2.5 for kind in colours}  # 2.5: the swatch
    size = min(largest, whole / max(letters.values()))
    places, x, row = [], 0.0, 0
    for kind, length in letters.items():
        if x and x + size * length > whole:
            x, row = 0.0, row + 1
        places.append((kind, x + 0.5 * size, (1.5 * row + 0.75) * largest))
        x += size * length
    band = Image.new("RGB", (whole, round(1.5 * (row + 1) * largest)), PAPER)
    pen, font = ImageDraw.Draw(band), ImageFont.load_default(size=size)
    for kind, x, middle in places:
        corners = (x, middle - 0.4 * size, x + 0.8 * size, middle + 0.4 * size)
        pen.rectangle(corners, fill=colours[kind], outline=INK, width=OVERSAMPLING)
        pen.text((x + 1.2 * size, middle), kind, fill=INK, font=font, anchor="lm")
    return np.asarray(band.reduce(OVERSAMPLING))


def write_sheet(
    path: Path, task: TaskLike, window: Window, tiles: list[Tile], columns: int, title: str
) -> None:
    """Writes the tiles row by row, below the title and above the key of kinds.

    PDF and SVG are drawn by vectors. Raises ValueError for a file name of no known ending, OSError
    if the file cannot be written.
    """
    if path.suffix.lower() in (".pdf", ".svg"):
        from rtg.pictures import vectors  # imports matplotlib

        vectors.write(path, task, window, tiles, columns, title)
        return
    pictures = [
        state_image(
            task,
            tile.path,
            window=window,
            pixels=_TILE_SIDE,
            caption=tile.caption,
            reached=tile.reached,
        )
        for tile in tiles
    ]
    picture = sheet(pictures, columns)
    width = picture.shape[1]
    whole = np.concatenate([heading(title, width), picture, key(task, width)])
    Image.fromarray(whole).save(path)


def strip(path: Path, task: TaskLike, poses: Floats, success: bool, title: str) -> None:
    """Writes a picture of up to ten states of an episode, from the first to the last.

    poses [T+1, bodies, 3]
    """
    last = len(poses) - 1
    shown = np.unique(np.linspace(0, last, min(last + 1, 2 * _COLUMNS)).round().astype(int))
    tiles = []
    for k, step in enumerate(shown):
        earlier = shown[k - 1] if k else 0
        caption = "start" if step == 0 else f"{step}"
        tiles.append(Tile(poses[earlier : step + 1], caption, success and step == last))
    window = episode_window(task, poses)
    write_sheet(path, task, window, tiles, min(_COLUMNS, len(tiles)), title)


def sheet(tiles: list[Picture], columns: int) -> Picture:
    """Arranges the tiles row by row, with thin lines between them."""
    line, side = 2, tiles[0].shape[0]
    rows = -(-len(tiles) // columns)
    size = ((side + line) * rows - line, (side + line) * columns - line)
    whole = np.empty((*size, 3), np.uint8)
    whole[:] = FAINT
    for k in range(rows * columns):
        y, x = (side + line) * (k // columns), (side + line) * (k % columns)
        whole[y : y + side, x : x + side] = tiles[k] if k < len(tiles) else PAPER
    return whole


def film(path: Path, task: TaskLike, poses: Floats, success: bool, title: str) -> None:
    """Writes an animated GIF of an episode. poses [T+1, bodies, 3]."""
    last = len(poses) - 1
    window = episode_window(task, poses)
    above, below = heading(title, _FILM_SIDE), key(task, _FILM_SIDE)
    frames, durations = [], []
    per_push = min(_FRAMES_PER_PUSH, max(2, _FRAMES // max(1, last)))

    def add(state: Floats, step: int, milliseconds: int, reached: bool = False) -> None:
        shown = np.concatenate([poses[max(0, step - 3) : step + 1], state[None]])
        shown[:-1, 1:] = state[1:]  # no outlines of earlier places: the film shows the motion
        side, caption = _FILM_SIDE, f"{step}"
        picture = state_image(
            task, shown, window=window, pixels=side, caption=caption, reached=reached
        )
        frames.append(Image.fromarray(np.concatenate([above, picture, below])))
        durations.append(milliseconds)

    add(poses[0], 0, _HOLD_MS)
    for step in range(last):
        for frame in range(1, per_push + 1):
            state = interpolate(task, poses[step], poses[step + 1], frame / per_push)
            add(state, step, _FRAME_MS)
    add(poses[last], last, 2 * _HOLD_MS, reached=success)
    pair = _side_by_side(frames[len(frames) // 2], frames[-1])  # has all colours of the film
    palette = pair.quantize(64, Image.Quantize.MAXCOVERAGE)  # keeps faint colours distinct
    reduced = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    reduced[0].save(
        path, save_all=True, append_images=reduced[1:], duration=durations, loop=0, optimize=True
    )


def _side_by_side(left: Image.Image, right: Image.Image) -> Image.Image:
    return Image.fromarray(np.concatenate([np.asarray(left), np.asarray(right)], axis=1))
