"""Sheets of states as vector graphics: PDF or SVG."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch
from matplotlib.patches import Polygon as Area

from rtg.pictures.draw import (
    FAINT,
    INK,
    PAPER,
    Colour,
    TaskLike,
    Tile,
    Window,
    below_caption,
    draw_state,
    kind_colours,
)

SUFFIXES = (".pdf", ".svg")
_SIDE = 3.0  # of a state [inch]
_BAND = 0.3  # above the states, for the title, and below, for the key [inch]
_TITLE = 10.0  # size of its letters, or less to fit [point]
_POINTS = 72.0  # per inch


def _rgb(colour: Colour) -> tuple[float, float, float]:
    red, green, blue = (c / 255 for c in colour)
    return red, green, blue


class VectorCanvas:
    """A Surface of shapes on `axes`, which are _SIDE wide."""

    def __init__(self, axes: Axes, window: Window) -> None:
        self.window = window
        self._axes = axes
        self._points = _SIDE * _POINTS / (2.0 * window.half)  # per metre
        axes.set_xlim(window.x - window.half, window.x + window.half)
        axes.set_ylim(window.y - window.half, window.y + window.half)
        axes.set_xticks([])
        axes.set_yticks([])
        for spine in axes.spines.values():
            spine.set_color(_rgb(FAINT))
        self._drawn = 0  # the order of drawing rules, whatever the kind of shape

    def _add(self, shape: Any) -> None:
        shape.set_zorder(self._drawn)
        shape.set_clip_on(True)
        self._drawn += 1
        self._axes.add_artist(shape)

    def polygon(self, xy: Any, fill: Colour, edge: Colour) -> None:
        width = 0.07 * self._points
        self._add(Area(np.asarray(xy), fc=_rgb(fill), ec=_rgb(edge), lw=width, joinstyle="round"))

    def line(self, xy: Any, colour: Colour, width: float) -> None:
        x, y = np.atleast_2d(np.asarray(xy, dtype=float)).T
        joint: Any = {"solid_joinstyle": "round", "solid_capstyle": "butt"}
        self._add(Line2D(x, y, color=_rgb(colour), lw=width * self._points, **joint))

    def dot(self, xy: Any, colour: Colour, radius: float) -> None:
        x, y = np.asarray(xy, dtype=float).reshape(-1)[:2]
        self._add(Circle((float(x), float(y)), radius, fc=_rgb(colour), lw=0.0))

    def text(self, xy: Any, words: str, size: float) -> None:
        x, y = xy
        place: Any = {"ha": "left", "va": "top", "zorder": self._drawn}
        self._axes.text(x, y, words, size=size * self._points, color=_rgb(INK), **place)


def write(
    path: Path, task: TaskLike, window: Window, tiles: Sequence[Tile], columns: int, title: str
) -> None:
    """Writes the tiles row by row, below the title and above the key of kinds.

    Raises OSError if the file cannot be written.
    """
    rows = -(-len(tiles) // columns)
    width, height = _SIDE * columns, _SIDE * rows + 2.0 * _BAND
    figure = plt.figure(figsize=(width, height), facecolor=_rgb(PAPER))
    for k, tile in enumerate(tiles):
        low = height - _BAND - _SIDE * (k // columns + 1)
        place = (_SIDE * (k % columns) / width, low / height, _SIDE / width, _SIDE / height)
        axes = figure.add_axes(place, facecolor=_rgb(PAPER))
        canvas = VectorCanvas(axes, below_caption(window))
        draw_state(canvas, task, tile.path, caption=tile.caption, reached=tile.reached)
    middle = 1.0 - 0.5 * _BAND / height
    words = figure.text(0.01, middle, title, va="center", color=_rgb(INK), size=_TITLE)
    extent = words.get_window_extent()
    words.set_fontsize(_TITLE * min(1.0, 0.98 * figure.bbox.width / extent.width))
    key = [
        Patch(fc=_rgb(colour), ec=_rgb(INK), label=kind)
        for kind, colour in kind_colours(task).items()
    ]
    figure.legend(handles=key, loc="lower left", ncols=max(1, len(key)), frameon=False, fontsize=8)
    try:
        figure.savefig(path)
    finally:
        plt.close(figure)
