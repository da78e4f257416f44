"""Data sets in the format LeRobotDataset v3.0: tables in Parquet, films of the states in mp4."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rtg import _core, extras
from rtg.envs.push_env import PushEnv, observation_names
from rtg.errors import UserError
from rtg.export import run_data, statistics, target, video
from rtg.export.run_data import RunData
from rtg.export.statistics import Statistics
from rtg.files import run_folder
from rtg.files.episodes import Episode
from rtg.pictures.draw import state_image

_VERSION = "v3.0"
_FPS: int = PushEnv.metadata["render_fps"]  # one frame is the state before a push
_SIDE = 256  # [pixels] of a frame
_PER_FILE = 1000  # episodes in one table and film
_FILE = "chunk-{chunk_index:03d}/file-{file_index:03d}"
_IMAGES = "observation.images.scene"


class _Column(NamedTuple):
    dtype: str
    size: int
    names: list[str] | None = None


def _columns(task: _core.Task) -> dict[str, _Column]:
    """Returns the columns of the table of frames, by name."""
    state = observation_names(task)
    return {
        "observation.state": _Column("float32", len(state), state),
        "action": _Column("float32", 2, ["x", "y"]),
        "push": _Column("int64", 1),
        "next.reward": _Column("float32", 1),
        "next.done": _Column("bool", 1),
        "next.success": _Column("bool", 1),
        "timestamp": _Column("float32", 1),
        "frame_index": _Column("int64", 1),
        "episode_index": _Column("int64", 1),
        "index": _Column("int64", 1),
        "task_index": _Column("int64", 1),
    }


def _frames(task: _core.Task, episode: Episode, number: int, begin: int) -> dict[str, NDArray[Any]]:
    """Returns the columns of an episode; `begin`: the number of its first frame in the data set."""
    count = len(episode.action)
    frame = np.arange(count)
    is_last = frame == count - 1
    return {
        "observation.state": task.observation(episode.poses[:-1]),
        "action": (task.ways(episode.action) / task.metre).astype(np.float32),
        "push": episode.action,
        "next.reward": (is_last & episode.success).astype(np.float32),
        "next.done": is_last,
        "next.success": is_last & episode.success,
        "timestamp": (frame / _FPS).astype(np.float32),
        "frame_index": frame,
        "episode_index": np.full(count, number),
        "index": begin + frame,
        "task_index": np.zeros(count, np.int64),
    }


def _images(task: _core.Task, episode: Episode) -> Iterator[NDArray[np.uint8]]:
    for poses in episode.poses[:-1]:
        yield state_image(task, poses[None], pixels=_SIDE)


def _table(columns: dict[str, _Column], values: dict[str, NDArray[Any]]) -> Any:
    arrow = extras.imported("pyarrow", "lerobot", "export lerobot")
    arrays = {}
    for name, column in columns.items():
        kind = arrow.from_numpy_dtype(np.dtype(column.dtype))
        flat = arrow.array(values[name].ravel().astype(column.dtype), kind)
        is_list = column.size > 1
        arrays[name] = arrow.FixedSizeListArray.from_arrays(flat, column.size) if is_list else flat
    return arrow.table(arrays)


class _Writer:
    """Writes tables and films of groups of episodes, and collects what the metadata tell."""

    def __init__(self, folder: Path, data: RunData) -> None:
        self._folder, self._task = folder, data.config.task
        self._columns = _columns(self._task)
        self._levels = np.zeros((3, 256), np.int64)
        self._numbers: list[dict[str, NDArray[Any]]] = []
        self.rows: list[dict[str, Any]] = []  # of the table of episodes
        self.frames = 0

    def add(self, number: int, episodes: Sequence[Episode]) -> None:
        """Writes the files with the number `number`."""
        parquet = extras.imported("pyarrow.parquet", "lerobot", "export lerobot")
        data, film = (
            self._path("data", number, ".parquet"),
            self._path(f"videos/{_IMAGES}", number, ".mp4"),
        )
        begin, parts = self.frames, []
        with video.Film(film, _FPS, _SIDE) as images:
            for episode in episodes:
                parts.append(_frames(self._task, episode, len(self.rows), self.frames))
                levels = np.zeros_like(self._levels)
                for image in _images(self._task, episode):
                    images.add(image)
                    levels += statistics.histogram(image)
                self._note(number, parts[-1], levels, self.frames - begin)
        joined = {name: np.concatenate([part[name] for part in parts]) for name in self._columns}
        parquet.write_table(_table(self._columns, joined), data)
        self._numbers.append(joined)

    def _path(self, folder: str, number: int, suffix: str) -> Path:
        where = _FILE.format(chunk_index=number // 1000, file_index=number % 1000)
        path = self._folder / folder / f"{where}{suffix}"
        path.parent.mkdir(parents=True, exist_ok=True)
        return path

    def _note(
        self, file: int, part: dict[str, NDArray[Any]], levels: NDArray[np.int64], before: int
    ) -> None:
        """Adds the row of an episode, which has `before` frames of its film before it."""
        count = len(part["index"])
        found = {name: statistics.of_numbers(column) for name, column in part.items()}
        found[_IMAGES] = statistics.of_images(levels, count)
        place = {"chunk_index": file // 1000, "file_index": file % 1000}
        self.rows.append(
            {
                "episode_index": len(self.rows),
                "tasks": [task_words(self._task)],
                "length": count,
                **{f"data/{name}": at for name, at in place.items()},
                "dataset_from_index": self.frames,
                "dataset_to_index": self.frames + count,
                **{f"videos/{_IMAGES}/{name}": at for name, at in place.items()},
                f"videos/{_IMAGES}/from_timestamp": before / _FPS,
                f"videos/{_IMAGES}/to_timestamp": (before + count) / _FPS,
                "meta/episodes/chunk_index": 0,
                "meta/episodes/file_index": 0,
                **{
                    f"stats/{name}/{figure}": values
                    for name, figures in found.items()
                    for figure, values in figures.items()
                },
            }
        )
        self.frames += count
        self._levels += levels

    def statistics(self) -> dict[str, Statistics]:
        """Returns those of the whole data set, by column."""
        found = {
            name: statistics.of_numbers(np.concatenate([part[name] for part in self._numbers]))
            for name in self._columns
        }
        return {**found, _IMAGES: statistics.of_images(self._levels, self.frames)}


def task_words(task: _core.Task) -> str:
    """Returns what is to be done, in words: the name of the task."""
    return task.name.replace("_", " ")


def _info(task: _core.Task, writer: _Writer) -> dict[str, Any]:
    """Returns the content of meta/info.json."""
    features: dict[str, Any] = {
        name: {"dtype": column.dtype, "shape": [column.size], "names": column.names}
        for name, column in _columns(task).items()
    }
    features[_IMAGES] = {
        "dtype": "video",
        "shape": [_SIDE, _SIDE, 3],
        "names": ["height", "width", "channels"],
        "info": {
            "video.height": _SIDE,
            "video.width": _SIDE,
            "video.codec": video.CODEC,
            "video.pix_fmt": video.PIXEL_FORMAT,
            "video.is_depth_map": False,
            "video.fps": _FPS,
            "video.channels": 3,
            "has_audio": False,
        },
    }
    return {
        "codebase_version": _VERSION,
        "robot_type": "rtg",
        "total_episodes": len(writer.rows),
        "total_frames": writer.frames,
        "total_tasks": 1,
        "chunks_size": 1000,
        "data_files_size_in_mb": 100,
        "video_files_size_in_mb": 200,
        "fps": _FPS,
        "splits": {"train": f"0:{len(writer.rows)}"},
        "data_path": f"data/{_FILE}.parquet",
        "video_path": f"videos/{{video_key}}/{_FILE}.mp4",
        "features": features,
    }


def _write_metadata(folder: Path, data: RunData, writer: _Writer) -> None:
    arrow = extras.imported("pyarrow", "lerobot", "export lerobot")
    parquet = extras.imported("pyarrow.parquet", "lerobot", "export lerobot")
    pandas = extras.imported("pandas", "lerobot", "export lerobot")
    meta = folder / "meta"
    episodes = meta / "episodes" / f"{_FILE.format(chunk_index=0, file_index=0)}.parquet"
    episodes.parent.mkdir(parents=True)
    parquet.write_table(arrow.Table.from_pylist(writer.rows), episodes)
    words = task_words(data.config.task)
    tasks = pandas.DataFrame({"task_index": [0]}, index=pandas.Index([words], name="task"))
    tasks.to_parquet(meta / "tasks.parquet")
    run_folder.write_text(
        meta / "info.json", run_folder.plain_json(_info(data.config.task, writer))
    )
    run_folder.write_text(meta / "stats.json", run_folder.plain_json(writer.statistics()))
    run_folder.write_text(meta / "rtg.json", run_folder.plain_json(run_data.origin_figures(data)))


def _write_files(folder: Path, data: RunData, episodes: Sequence[Episode]) -> None:
    """Writes all files to the new `folder`."""
    folder.mkdir()
    writer = _Writer(folder, data)
    for number, begin in enumerate(range(0, len(episodes), _PER_FILE)):
        writer.add(number, episodes[begin : begin + _PER_FILE])
    _write_metadata(folder, data, writer)


def write(data: RunData, folder: Path, count: int | None) -> str:
    """Writes the plans of the data to the new `folder`, and returns what it is, in words.

    `count`: at most so many episodes; all if None. Raises UserError if there is nothing to write,
    if `folder` exists, cannot be written or is being written, or if a package is missing.
    """
    for package in ("av", "pandas", "pyarrow"):
        extras.imported(package, "lerobot", "export lerobot")
    if folder.exists():
        raise UserError(f"--out: {folder} exists already; legal: a new folder")
    with target.held(folder):
        episodes = run_data.plans(data, count)
        with target.draft(folder) as draft:
            _write_files(draft, data, episodes)
            draft.rename(folder)
    return f"{run_data.words(data, episodes)}\n{folder}"
