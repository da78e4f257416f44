"""What is logged of scenes with walls, joints and several goals, and which colours trees have."""

import numpy as np
import pytest

pytest.importorskip("rerun", reason="the extra view is not installed")

import rerun as rr
import scaled
from recordings import read
from rtg import _core, paths
from rtg.files.dataset import Rows
from rtg.pictures.draw import GREY_LEVEL, KIND_PALETTE, WALL, mark_fill, outline
from rtg.view import scene, trees
from rtg.view.step_tree import StepTree


def logged(tmp_path, file, states=None):
    task = _core.Config.from_file(paths.CONFIG / file).task
    recording = rr.RecordingStream("test")
    recording.save(tmp_path / "scene.rrd")
    scene.log_scene(recording, task)
    if states is not None:
        scene.log_poses(recording, task, np.arange(float(len(states))), states)
    recording.flush()
    recording.disconnect()
    return task, read(tmp_path / "scene.rrd")


def colour(found, path):
    mesh = found[path][0]
    packed = mesh.values["vertex_colors"][0]
    return tuple(packed.to_bytes(4, "big")[:3])


def test_walls_and_objects_have_the_colours_of_the_pictures(tmp_path):
    task, found = logged(tmp_path, "examples/door.yaml")
    assert task.names[1:] == ["wall", "door", "crate"]
    shown = [colour(found, f"scene/bodies/{name}") for name in task.names[1:]]
    assert shown == [WALL, KIND_PALETTE[0], KIND_PALETTE[1]]


def test_a_joint_moves_with_its_parent(tmp_path):
    task, found = logged(tmp_path, "art_manip.yaml")
    for number, (parent, _, points) in enumerate(task.joints):
        (pin,) = found[f"scene/bodies/{task.names[parent]}/joint{number}"]
        assert np.allclose(pin.values["positions"][0][:2], points[0], atol=1e-5)


def test_each_goal_has_a_mark_and_small_ones_lie_on_top(tmp_path):
    task, found = logged(tmp_path, "sorting.yaml")
    marks = [path for path in found if path.startswith("scene/goal/") and "edge" not in path]
    assert len(marks) == len(task.goal_marks) == 2
    heights = [found[path][0].values["vertex_positions"][0][2] for path in sorted(marks)]
    assert heights == sorted(heights) and heights[0] < heights[1] < scene.WALL_HEIGHT


def moved(points, logged):
    """Returns points [V, 3] where a logged transform takes them. [V, 2]"""
    (translation,), ((*_, sine, cosine),) = (
        logged.values["translation"],
        logged.values["quaternion"],
    )
    return outline(
        np.array(points)[:, :2], np.array([*translation[:2], 2 * np.arctan2(sine, cosine)])
    )


@pytest.mark.parametrize("file", ["insert.yaml", "pack.yaml", "drawer.yaml", "art_manip.yaml"])
def test_marks_go_with_the_bodies_as_in_pictures(tmp_path, file):
    task = _core.Config.from_file(paths.CONFIG / file).task
    states = np.stack([np.array(task.start)] * 3)
    states[1, :, :2] += 0.5, -1.0
    states[2, :, 2] += 0.4
    task, found = logged(tmp_path, file, states)
    of_bodies = len(task.body_marks(states[:1]))
    expected = [[*task.body_marks(s[None]), *task.joint_marks(s[None])] for s in states]
    assert len(expected[0]) > 0
    for number in range(len(expected[0])):
        path = f"scene/marks/{number}"
        mesh, *frames = found[path]
        has_edge = number < of_bodies or expected[0][number].target
        assert (f"{path}/edge" in found) == has_edge
        assert colour(found, path) == mark_fill(task, expected[0][number])
        points = mesh.values["vertex_positions"]
        assert scene.GOAL_HEIGHT < points[0][2] < scene.WALL_HEIGHT
        for marks, frame in zip(expected, frames, strict=True):
            ring = marks[number].ring
            away = np.linalg.norm(moved(points, frame)[:, None] - ring[None], axis=2).min(axis=0)
            assert away.max() < 1e-4, "each corner of the mark is one of the mesh"


def test_the_colours_of_depths_begin_and_end_with_those_of_the_scale():
    shown = trees.depth_colours(np.array([1, 40, 99, 0]), deepest=40)
    assert shown[0].tolist() == [68, 1, 84]
    assert shown[1].tolist() == shown[2].tolist() == [253, 231, 36]
    assert shown[3].tolist() == [GREY_LEVEL] * 3


@pytest.mark.parametrize("scale", [1.0, 1 / 20])
def test_only_moves_are_shown(scale):
    task = scaled.gathering(scale).task
    poses = np.repeat(task.start[None], 3, axis=0)
    after = poses.copy()
    after[:, 2, 0] += 0.04, 0.06, 2.0
    after[2, 0, 0] += 2.0  # the robot is no object
    done, nothing = np.ones(3, bool), np.zeros(3)
    tree = StepTree(task.bodies)
    tree.add(Rows(poses, nothing, after, nothing, done, nothing))
    found = trees.moves(task, tree, np.array([0, 1, 2]))
    assert {body: steps.tolist() for body, steps in found.items()} == {2: [1, 2]}


def test_deep_steps_lie_on_top():
    ends = np.array([[0.06, 0.0], [0.0, 2.0]])
    lines = trees.lines(np.zeros((2, 2)), ends, np.array([2, 4]), deepest=4)
    assert np.allclose(lines[:, 1, :2], ends)
    assert scene.OBJECT_HEIGHT < lines[0, 0, 2] < lines[1, 0, 2]
