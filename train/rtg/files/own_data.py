"""Transitions of one's own: from arrays, or from a file of them, checked and stored in a run.

The file is a .npz with `states`, `actions`, `next_states` and, if wanted, `source`, or the
transitions.npz of another run; see docs/data.md.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rtg import _core, arguments
from rtg.errors import UserError
from rtg.files import dataset, row_digest, run_folder, versions
from rtg.files.chains import numbered
from rtg.files.dataset import Rows
from rtg.files.recorder import Recorder

Floats = NDArray[np.float64]

_NEEDED = ("states", "actions", "next_states")


class OwnData(NamedTuple):
    """Transitions that no search of the run has found."""

    rows: Rows
    origin: dict[str, Any]  # "format", "name" (None where there is no file), "sha256"


def in_task_units(task: _core.Task, states: ArrayLike, name: str = "states") -> Floats:
    """Returns states in metres as the core takes them. [N, bodies, 3] -> [N, bodies, 3]

    `name`: that of the argument. Raises ValueError for another shape, for numbers that are not
    finite, for fixed bodies off their places, and for others out of twice the arena, where they
    may be in poses that are not in metres.
    """
    return task.from_metres(arguments.numbers(name, states, (None, task.bodies, 3)), name)


def checked_rows(
    task: _core.Task, poses: Floats, actions: ArrayLike, next_poses: Floats, source: ArrayLike
) -> Rows:
    """Returns transitions for the learner; the task judges which succeed.

    Poses are in task units, [N, bodies, 3]. Raises ValueError for what is not legal.
    """
    action = arguments.indices("action", actions, task.actions)
    sources = arguments.indices("source", source, len(_core.SOURCES))
    lengths = {len(poses), len(next_poses), len(action), len(sources)}
    if len(lengths) != 1:
        raise ValueError(f"columns of {sorted(lengths)} transitions; legal: of equally many")
    if not len(action):
        raise ValueError("no transitions; legal: at least one")
    for name, states in (("states", poses), ("next_states", next_poses)):
        if not (legal := task.is_legal(states)).all():
            row = int(np.flatnonzero(~legal)[0])
            raise ValueError(
                f"{name}: row {row} is no state of the task: {task.defect(states[row : row + 1])}; "
                "legal: no bodies that overlap, none out of twice the arena, fixed bodies in their "
                "places"
            )
    success = task.succeeded(next_poses)
    return Rows(
        poses=poses,
        action=action.astype(np.int32),
        next_poses=next_poses,
        reward=success.astype(np.float32),
        terminated=success,
        source=sources.astype(np.int8),
    )


def rows_in_metres(
    task: _core.Task,
    states: ArrayLike,
    actions: ArrayLike,
    next_states: ArrayLike,
    source: ArrayLike,
) -> Rows:
    """Returns transitions for the learner. States are in metres, [N, bodies, 3].

    Raises ValueError for what is not legal.
    """
    poses, next_poses = in_task_units(task, states), in_task_units(task, next_states)
    return checked_rows(task, poses, actions, next_poses, source)


def file_of(path: Path) -> Path:
    """Returns the file of transitions that is meant: `path`, or that in the folder of a run."""
    return path / "transitions.npz" if path.is_dir() else path


def _arrays(file: Path) -> dict[str, NDArray[Any]] | None:
    """Reads `states`, `actions`, `next_states` and `source` (all 0 if absent) of a .npz.

    Returns None if it is the file of a run. Raises DatasetError if the file is none or lacks one of
    the arrays.
    """
    legal = f"a .npz of numpy with {', '.join(_NEEDED)}, or the transitions.npz of a run"
    found = dataset.read_arrays(file, (*_NEEDED, "source", "next_poses"), legal)
    missing = [name for name in _NEEDED if name not in found]
    if missing and "next_poses" in found:
        return None
    if missing:
        raise dataset.DatasetError(
            f"{file}: array '{missing[0]}' is missing; legal: {', '.join(_NEEDED)}, and source if "
            "wanted"
        )
    source = found.get("source", np.zeros(found["actions"].size, np.int8))
    return {name: found[name] for name in _NEEDED} | {"source": source}


def _rows_of_run(file: Path, task: _core.Task) -> Rows:
    found = dataset.read(file, task)
    return checked_rows(task, found.poses, found.action, found.next_poses, found.source)


def read(path: Path, task: _core.Task) -> OwnData:
    """Reads the transitions of a .npz with states in metres, or those of a run of the task.

    `path`: that of the file, or of the folder of the run. The task judges which succeed. Raises
    UserError, also if the file of a run is of another task or was changed since it was written.
    """
    file = file_of(path)
    arrays = _arrays(file)
    origin = {"format": "npz", "name": file.name}
    if arrays is None:
        folder = file.resolve().parent
        origin = {"format": "run", "name": f"{folder.name}/{file.name}"}
        if engine := versions.engine_of_data(folder):
            origin[versions.ENGINE_KEY] = engine
    try:
        rows = rows_in_metres(task, **arrays) if arrays else _rows_of_run(file, task)
    except UserError:
        raise
    except ValueError as error:
        raise UserError(f"{file}: {error}") from None
    return OwnData(rows, {**origin, "sha256": versions.digest(file)})


def figures(task: _core.Task, rows: Rows) -> dict[str, Any]:
    """Returns what generation.json tells of transitions, by the same keys."""
    moved = task.moved(rows.poses, rows.next_poses)[:, 1:]  # [N, objects]
    count = len(rows.action)
    return {
        "transitions": count,
        "tree_transitions": int((rows.source == 0).sum()),
        "branch_transitions": int((rows.source == 1).sum()),
        "contact_share": float(moved.any(axis=1).mean()),
        "headings_per_state": count / int(numbered(rows.poses).max() + 1),
    }


def store(run: Path, config: _core.Config, own: OwnData, engine: str) -> None:
    """Makes the transitions those of a run: transitions.npz, generation.json, versions.json.

    `engine`: the identity of the run's forward simulator.
    """
    versions.write(run, engine, {"data": own.origin})
    recorder = Recorder(config)
    recorder.add(own.rows)
    counts = {
        "transitions": len(own.rows.action),
        "successes": int(own.rows.terminated.sum()),
        "at_start": int(config.task.in_start_region(own.rows.poses).sum()),
    }
    report = {
        "data": {**own.origin, **counts},
        **figures(config.task, own.rows),
        row_digest.KEY: recorder.digest(),
        "replay_gaps": [],
        "starts": [],
        "nodes": [],
    }
    run_folder.write_json(run / "generation.json", report)
    recorder.finish(run / "transitions.npz")


def of_run(run: Path) -> dict[str, Any] | None:
    """Returns the OwnData.origin of the data that a run was given; None if it was given none."""
    return versions.generator(run).get("data")


def words(data: dict[str, Any]) -> str:
    """Says what own data are. `data`: that of the generation.json that store() wrote."""
    name, sha256 = data["name"] or "arrays", data["sha256"]
    where = f"{name} (SHA-256 {sha256[:12]}…)" if sha256 else name
    return f"{data['transitions']:,} transitions of {where}, {data['successes']:,} of which succeed"
