"""Draws one state of a task: bodies, joints and the regions of the goal."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageColor, ImageDraw, ImageFont

Floats = NDArray[np.float64]
Colour = tuple[int, int, int]

PAPER: Colour = (252, 251, 248)
INK: Colour = (43, 48, 58)
FAINT: Colour = (222, 220, 213)
WALL: Colour = (178, 176, 170)
ROBOT: Colour = (62, 70, 86)
GOAL: Colour = (92, 160, 112)
AVOID: Colour = (190, 60, 60)
TRAIL: Colour = (150, 156, 168)
KIND_PALETTE: tuple[Colour, ...] = (
    (226, 149, 72),
    (74, 126, 187),
    (158, 106, 178),
    (200, 92, 92),
    (96, 160, 160),
)
_DISTINCT = 80.0  # least distance of two colours that are told apart, of levels up to 255
GREY_LEVEL = 160
_BAND = 0.13  # height of the band of a caption, in half sides of the window
OVERSAMPLING = 3  # pictures are drawn this many times larger, then reduced


class MarkLike(Protocol):
    """The properties of a mark of the goal that drawing needs, as in rtg._core.GoalMark."""

    @property
    def kind(self) -> str: ...
    @property
    def ring(self) -> Floats: ...
    @property
    def target(self) -> bool: ...
    @property
    def negated(self) -> bool: ...


class TaskLike(Protocol):
    """The properties of a task that drawing needs, as in rtg._core.Task."""

    @property
    def outlines(self) -> Sequence[Sequence[Floats]]:
        """The outer ring of each body, then those of its holes, [V, 2] each."""

    @property
    def names(self) -> Sequence[str]: ...
    @property
    def kinds(self) -> Sequence[str]: ...
    @property
    def fixed(self) -> Sequence[bool]: ...
    @property
    def joints(self) -> Sequence[tuple[int, int, Sequence[Floats]]]:
        """The joints: (parent, child, pin or ends of the axis in the frame of the parent)."""

    @property
    def goal_marks(self) -> Sequence[MarkLike]: ...
    @property
    def start(self) -> Floats:
        """The nominal start, [bodies, 3]."""

    @property
    def arena(self) -> float: ...
    @property
    def metre(self) -> float: ...
    def moved(self, states: Floats, next_states: Floats) -> NDArray[np.bool_]: ...
    def joints_reached(self, states: Floats) -> Sequence[bool]: ...
    def body_marks(self, states: Floats) -> Sequence[MarkLike]: ...
    def joint_marks(self, states: Floats) -> Sequence[MarkLike]: ...
    def centroids(self, states: Floats) -> Sequence[Floats]: ...


def objects(task: TaskLike) -> list[int]:
    """Returns the indices of the bodies that can be pushed; body 0 is the robot."""
    return [body for body in range(1, len(task.kinds)) if not task.fixed[body]]


def kind_colours(task: TaskLike) -> dict[str, Colour]:
    """Returns a colour per kind of object; kinds are in order of first appearance.

    A kind with the name of a colour, such as "red", has a mild one of that. The others have those
    of KIND_PALETTE that can be told from them.
    """
    kinds = list(dict.fromkeys(task.kinds[body] for body in objects(task)))
    names = {kind: ImageColor.colormap.get(kind.lower()) for kind in kinds}
    named = {kind: _mild(ImageColor.getrgb(name)) for kind, name in names.items() if name}
    distinct = [
        colour
        for colour in KIND_PALETTE
        if all(math.dist(colour, taken) >= _DISTINCT for taken in named.values())
    ]
    palette = itertools.cycle(distinct or KIND_PALETTE)
    return {kind: named[kind] if kind in named else next(palette) for kind in kinds}


def _mild(colour: Sequence[int]) -> Colour:
    """Mixes a colour with the grey of GREY_LEVEL, so that outlines and marks stay visible on it."""
    red, green, blue = (round(0.7 * c + 0.3 * GREY_LEVEL) for c in colour[:3])
    return red, green, blue


def blend_with_paper(colour: Colour, share: float) -> Colour:
    """Mixes `colour`, with weight `share`, and PAPER."""
    red, green, blue = (
        round(share * c + (1.0 - share) * p) for c, p in zip(colour, PAPER, strict=True)
    )
    return red, green, blue


def outline(shape: Floats, pose: Floats) -> Floats:
    """Transforms the vertices of a body to world coordinates. shape [V, 2], pose [3] -> [V, 2]."""
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return np.asarray(shape) @ np.array([[c, s], [-s, c]]) + pose[:2]


class Window(NamedTuple):
    """A square part of the plane [m]."""

    x: float  # of the centre
    y: float  # of the centre
    half: float  # half the side

    def at(self, right: float, up: float) -> tuple[float, float]:
        """Returns the world coordinates of the point (`right`, `up`) of the window.

        (0, 0) is its centre; -1 and 1 are the edges.
        """
        return self.x + right * self.half, self.y + up * self.half


def arena_window(task: TaskLike) -> Window:
    """Returns the window that shows the whole arena with a margin."""
    return Window(0.0, 0.0, 1.06 * task.arena)


def episode_window(task: TaskLike, poses: Floats) -> Window:
    """Returns the window that shows all states of an episode and the smaller marks of the goal.

    Objects may lie outside the arena, which bounds the robot alone. poses [T, bodies, 3]
    """
    marks = [np.asarray(mark.ring) for mark in task.goal_marks]
    corners = [ring for ring in marks if np.abs(ring).max() <= 2.0 * task.arena]
    for body, rings in enumerate(task.outlines):
        reach = float(np.linalg.norm(rings[0], axis=1).max())
        corners += [poses[:, body, :2] - reach, poses[:, body, :2] + reach]
    points = np.concatenate(corners)
    low, high = points.min(axis=0), points.max(axis=0)
    x, y = (low + high) / 2.0
    return Window(float(x), float(y), 0.53 * float((high - low).max()) + 0.4)


def below_caption(window: Window) -> Window:
    """Returns `window` and a margin, with the band of a caption above it. See draw_state()."""
    half = window.half / (1.0 - _BAND / 2.0)
    return Window(window.x, window.y + half - window.half, half)


class Surface(Protocol):
    """A square picture of `window`, with y upwards. Coordinates are in the world frame [m]."""

    window: Window

    def polygon(self, xy: Any, fill: Colour, edge: Colour) -> None:
        """Draws a filled polygon with an outline."""

    def line(self, xy: Any, colour: Colour, width: float) -> None:
        """Draws a polyline of `width` [m]."""

    def dot(self, xy: Any, colour: Colour, radius: float) -> None:
        """Draws a disc of `radius` [m]."""

    def text(self, xy: Any, words: str, size: float) -> None:
        """Draws `words` with their upper left corner at `xy`. `size`: font size [m]."""


class Canvas:
    """A Surface of pixels."""

    def __init__(self, window: Window, pixels: int) -> None:
        self.window = window
        self._side = pixels * OVERSAMPLING
        self._scale = self._side / (2.0 * window.half)  # [pixel/m]
        self._image = Image.new("RGB", (self._side, self._side), PAPER)

    def _points(self, xy: Any) -> list[tuple[float, float]]:
        points = np.atleast_2d(np.asarray(xy, dtype=float))
        x = (points[:, 0] - self.window.x + self.window.half) * self._scale
        y = (self.window.half + self.window.y - points[:, 1]) * self._scale
        return list(zip(x.tolist(), y.tolist(), strict=True))

    def polygon(self, xy: Any, fill: Colour, edge: Colour) -> None:
        ImageDraw.Draw(self._image).polygon(self._points(xy), fill=fill)
        self.line(np.vstack([np.atleast_2d(xy), np.atleast_2d(xy)[:2]]), edge, 0.07)

    def line(self, xy: Any, colour: Colour, width: float) -> None:
        pixels = max(1, round(width * self._scale))
        ImageDraw.Draw(self._image).line(self._points(xy), fill=colour, width=pixels, joint="curve")

    def dot(self, xy: Any, colour: Colour, radius: float) -> None:
        (x, y), r = self._points(xy)[0], radius * self._scale
        ImageDraw.Draw(self._image).ellipse((x - r, y - r, x + r, y + r), fill=colour)

    def text(self, xy: Any, words: str, size: float) -> None:
        font = ImageFont.load_default(size=size * self._scale)
        ImageDraw.Draw(self._image).text(self._points(xy)[0], words, fill=INK, font=font)

    def pixels(self) -> NDArray[np.uint8]:
        """Returns the picture in its final size. [height, width, 3]"""
        return np.asarray(self._image.reduce(OVERSAMPLING))


def _area(ring: Floats) -> float:
    x, y = np.asarray(ring).T
    return abs(float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))) / 2.0


def mark_colour(task: TaskLike, mark: MarkLike) -> Colour:
    """Returns the colour of the edge of a mark: that of its kind, AVOID if the term is negated."""
    return AVOID if mark.negated else kind_colours(task).get(mark.kind, GOAL)


def mark_fill(task: TaskLike, mark: MarkLike, reached: bool = False) -> Colour:
    """Returns the colour of the area of a mark, darker if `reached`."""
    return blend_with_paper(mark_colour(task, mark), 0.38 if reached else 0.18)


def large_first(marks: Sequence[MarkLike]) -> list[MarkLike]:
    """Returns the marks in the order of drawing: small ones lie on top of large ones."""
    return sorted(marks, key=lambda mark: -_area(mark.ring))


def draw_goal(
    canvas: Surface, task: TaskLike, marks: Sequence[MarkLike], reached: bool = False
) -> None:
    """Draws the marks of a goal, darker if `reached`."""
    for mark in large_first(marks):
        fill = mark_fill(task, mark, reached)
        canvas.polygon(mark.ring, fill, edge=mark_colour(task, mark))


def draw_joint_goals(canvas: Surface, task: TaskLike, poses: Floats) -> None:
    """Draws where the goal asks for the children of joints, as seen from their parents.

    The area is that of all values that are allowed, the outlines are at the ends of their range.
    poses [bodies, 3]
    """
    marks = task.joint_marks(poses[None])
    for mark in marks:
        fill = mark_fill(task, mark)
        canvas.polygon(mark.ring, fill, edge=fill)
    for mark in marks:
        if mark.target:
            canvas.line(np.vstack([mark.ring, mark.ring[:2]]), mark_colour(task, mark), 0.07)


def draw_bodies(canvas: Surface, task: TaskLike, poses: Floats) -> None:
    """Draws all bodies: walls first, the robot last and on top. poses [bodies, 3]."""
    colours = kind_colours(task)

    def draw(body: int, colour: Colour) -> None:
        outer, *holes = task.outlines[body]
        canvas.polygon(outline(outer, poses[body]), colour, edge=INK)
        for hole in holes:
            canvas.polygon(outline(hole, poses[body]), PAPER, edge=INK)

    for body in range(1, len(task.kinds)):
        if task.fixed[body]:
            draw(body, WALL)
    for body in objects(task):
        draw(body, colours[task.kinds[body]])
        canvas.dot(poses[body][:2], INK, 0.08)
    draw(0, ROBOT)


def draw_joints(canvas: Surface, task: TaskLike, poses: Floats) -> None:
    """Draws pins and axes of joints, and a cross at each mean centre that the goal constrains.

    A pin has the colour GOAL if the goal constrains the joint's value and the value complies.
    poses [bodies, 3]
    """
    reached = task.joints_reached(poses[None])
    for (parent, child, points), right in zip(task.joints, reached, strict=True):
        if not points:
            continue
        at = outline(np.asarray(points), poses[parent])
        if len(points) == 2:
            canvas.line(at, INK, 0.06)
        pin = at[0] if len(points) == 1 else poses[child][:2]
        canvas.dot(pin, INK, 0.24)
        canvas.dot(pin, GOAL if right else PAPER, 0.17)
    for x, y in task.centroids(poses[None]):
        canvas.line([(x - 0.25, y), (x + 0.25, y)], INK, 0.09)
        canvas.line([(x, y - 0.25), (x, y + 0.25)], INK, 0.09)


def draw_former_outlines(canvas: Surface, task: TaskLike, before: Floats, poses: Floats) -> None:
    """Draws the outlines in state `before` of objects that have moved. [bodies, 3] each

    `poses`: the current state.
    """
    colours = kind_colours(task)
    for body in objects(task):
        if np.abs(poses[body] - before[body]).max() > 0.02:
            xy = outline(task.outlines[body][0], before[body])
            canvas.line(np.vstack([xy, xy[:2]]), colours[task.kinds[body]], 0.06)


class Tile(NamedTuple):
    """A state to be drawn in a sheet of them, see draw_state()."""

    path: Floats  # [T, bodies, 3]
    caption: str
    reached: bool = False


def draw_state(
    canvas: Surface,
    task: TaskLike,
    path: Floats,
    *,
    caption: str = "",
    reached: bool = False,
    marks: Sequence[MarkLike] | None = None,
) -> None:
    """Draws the last state of `path` [T, bodies, 3].

    The picture also shows the way of the robot along `path` and the outlines of the objects in its
    first state. `reached` marks a success. `marks`: those of the goal; the task's own if None.
    A caption stands on a band over the upper edge, where the canvas has to have room for it, as
    below_caption() makes it.
    """
    path = np.asarray(path, dtype=float)
    a = task.arena
    draw_goal(canvas, task, task.goal_marks if marks is None else marks, reached)
    if marks is None:
        draw_goal(canvas, task, task.body_marks(path[-1:]), reached)
    draw_joint_goals(canvas, task, path[-1])
    canvas.line([(-a, -a), (a, -a), (a, a), (-a, a), (-a, -a)], FAINT, 0.06)
    if len(path) > 1:
        draw_former_outlines(canvas, task, path[0], path[-1])
        canvas.line(path[:, 0, :2], TRAIL, 0.1)
    draw_bodies(canvas, task, path[-1])
    draw_joints(canvas, task, path[-1])
    if caption:
        _draw_caption(canvas, caption)


def _draw_caption(canvas: Surface, caption: str) -> None:
    at = canvas.window.at
    low = 1.0 - _BAND
    canvas.polygon([at(-1.0, low), at(1.0, low), at(1.0, 1.0), at(-1.0, 1.0)], PAPER, edge=PAPER)
    canvas.text(at(-0.96, 0.98), caption, size=0.09 * canvas.window.half)


def state_image(
    task: TaskLike,
    path: Floats,
    *,
    window: Window | None = None,
    pixels: int = 360,
    caption: str = "",
    reached: bool = False,
    marks: Sequence[MarkLike] | None = None,
) -> NDArray[np.uint8]:
    """Returns the picture of draw_state() as RGB [pixels, pixels, 3].

    It shows `window`, by default the whole arena; with a caption, below that.
    """
    window = window or arena_window(task)
    canvas = Canvas(below_caption(window) if caption else window, pixels)
    draw_state(canvas, task, path, caption=caption, reached=reached, marks=marks)
    return canvas.pixels()
