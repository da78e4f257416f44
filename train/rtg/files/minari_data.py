"""Transitions of a Minari data set that was made with an environment of RTG."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import numpy as np

from rtg import _core, extras
from rtg.errors import UserError
from rtg.files import own_data
from rtg.files.own_data import OwnData
from rtg.task_config import read_config

_ENVIRONMENT = "rtg.envs.push_env:PushEnv"


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


def _opened(word: str, folder: Path) -> tuple[Any, list[Any]]:
    """Returns the data set and its episodes."""
    minari = extras.imported("minari", "minari", f"--data {word}")
    extras.imported("h5py", "minari", f"--data {word}")
    try:
        found = minari.MinariDataset(folder)
        return found, list(found.iterate_episodes())
    except Exception as error:  # Minari and h5py raise any error on damaged files
        raise UserError(
            f"{word}: is not a data set of Minari, or damaged ({error}); legal: one that "
            "minari.load_dataset() reads"
        ) from None


def _check_environment(name: str, found: Any, task: _core.Task) -> None:
    spec = found.env_spec
    if spec is None or spec.entry_point != _ENVIRONMENT:
        raise UserError(
            f"{name}: was not made with an environment of RTG; legal: one whose "
            "recover_environment() is RTG/...-v0"
        )
    if _task_of(name, spec.kwargs).content != task.content:
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


def _poses(name: str, episode: Any, task: _core.Task) -> Any:
    poses = (episode.infos or {}).get("poses")
    expected = (len(episode.actions) + 1, task.bodies, 3)
    if poses is None or np.shape(poses) != expected or not np.isfinite(poses).all():
        raise UserError(
            f"{name}: episode {episode.id} has no info 'poses' of shape {list(expected)}, and "
            "observations do not tell a state to the bit; legal: what `export minari` wrote, or "
            "minari.DataCollector with record_infos=True"
        )
    return np.asarray(poses, np.float64)


def _info(name: str, episode: Any, key: str, dtype: type[np.generic]) -> Any:
    """Returns an info of the steps, 0 if it is absent. [T]"""
    count = len(episode.actions)
    if key not in episode.infos:
        return np.zeros(count, dtype)
    found = np.asarray(episode.infos[key])
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
    Minari is not installed or the data set is not legal.
    """
    found, episodes = _opened(word, folder)
    _check_environment(word, found, task)
    parts = []
    for episode in episodes:
        poses = _poses(word, episode, task)
        kept = ~_info(word, episode, "rejected", np.bool_)
        source = _info(word, episode, "source", np.int8)
        columns = (poses[:-1], np.asarray(episode.actions), poses[1:], source)
        parts.append([column[kept] for column in columns])
    if not parts:
        raise UserError(f"{word}: has no episodes; legal: at least one")
    try:
        rows = own_data.checked_rows(task, *map(np.concatenate, zip(*parts, strict=True)))
    except ValueError as error:
        raise UserError(f"{word}: {error}") from None
    return OwnData(rows, {"format": "minari", "name": found.id, "sha256": _digest(folder)})
