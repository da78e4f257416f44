"""Data sets in the format of Minari, of which each step begins where the one before it ended."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import re
import warnings
from collections.abc import Callable, Iterator, Sequence
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rtg import extras
from rtg.errors import RunError, UserError
from rtg.export import run_data, target
from rtg.export.environment import environment_of
from rtg.export.run_data import RunData
from rtg.files import whole_files
from rtg.files.episodes import Episode
from rtg.files.run_folder import write_errors_as_user_errors
from rtg.processes.children import die_with

_KINDS = {
    "plans": "whole episodes: plans found in the data, replayed in the simulator from their first "
    "state to their end",
    "transitions": "all stored transitions, most of them episodes of one step, as each was "
    "simulated from a state of its own; info 'source' names their origin",
}


def default_id(data: RunData, kind: str) -> str:
    """Returns the id that a data set has if the user names none."""
    name = re.sub(r"\W", "_", data.config.task.name)
    return f"rtg/{name}/{data.maker}-{kind}-v0"


@contextlib.contextmanager
def _datasets_in(folder: Path | None) -> Iterator[None]:
    """Makes `folder` that of Minari's data sets in the `with` block; None: leaves it."""
    before = os.environ.get("MINARI_DATASETS_PATH")
    if folder is not None:
        os.environ["MINARI_DATASETS_PATH"] = str(folder)
    try:
        yield
    finally:
        if before is not None:
            os.environ["MINARI_DATASETS_PATH"] = before
        elif folder is not None:
            del os.environ["MINARI_DATASETS_PATH"]


def _path(id: str) -> Path:
    """Returns the path of the data set `id`, and makes the folder of all.

    Raises UserError if it is no id, or if the folder cannot be written.
    """
    where = extras.imported("minari.storage.datasets_root_dir", "minari", "export minari")
    names = extras.imported("minari.dataset.minari_dataset", "minari", "export minari")
    try:
        names.parse_dataset_id(id)
    except (ValueError, TypeError):
        raise UserError(
            f"--id {id}: not an id of Minari; legal: NAME-v0 or GROUP/NAME-v0, of letters, digits, "
            "- and _"
        ) from None
    root = Path(os.environ.get("MINARI_DATASETS_PATH") or Path.home() / ".minari" / "datasets")
    with write_errors_as_user_errors(root):
        path: Path = where.get_dataset_path(id)
    return path


def _buffer(data: RunData, episode: Episode, sources: NDArray[np.int8] | None) -> Any:
    """Returns an episode as Minari stores it; its infos are named as those of the environment."""
    collector = extras.imported("minari.data_collector", "minari", "export minari")
    length, task = len(episode.action), data.config.task
    ends = np.arange(1, length + 1) == length
    infos: dict[str, Any] = {
        "poses": episode.poses,
        "is_success": task.succeeded(episode.poses),
    }
    if sources is not None:  # of the push that led to each state; -1: none did
        infos["source"] = np.concatenate([np.array([-1], np.int8), sources])
    return collector.EpisodeBuffer(
        observations=task.observation(episode.poses),
        actions=episode.action,
        rewards=(ends & episode.success).astype(np.float64),
        terminations=ends & episode.success,
        truncations=ends & (not episode.success),
        infos=infos,
    )


def _episodes(
    data: RunData, kind: str, count: int | None
) -> list[tuple[Episode, NDArray[np.int8] | None]]:
    """Returns the episodes, and the sources of their steps with "transitions"."""
    if kind == "plans":
        return [(episode, None) for episode in run_data.plans(data, count)]
    found = run_data.order_of_episodes(data)[:count]
    if not found:
        raise UserError("there are no transitions; legal: a run whose search finds some")
    return [(run_data.stored(data, rows), data.transitions.source[rows]) for rows in found]


def _metadata(data: RunData, kind: str, buffers: Sequence[Any]) -> dict[str, Any]:
    return {
        "rtg_episodes": kind,
        "rtg_successes": sum(bool(buffer.terminations[-1]) for buffer in buffers),
        **run_data.origin_figures(data),
    }


def _make_group(id: str) -> None:
    """Makes the group of a data set, if it has one, as Minari does for one that it writes there."""
    groups = extras.imported("minari.namespace", "minari", "export minari")
    group = id.rpartition("/")[0]
    if group and group not in groups.list_local_namespaces():
        groups.create_namespace(group)


def _create(data: RunData, kind: str, id: str, buffers: Sequence[Any]) -> None:
    """Has Minari write the data set."""
    minari = extras.imported("minari", "minari", "export minari")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # about authors and links, which are not ours
        made = minari.create_dataset_from_buffers(
            id,
            buffers,
            env=environment_of(data.config),
            algorithm_name=f"RTG, {data.maker}",
            description=f"Pushes of the task {data.config.task.name}; {_KINDS[kind]}. "
            "`import rtg` before recover_environment().",
        )
    made.storage.update_metadata(_metadata(data, kind, buffers))


def _report(work: Callable[[], object], parent: int, result: Connection) -> None:
    """Does `work` and sends the error that it raises, or None. Says nothing else."""
    die_with(parent)()
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    try:
        work()
        result.send(None)
    except Exception as error:
        result.send(error)


def _in_child(work: Callable[[], object], path: Path) -> None:
    """Does `work`, which writes `path`, in a child process, and raises its error.

    HDF5 ends a process in which it cannot write what it still holds: that is a RunError.
    """
    context = multiprocessing.get_context("fork")  # the child has the data already
    receiver, sender = context.Pipe(duplex=False)
    child = context.Process(target=_report, args=(work, os.getpid(), sender))
    child.start()
    sender.close()
    try:
        error = receiver.recv()
    except EOFError:
        error = RunError(f"{path}: HDF5 could not write it, and ended its process")
    child.join()
    if error is not None:
        whole_files.grow(path.with_name("grown"))  # tells what the machine lacks
        raise error


def write(data: RunData, kind: str, id: str, folder: Path | None, count: int | None) -> str:
    """Writes the data set `id`, and returns what it is, in words.

    `kind`: "plans" or "transitions". `folder`: that of the data sets; Minari's own if None.
    `count`: at most so many episodes; all if None. Raises UserError if there is nothing to write,
    if there is such a data set already, if it cannot be written or is being written, or if Minari
    is not installed; RunError if the disk is full.
    """
    extras.imported("minari", "minari", "export minari")
    extras.imported("h5py", "minari", "export minari")
    with _datasets_in(folder):
        path = _path(id)
        with target.held(path):
            if path.exists():
                raise UserError(
                    f"--id {id}: {path} exists already; legal: another id, or another --out"
                )
            episodes = _episodes(data, kind, count)
            buffers = [_buffer(data, episode, sources) for episode, sources in episodes]
            with target.draft(path) as draft:
                draft.mkdir()
                with _datasets_in(draft):
                    _in_child(lambda: _create(data, kind, id, buffers), draft / "data")
                _make_group(id)
                (draft / id).rename(path)
    return f"{id}: {run_data.words(data, [episode for episode, _ in episodes])}\n{path}"
