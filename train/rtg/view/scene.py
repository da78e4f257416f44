"""The scene: arena, goal and bodies, which move along the time line.

The plane of the task is z = 0, seen from above. What is drawn later lies a little higher.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from rtg.pictures.draw import (
    INK,
    ROBOT,
    TRAIL,
    WALL,
    Colour,
    TaskLike,
    arena_window,
    blend_with_paper,
    kind_colours,
    mark_colour,
    outline,
)
from rtg.view.meshes import triangles

Floats = NDArray[np.float64]

TIME = "time"  # time line of all entities: [s] since the begin of the run
GOAL_HEIGHT, WALL_HEIGHT, OBJECT_HEIGHT, ROBOT_HEIGHT = 0.0, 0.1, 0.15, 0.2
CAPTION_HEIGHT = 0.3
_EDGE = 0.035  # half width of the outlines [m]
_GOAL_STRENGTH = 0.3  # as drawn in pictures, weight of the colour against that of the background


def raised(points: Floats, height: float) -> Floats:
    """Adds z = `height` to points of the plane. [..., 2] -> [..., 3]"""
    points = np.asarray(points, float)
    return np.concatenate([points, np.full((*points.shape[:-1], 1), height)], axis=-1)


def closed(ring: Floats) -> Floats:
    """Returns the ring with its first vertex also at its end. [V, 2] -> [V + 1, 2]"""
    return np.vstack([ring, ring[:1]])


def body_path(task: TaskLike, body: int) -> str:
    """Returns the path of the entity of a body."""
    return f"scene/bodies/{task.names[body]}"


def _log_filled(
    recording: rr.RecordingStream,
    path: str,
    rings: Sequence[Floats],
    colour: Colour,
    height: float,
) -> None:
    vertices, faces = triangles(rings)
    recording.log(
        path,
        rr.Mesh3D(
            vertex_positions=raised(vertices, height),
            triangle_indices=faces,
            vertex_colors=np.tile(np.array(colour, np.uint8), (len(vertices), 1)),
        ),
        static=True,
    )
    edges = [raised(closed(np.asarray(ring)), height + 0.01) for ring in rings]
    recording.log(f"{path}/edge", rr.LineStrips3D(edges, colors=[INK], radii=_EDGE), static=True)


def _body_colour(task: TaskLike, body: int) -> tuple[Colour, float]:
    """Returns the colour and the height of a body."""
    if body == 0:
        return ROBOT, ROBOT_HEIGHT
    if task.fixed[body]:
        return WALL, WALL_HEIGHT
    return kind_colours(task)[task.kinds[body]], OBJECT_HEIGHT


def _log_joints(recording: rr.RecordingStream, task: TaskLike) -> None:
    for number, (parent, _, points) in enumerate(task.joints):
        if not points:
            continue
        at = raised(np.asarray(points), ROBOT_HEIGHT)
        shown = (
            rr.Points3D(at, colors=[INK], radii=0.2)
            if len(at) == 1
            else rr.LineStrips3D([at], colors=[INK], radii=_EDGE)
        )
        recording.log(f"{body_path(task, parent)}/joint{number}", shown, static=True)


def _log_goal(recording: rr.RecordingStream, task: TaskLike) -> None:
    window = arena_window(task)
    far = 3.0 * window.half  # marks of half planes go on far beyond what is seen
    sizes = [np.ptp(np.asarray(mark.ring), axis=0).max() for mark in task.goal_marks]
    for number, place in enumerate(np.argsort(sizes)[::-1]):  # small ones on top of large ones
        mark = task.goal_marks[place]
        colour = blend_with_paper(mark_colour(task, mark), _GOAL_STRENGTH)
        ring = np.clip(np.asarray(mark.ring), -far, far)
        height = GOAL_HEIGHT + 0.01 * number
        _log_filled(recording, f"scene/goal/{number}", [ring], colour, height)


def log_scene(recording: rr.RecordingStream, task: TaskLike) -> None:
    """Logs what does not change: arena, goal and the shapes of all bodies."""
    a = task.arena
    corners = np.array([[-a, -a], [a, -a], [a, a], [-a, a]])
    recording.log(
        "scene/arena",
        rr.LineStrips3D([raised(closed(corners), 0.0)], colors=[TRAIL], radii=0.04),
        static=True,
    )
    _log_goal(recording, task)
    for body, rings in enumerate(task.outlines):
        colour, height = _body_colour(task, body)
        _log_filled(recording, body_path(task, body), rings, colour, height)
    _log_joints(recording, task)
    edges = [raised(closed(outline(r[0], p)), OBJECT_HEIGHT) for r, p in _starts(task)]
    recording.log("starts", rr.LineStrips3D(edges, colors=[INK], radii=_EDGE / 2), static=True)


def _starts(task: TaskLike) -> list[tuple[Sequence[Floats], Floats]]:
    return list(zip(task.outlines, task.start, strict=True))


def log_poses(recording: rr.RecordingStream, task: TaskLike, times: Floats, states: Floats) -> None:
    """Moves the bodies. times [T] in s, states [T, bodies, 3]"""
    for body in range(len(task.names)):
        half = states[:, body, 2] / 2.0
        zero = np.zeros_like(half)
        recording.send_columns(
            body_path(task, body),
            indexes=[rr.TimeColumn(TIME, duration=times)],
            columns=rr.Transform3D.columns(
                translation=raised(states[:, body, :2], 0.0),
                quaternion=np.stack([zero, zero, np.sin(half), np.cos(half)], axis=1),
            ),
        )


def log_caption(recording: rr.RecordingStream, task: TaskLike, at: float, words: str) -> None:
    """Writes `words` above the arena from time `at` [s] on."""
    recording.set_time(TIME, duration=at)
    place = raised(np.array([[0.0, 1.12 * task.arena]]), CAPTION_HEIGHT)
    recording.log("caption", rr.Points3D(place, labels=[words], colors=[INK], radii=0.01))
