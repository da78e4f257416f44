"""Transition sets: their arrays, the file `transitions.npz` and the checks when it is read.

docs/data.md says what each array means.
"""

from __future__ import annotations

import zipfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from rtg import _core
from rtg.errors import UserError, raise_if_of_the_machine
from rtg.files import archives, run_folder, versions
from rtg.files.chains import Chains, chains_of
from rtg.files.row_digest import KEY, row_digest

Array = npt.NDArray[Any]

SOURCES = _core.SOURCES  # names of the sources; `source` of a transition is an index
_ZIP_EPOCH = (1980, 1, 1, 0, 0, 0)  # the earliest time that a zip entry can store


class Rows(NamedTuple):
    """Consecutive transitions without observations, as a search produces them."""

    poses: npt.NDArray[np.float64]  # [n, bodies, 3]: x, y [task units], theta [rad]
    action: npt.NDArray[np.int32]  # [n]
    next_poses: npt.NDArray[np.float64]  # [n, bodies, 3]
    reward: npt.NDArray[np.float32]  # [n], 1 on success
    terminated: npt.NDArray[np.bool_]  # [n], True on success
    source: npt.NDArray[np.int8]  # [n], index into SOURCES

    def slice(self, begin: int, end: int | None = None) -> Rows:
        """Returns the rows from index `begin` up to, but not including, index `end`."""
        return Rows._make(column[begin:end] for column in self)


class Transitions(NamedTuple):
    """N simulated transitions with observations, in the order of generation."""

    poses: Array  # [N, bodies, 3] float64, x, y [task units], θ [rad]; body 0 is the robot
    action: Array  # [N] int32
    next_poses: Array  # [N, bodies, 3] float64
    reward: Array  # [N] float32, 1 where the goal holds afterwards, else 0
    terminated: Array  # [N] bool, reward == 1
    observation: Array  # [N, observation] float32
    next_observation: Array  # [N, observation] float32
    source: Array  # [N] int8, index into SOURCES


class Origin(NamedTuple):
    """Of a transition set: what it is about, and what it was made with."""

    task: int  # Task.content, a hash of bodies, joints, goal and pushes
    seed: int  # run.seed
    revision: str  # commit of the program, with "-modified" if files differed; "" if unknown


def origin_of(config: _core.Config) -> Origin:
    """Returns the origin of the transitions that this program makes with `config`."""
    return Origin(config.task.content, config.run.seed, versions.this_commit() or "")


class _Column(NamedTuple):
    dtype: type[np.generic]
    shape: str = "[N]"

    @property
    def rank(self) -> int:
        return 0 if self.shape == "[]" else self.shape.count(",") + 1


# Element type and shape that each array has in the file.
_COLUMNS = {
    "poses": _Column(np.float64, "[N, bodies, 3]"),
    "action": _Column(np.int32),
    "next_poses": _Column(np.float64, "[N, bodies, 3]"),
    "reward": _Column(np.float32),
    "terminated": _Column(np.bool_),
    "observation": _Column(np.float32, "[N, observation]"),
    "next_observation": _Column(np.float32, "[N, observation]"),
    "source": _Column(np.int8),
    "episode": _Column(np.int32),
    "step": _Column(np.int32),
    "truncated": _Column(np.bool_),
    "task": _Column(np.int64, "[]"),
    "seed": _Column(np.int64, "[]"),
    "revision": _Column(np.str_, "[]"),
}


class DatasetError(UserError, ValueError):
    """An error for a file that is missing or is no legal transition set.

    The message names the file, the array and the legal values.
    """


def concatenate(parts: list[Transitions]) -> Transitions:
    """Returns the transitions of all `parts`, at least one, in their order."""
    return Transitions(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))


def read_arrays(path: Path, names: Iterable[str], legal: str) -> dict[str, Array]:
    """Returns those arrays of a .npz that are asked for and there.

    Raises DatasetError if it cannot be read, or was changed since RTG wrote it. `legal`: in words.
    """
    try:
        return archives.arrays(path, names)
    except FileNotFoundError:
        raise DatasetError(f"{path}: no such file; legal: {legal}") from None
    except (OSError, ValueError) as error:
        raise_if_of_the_machine(error, path)
        why = (isinstance(error, OSError) and error.strerror) or error
        raise DatasetError(
            f"{path}: is not a transition file, or damaged ({why}); legal: {legal}"
        ) from error


def chains(transitions: Transitions) -> Chains:
    """Returns the episodes that the transitions form."""
    t = transitions
    return chains_of(t.poses, t.next_poses, t.terminated, t.source)


def write(path: Path, transitions: Transitions, origin: Origin) -> None:
    """Writes `transitions` to `path`, atomically even if the machine crashes.

    Equal transitions of equal origin give bitwise equal files.
    """
    members = {**transitions._asdict(), **chains(transitions)._asdict(), **origin._asdict()}
    with archives.written(path) as file, zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        for name, column in _COLUMNS.items():
            entry = zipfile.ZipInfo(f"{name}.npy", _ZIP_EPOCH)
            with archive.open(entry, "w", force_zip64=True) as member:
                array: Array = np.asarray(members[name], column.dtype, order="C")
                np.lib.format.write_array(member, array, allow_pickle=False)


