"""The scene: arena, marks of the goal and bodies, which move along the time line.

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
    MarkLike,
    TaskLike,
    arena_window,
    kind_colours,
    large_first,
    mark_colour,
    mark_fill,
    outline,
)
from rtg.view.meshes import triangles

Floats = NDArray[np.float64]

TIME = "time"  # time line of all entities: [s] since the begin of the run
GOAL_HEIGHT, MARK_HEIGHT, EDGE_HEIGHT = 0.0, 0.05, 0.09  # of marks: still, moving, their edges
WALL_HEIGHT, OBJECT_HEIGHT, ROBOT_HEIGHT = 0.1, 0.15, 0.2
CAPTION_HEIGHT = 0.3
_EDGE = 0.035  # half width of the outlines [m]
_LAYERS = 0.03  # heights of still marks above the first of them, and of moving ones [m]


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


def _log_edges(
    recording: rr.RecordingStream,
    path: str,
    rings: Sequence[Floats],
    colour: Colour,
    height: float,
) -> None:
    edges = [raised(closed(np.asarray(ring)), height) for ring in rings]
    strips = rr.LineStrips3D(edges, colors=[colour], radii=_EDGE)
    recording.log(f"{path}/edge", strips, static=True)


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
    for number, mark in enumerate(large_first(task.goal_marks)):
        ring = np.clip(np.asarray(mark.ring), -far, far)
        height = GOAL_HEIGHT + _LAYERS * number / len(task.goal_marks)
        path = f"scene/goal/{number}"
        _log_filled(recording, path, [ring], mark_fill(task, mark), height)
        _log_edges(recording, path, [ring], mark_colour(task, mark), EDGE_HEIGHT)


def _moving_marks(task: TaskLike, poses: Floats) -> tuple[Sequence[MarkLike], Sequence[MarkLike]]:
    """Returns the marks that go with bodies, and those that go with the parents of joints."""
    return task.body_marks(poses[None]), task.joint_marks(poses[None])


def _mark_path(number: int) -> str:
    return f"scene/marks/{number}"


def _log_moving_marks(recording: rr.RecordingStream, task: TaskLike) -> None:
    """Logs their shapes at the nominal start, from where log_poses() moves them.

    Of joints, the outlines at the ends of the range have an edge, as in pictures.
    """
    of_bodies, of_joints = _moving_marks(task, np.asarray(task.start))
    marks = [*of_bodies, *of_joints]
    order = large_first(marks)
    for number, mark in enumerate(marks):
        path, ring = _mark_path(number), np.asarray(mark.ring)
        height = MARK_HEIGHT + _LAYERS * order.index(mark) / len(marks)
        _log_filled(recording, path, [ring], mark_fill(task, mark), height)
        if mark.target or number < len(of_bodies):
            _log_edges(recording, path, [ring], mark_colour(task, mark), EDGE_HEIGHT)


def motion(ring: Floats, moved: Floats) -> Floats:
    """Returns the poses that take a ring to where it has been moved. [V, 2], [T, V, 2] -> [T, 3]"""
    before, after = ring @ (1.0, 1j), moved @ (1.0, 1j)  # points as complex numbers
    centre, centres = before.mean(), after.mean(axis=1)
    turned = ((after - centres[:, None]) * (before - centre).conj()).sum(axis=1)
    origins = centres - centre * turned / np.abs(turned)
    return np.stack([origins.real, origins.imag, np.angle(turned)], axis=1)


def log_scene(recording: rr.RecordingStream, task: TaskLike) -> None:
    """Logs what does not change: arena, goal and the shapes of all bodies."""
    a = task.arena
    corners = np.array([[-a, -a], [a, -a], [a, a], [-a, a]])
    recording.log(
        "scene/arena",
        rr.LineStrips3D([raised(closed(corners), EDGE_HEIGHT)], colors=[TRAIL], radii=0.04),
        static=True,
    )
    _log_goal(recording, task)
    _log_moving_marks(recording, task)
    for body, rings in enumerate(task.outlines):
        colour, height = _body_colour(task, body)
        _log_filled(recording, body_path(task, body), rings, colour, height)
        _log_edges(recording, body_path(task, body), rings, INK, height + 0.01)
    _log_joints(recording, task)
    edges = [raised(closed(outline(r[0], p)), OBJECT_HEIGHT) for r, p in _starts(task)]
    recording.log(
        "starts", rr.LineStrips3D(edges, colors=[INK], radii=rr.Radius.ui_points(0.6)), static=True
    )


def _starts(task: TaskLike) -> list[tuple[Sequence[Floats], Floats]]:
    return list(zip(task.outlines, task.start, strict=True))


def _log_motion(recording: rr.RecordingStream, path: str, times: Floats, poses: Floats) -> None:
    half = poses[:, 2] / 2.0
    zero = np.zeros_like(half)
    recording.send_columns(
        path,
        indexes=[rr.TimeColumn(TIME, duration=times)],
        columns=rr.Transform3D.columns(
            translation=raised(poses[:, :2], 0.0),
            quaternion=np.stack([zero, zero, np.sin(half), np.cos(half)], axis=1),
        ),
    )


def log_poses(recording: rr.RecordingStream, task: TaskLike, times: Floats, states: Floats) -> None:
    """Moves the bodies, and the marks that go with them. times [T] in s, states [T, bodies, 3]"""
    for body in range(len(task.names)):
        _log_motion(recording, body_path(task, body), times, states[:, body])
    start, *later = (
        [np.asarray(mark.ring) for marks in _moving_marks(task, poses) for mark in marks]
        for poses in (np.asarray(task.start), *states)
    )
    for number, (ring, *moved) in enumerate(zip(start, *later, strict=True)):
        _log_motion(recording, _mark_path(number), times, motion(ring, np.stack(moved)))


def log_caption(recording: rr.RecordingStream, task: TaskLike, at: float, words: str) -> None:
    """Writes `words` above the arena from time `at` [s] on."""
    recording.set_time(TIME, duration=at)
    place = raised(np.array([[0.0, 1.2 * task.arena]]), CAPTION_HEIGHT)
    recording.log("caption", rr.Points3D(place, labels=[words], colors=[INK], radii=0.01))
