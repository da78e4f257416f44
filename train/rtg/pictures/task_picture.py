"""A picture of a task: states in which episodes start, and goal states."""

from __future__ import annotations

from pathlib import Path

from rtg import _core
from rtg.errors import UserError
from rtg.pictures.draw import Tile, arena_window
from rtg.pictures.episode_pictures import write_sheet

_COLUMNS = 4
_SEED = 1


def _title(task: _core.Task) -> str:
    words = (
        f"{task.name}: starts and goal states; frames are {2 * task.arena / task.metre:g} m wide"
    )
    if task.joint_marks(task.start[None]):
        words += "; pale: where joints are to stand"
    marks = [*task.goal_marks, *task.body_marks(task.start[None])]
    kinds = sorted({mark.kind for mark in marks if mark.negated})
    avoiding = " or by ".join("any object" if kind == "*" else f"'{kind}'" for kind in kinds)
    return f"{words}; red: to be avoided by {avoiding}" if kinds else words


def draw(path: Path, config: _core.Config) -> None:
    """Writes a row of starts, the nominal one first, and a row of goal states before they settle.

    Raises UserError if the file cannot be written or has no known format.
    """
    task = config.task
    jitter = config.evaluation_jitter
    tiles = [Tile(task.start[None], "start")]
    for k in range(_COLUMNS - 1):
        tiles.append(Tile(task.jittered_start(jitter, _SEED, k)[None], "a start"))
    title = _title(task)
    for k in range(_COLUMNS):
        state = task.goal_state(_SEED, k)
        if state is None:
            title += f"; no goal state {k + 1}: {task.why_no_goal_state(_SEED, k)}"
        else:
            tiles.append(Tile(state[None], "a goal state", reached=True))
    try:
        write_sheet(path, task, arena_window(task), tiles, _COLUMNS, title)
    except ValueError:
        raise UserError(
            f"--picture: {path}: has no known ending; legal: .png, .jpg, .pdf, .svg, .gif"
        ) from None
    except OSError as error:
        raise UserError(
            f"--picture: {path}: {error.strerror}; legal: a file that can be written"
        ) from None
