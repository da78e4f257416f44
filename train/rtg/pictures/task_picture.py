"""A picture of a task: states in which episodes start, and goal states."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from rtg import _core
from rtg.errors import UserError
from rtg.pictures.draw import Canvas, arena_window, state_image
from rtg.pictures.episode_pictures import heading, sheet

_COLUMNS = 4
_SIDE = 300  # of a state [pixel]
_SEED = 1


def _title(task: _core.Task) -> str:
    words = (
        f"{task.name}: starts and goal states; frames are {2 * task.arena / task.metre:g} m wide"
    )
    if task.joint_marks(task.start[None]):
        words += "; pale: where joints are to stand"
    kinds = sorted({mark.kind for mark in task.goal_marks if mark.negated})
    avoided = ", ".join("any object" if kind == "*" else f"'{kind}'" for kind in kinds)
    return f"{words}; red: where {avoided} must not lie" if kinds else words


def draw(path: Path, config: _core.Config) -> None:
    """Writes a row of starts, the nominal one first, and a row of goal states before they settle.

    Raises UserError if the file cannot be written or has no known format.
    """
    task = config.task
    drawn = [task.jittered_start(config.evaluation_jitter, _SEED, k) for k in range(_COLUMNS - 1)]
    goals = [task.goal_state(_SEED, k) for k in range(_COLUMNS)]
    captions = ["start", *["a start"] * (_COLUMNS - 1)]
    tiles = [
        state_image(task, state[None], canvas=Canvas(arena_window(task), _SIDE), caption=caption)
        for state, caption in zip([task.start, *drawn], captions, strict=True)
    ]
    tiles += [
        state_image(
            task,
            state[None],
            canvas=Canvas(arena_window(task), _SIDE),
            caption="a goal state",
            reached=True,
        )
        for state in goals
        if state is not None
    ]
    picture = sheet(tiles, _COLUMNS)
    title = heading(_title(task), picture.shape[1])
    try:
        Image.fromarray(np.concatenate([title, picture])).save(path)
    except ValueError:
        raise UserError(
            f"--picture: {path}: has no known ending; legal: .png, .jpg, .pdf, .gif"
        ) from None
    except OSError as error:
        raise UserError(
            f"--picture: {path}: {error.strerror}; legal: a file that can be written"
        ) from None
