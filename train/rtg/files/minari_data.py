"""Transitions of a Minari data set that was made with an environment of RTG.

They are read without Minari: it would make any environment that the file names, and read arrays of
any size.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import math
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rtg import _core, extras
from rtg.errors import UserError
from rtg.files import archives, own_data, whole_files
from rtg.files.own_data import OwnData
from rtg.task_config import read_config

_ENVIRONMENT = "rtg.envs.push_env:PushEnv"
_INFOS = ("poses", "rejected", "source")
_HARD = 0  # H5L_TYPE_HARD of HDF5: what is linked is in the file itself


class Metadata(NamedTuple):
    """What metadata.json tells of a data set."""

    id: str
    entry_point: str | None  # of its environment
    kwargs: dict[str, Any]
    episodes: int


class Episode(NamedTuple):
    """What the learner needs of an episode."""

    id: int
    actions: NDArray[Any]  # [T]
    infos: dict[str, NDArray[Any]]  # those of _INFOS that are there, [T + 1, ...] each


def folder_of(word: str) -> Path | None:
    """Returns the folder with the data of a data set: that of a folder or an id; None if neither.

    Raises UserError if `word` can only be an id and Minari is not installed.
    """
    for path in (Path(word), Path(word) / "data"):
        if (path / "metadata.json").is_file():
            return path
    if Path(word).exists():
        return None
    where = extras.imported("minari.storage.datasets_root_dir", "minari", f"--data {word}")
    path = where.get_dataset_path(word) / "data"
    return path if path.is_dir() else None


def _digest(folder: Path) -> str:
    """Returns the SHA-256 over the names and contents of all files of a folder."""
    found = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            found.update(f"{path.relative_to(folder)} {path.stat().st_size} ".encode())
            with path.open("rb") as file:
                hashlib.file_digest(file, lambda: found)  # goes on with it, block by block
    return found.hexdigest()


@contextlib.contextmanager
def _damage_named(word: str) -> Iterator[None]:
    """Turns any error in the `with` block, which reads the data set `word`, into a UserError."""
    try:
        yield
    except Exception as error:  # h5py raises any error on damaged files
        raise UserError(
            f"{word}: is not a data set of Minari, or damaged ({error}); legal: one that "
            "minari.load_dataset() reads, in the format hdf5"
        ) from None


def _metadata(word: str, folder: Path) -> Metadata:
    with _damage_named(word):
        found = json.loads(whole_files.read(folder / "metadata.json"))
        spec = json.loads(found.get("env_spec") or "{}")
        return Metadata(
            found["dataset_id"], spec.get("entry_point"), spec["kwargs"], found["total_episodes"]
        )


def _dataset(file: Any, path: str) -> Any:
    """Returns the numbers at a path in a file; None if there are none.

    Raises ValueError if they are elsewhere: another file may never begin.
    """
    found = file
    for name in path.split("/"):
        links, key = found.id.links, name.encode()
        if not links.exists(key):
            return None
        if links.get_info(key).type != _HARD:
            raise ValueError(f"{path} is a link")
        found = found[name]
    if found.dtype.kind not in "biuf" or found.external or found.is_virtual:
        raise ValueError(f"{path} has no numbers in the file")
    return found


def _size(dataset: Any) -> int:
    """Returns the bytes that reading takes, whatever of them is in the file."""
    return int(max(dataset.size, math.prod(dataset.chunks or ())) * dataset.dtype.itemsize)


def _episodes(word: str, folder: Path, count: int) -> list[Episode]:
    """Reads of each episode what the learner needs."""
    h5py = extras.imported("h5py", "minari", f"--data {word}")
    path, episodes = folder / "main_data.hdf5", []
    with _damage_named(word), whole_files.opened(path) as file, h5py.File(path, "r") as content:
        room = archives.room(os.fstat(file.fileno()).st_size)
        for k in range(count):
            paths = {name: f"episode_{k}/infos/{name}" for name in _INFOS}
            paths["actions"] = f"episode_{k}/actions"
            found = {name: _dataset(content, path) for name, path in paths.items()}
            found = {name: part for name, part in found.items() if part is not None}
            room -= sum(map(_size, found.values()))
            if room < 0:
                raise ValueError("it would take more than four times its size")
            arrays = {name: part[()] for name, part in found.items()}
            episodes.append(Episode(k, arrays.pop("actions"), arrays))
    return episodes


def _check_environment(name: str, found: Metadata, task: _core.Task) -> None:
    if found.entry_point != _ENVIRONMENT:
        raise UserError(
            f"{name}: was not made with an environment of RTG; legal: one whose "
            "recover_environment() is RTG/...-v0"
        )
    if _task_of(name, found.kwargs).content != task.content:
        raise UserError(f"{name}: is of another task; legal: one of '{task.name}'")


def _task_of(name: str, kwargs: dict[str, Any]) -> _core.Task:
    """Returns the task of an environment's arguments.

    The environment itself is not made: its specification may name any function of a stranger.
    """
    config, settings = kwargs.get("config", "gathering"), kwargs.get("settings", ())
    try:
        return read_config(config, settings).task
    except (OSError, TypeError, ValueError) as error:
        raise UserError(f"{name}: its environment has no task ({error})") from None


def _poses(name: str, episode: Episode, task: _core.Task) -> Any:
    poses = episode.infos.get("poses")
    expected = (len(episode.actions) + 1, task.bodies, 3)
    if poses is None or np.shape(poses) != expected or not np.isfinite(poses).all():
        raise UserError(
            f"{name}: episode {episode.id} has no info 'poses' of shape {list(expected)}, and "
            "observations do not tell a state to the bit; legal: what `export minari` wrote, or "
            "minari.DataCollector with record_infos=True"
        )
    return np.asarray(poses, np.float64)


def _info(name: str, episode: Episode, key: str, dtype: type[np.generic]) -> Any:
    """Returns an info of the steps, 0 if it is absent. [T]"""
    count = len(episode.actions)
    if key not in episode.infos:
        return np.zeros(count, dtype)
    found = episode.infos[key]
    if found.shape != (count + 1,) or found.dtype.kind != np.dtype(dtype).kind:
        legal = f"{np.dtype(dtype).name} [{count + 1}]"
        raise UserError(
            f"{name}: episode {episode.id} has info '{key}' of {found.dtype} {list(found.shape)}; "
            f"legal: {legal}"
        )
    return found[1:]


def read(word: str, folder: Path, task: _core.Task) -> OwnData:
    """Reads a data set. `word`: what the user calls it; `folder`: see folder_of().

    Pushes that the simulator could not finish (info "rejected") are left out. Raises UserError if
    h5py is not installed or the data set is not legal.
    """
    found = _metadata(word, folder)
    _check_environment(word, found, task)
    parts = []
    for episode in _episodes(word, folder, found.episodes):
        poses = _poses(word, episode, task)
        kept = ~_info(word, episode, "rejected", np.bool_)
        source = _info(word, episode, "source", np.int8)
        columns = (poses[:-1], episode.actions, poses[1:], source)
        parts.append([column[kept] for column in columns])
    if not parts:
        raise UserError(f"{word}: has no episodes; legal: at least one")
    try:
        rows = own_data.checked_rows(task, *map(np.concatenate, zip(*parts, strict=True)))
    except ValueError as error:
        raise UserError(f"{word}: {error}") from None
    return OwnData(rows, {"format": "minari", "name": found.id, "sha256": _digest(folder)})
