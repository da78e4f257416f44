"""The growing trees: moves of each object, coloured by the number of steps to success."""

from __future__ import annotations

import matplotlib
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from rtg.pictures.draw import GREY_LEVEL, INK, TaskLike, objects, outline
from rtg.view.scene import CAPTION_HEIGHT, TIME, closed, raised
from rtg.view.step_tree import StepTree

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Colours = NDArray[np.uint8]

_WIDTH = 1.2  # of a step, in pixels
_LEGEND = 5  # number of depths in the legend
_LOWEST, _HIGHEST = 0.2, 0.3  # heights of the steps of depth 0 and of the deepest, above the goal


def tree_path(task: TaskLike, body: int) -> str:
    """Returns the path of the entity with the steps that move a body."""
    return f"trees/{task.names[body]}"


def depth_colours(depths: Ints, deepest: int) -> Colours:
    """Returns the colour of each depth, from 1 to `deepest`; grey for 0, unknown. [N] -> [N, 3]

    The colours go with the square root, as few trees get as deep as they may.
    """
    scale = matplotlib.colormaps["viridis"]
    shares = np.sqrt(np.clip(depths - 1, 0, deepest - 1) / max(1, deepest - 1))
    colours: Colours = (255 * scale(shares)[:, :3]).astype(np.uint8)
    colours[depths == 0] = GREY_LEVEL
    return colours


def moves(task: TaskLike, tree: StepTree, steps: Ints) -> dict[int, Ints]:
    """Returns which of the `steps` move each object, as contact_share counts moves.

    Objects that none of them moves are left out.
    """
    moved = task.moved(tree.starts[steps], tree.ends[steps])
    return {body: steps[moved[:, body]] for body in objects(task) if moved[:, body].any()}


def lines(starts: Floats, ends: Floats, depths: Ints, deepest: int) -> Floats:
    """Returns moves of one body as lines. [N, 2], [N, 2], [N] -> [N, 2 ends, 3]

    The height grows with the depth, so that deep steps, which are fewer, lie on top.
    """
    found = raised(np.stack([starts, ends], axis=1), 0.0)
    shares = np.minimum(depths, deepest) / deepest
    found[:, :, 2] = (_LOWEST + (_HIGHEST - _LOWEST) * shares)[:, None]
    return found


def log_steps(
    recording: rr.RecordingStream,
    task: TaskLike,
    at: float,
    tree: StepTree,
    steps: Ints,
    deepest: int,
) -> None:
    """Shows `steps` of the tree from time `at` [s] on. `deepest` has the last colour."""
    recording.set_time(TIME, duration=at)
    for body, moved in moves(task, tree, steps).items():
        starts, ends = tree.starts[moved, body, :2], tree.ends[moved, body, :2]
        depths = tree.depths[moved]
        recording.log(
            tree_path(task, body),
            rr.LineStrips3D(
                lines(starts, ends, depths, deepest),
                colors=depth_colours(depths, deepest),
                radii=rr.Radius.ui_points(_WIDTH / 2),
            ),
        )


def log_legend(recording: rr.RecordingStream, task: TaskLike, deepest: int) -> None:
    """Logs dots with the colours of some depths, above the arena, and the start of each object."""
    shares = np.linspace(0.0, 1.0, _LEGEND)
    depths = np.unique((1.0 + (deepest - 1) * shares**2).round().astype(np.int64))
    places = np.full((len(depths), 2), 1.2 * task.arena)
    places[:, 0] = np.linspace(-0.8, 0.8, len(depths)) * task.arena
    dots = raised(places, CAPTION_HEIGHT)
    colours, radius = depth_colours(depths, deepest), rr.Radius.ui_points(6.0)
    recording.log("legend", rr.Points3D(dots, colors=colours, radii=radius), static=True)
    words = [str(depth) for depth in depths]
    texts = rr.Points3D(dots, labels=words, show_labels=True, colors=[INK], radii=0.0)
    recording.log("legend/words", texts, static=True)
    for body in objects(task):
        edge = raised(closed(outline(task.outlines[body][0], task.start[body])), CAPTION_HEIGHT)
        recording.log(
            f"start/{task.names[body]}",
            rr.LineStrips3D([edge], colors=[INK], radii=rr.Radius.ui_points(1.5)),
            static=True,
        )