def read(path: Path, task: _core.Task | None = None) -> Transitions:
    """Reads and checks a transition set.

    It must be one of `task`, if that is given. Raises DatasetError if there is no file or it is no
    legal transition set, or not the one that the generation.json beside it tells of; UserError if
    it was changed since it was sealed (versions.seal()).
    """
    return read_with_origin(path, task)[0]


def read_with_origin(path: Path, task: _core.Task | None = None) -> tuple[Transitions, Origin]:
    """The same, and where the set comes from."""
    arrays = read_arrays(path, _COLUMNS, "a transitions.npz of RTG")
    _check_types(path, arrays)
    versions.check_seal(path)
    _check_shapes(path, arrays)
    transitions = Transitions(*(arrays[name] for name in Transitions._fields))
    origin = Origin(*(arrays[name].item() for name in Origin._fields))
    _check_values(path, transitions)
    _check_episodes(path, arrays, chains(transitions))
    _check_report(path, transitions)
    if task is not None:
        _check_task(path, transitions, origin, task)
    return transitions, origin


def _check_types(path: Path, arrays: dict[str, Array]) -> None:
    for name, column in _COLUMNS.items():
        if name not in arrays:
            raise DatasetError(f"{path}: array '{name}' is missing; legal: {', '.join(_COLUMNS)}")
        found, expected = arrays[name].dtype, np.dtype(column.dtype)
        if found != expected and (found.kind, expected.kind) != ("U", "U"):
            raise DatasetError(f"{path}: '{name}' has type {found}; legal: {expected.name}")


def _check_shapes(path: Path, arrays: dict[str, Array]) -> None:
    count = len(arrays["action"]) if arrays["action"].ndim == 1 else -1
    for name, array in arrays.items():
        legal, rank = _COLUMNS[name].shape, _COLUMNS[name].rank
        wrong = array.ndim != rank or (rank > 0 and array.shape[0] != count)
        if wrong or (legal.endswith("3]") and array.shape[2] != 3):
            shape = list(array.shape)
            raise DatasetError(f"{path}: '{name}' has shape {shape}; legal: {legal}, one N for all")
    for name in ("poses", "observation"):
        if arrays[name].shape != arrays[f"next_{name}"].shape:
            raise DatasetError(
                f"{path}: '{name}' and 'next_{name}' differ in shape; legal: equal shapes"
            )


def _check_values(path: Path, transitions: Transitions) -> None:
    for name in ("poses", "next_poses", "observation", "next_observation"):
        if not np.isfinite(getattr(transitions, name)).all():
            raise DatasetError(
                f"{path}: '{name}' has values that are not finite; legal: finite numbers"
            )
    if not np.isin(transitions.reward, (0.0, 1.0)).all():
        raise DatasetError(f"{path}: 'reward' has other values than 0 and 1; legal: 0, 1")
    if not np.array_equal(transitions.terminated, transitions.reward == 1.0):
        raise DatasetError(
            f"{path}: 'terminated' differs from reward == 1; legal: true where 'reward' is 1"
        )
    if (transitions.action < 0).any():
        raise DatasetError(f"{path}: 'action' has negative values; legal: 0 or more")
    if not np.isin(transitions.source, range(len(SOURCES))).all():
        raise DatasetError(f"{path}: 'source' has illegal values; legal: 0 to {len(SOURCES) - 1}")


def _check_episodes(path: Path, arrays: dict[str, Array], expected: Chains) -> None:
    for name, column in expected._asdict().items():
        if not np.array_equal(arrays[name], column):
            raise DatasetError(
                f"{path}: '{name}' is not that of these rows; legal: what RTG wrote, see "
                "docs/data.md"
            )


def _check_report(path: Path, transitions: Transitions) -> None:
    report = path.with_name("generation.json")
    if run_folder.read_json(report).get(KEY) not in (None, row_digest(transitions)):
        raise DatasetError(
            f"{path}: holds other transitions than {report.name} tells of, as their SHA-256 is "
            f"not its {KEY}; legal: both as one run wrote them, or neither, to generate anew"
        )


def _check_task(path: Path, data: Transitions, origin: Origin, task: _core.Task) -> None:
    if origin.task != task.content:
        raise DatasetError(
            f"{path}: has transitions of another task ({origin.task}); legal: {task.content}, "
            f"which is '{task.name}' with these bodies, goal and pushes"
        )
    if data.poses.shape[1] != task.bodies:
        raise DatasetError(
            f"{path}: has {data.poses.shape[1]} bodies; legal: {task.bodies}, those of the task"
        )
    if len(data.action) and data.action.max() >= task.actions:
        largest = data.action.max()
        raise DatasetError(
            f"{path}: has action {largest}; legal: 0 to {task.actions - 1}, those of the task"
        )
