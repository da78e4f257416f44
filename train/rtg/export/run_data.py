"""Reads what is exported: the episodes of a run's data, and where they come from."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from rtg import _core
from rtg.errors import UserError
from rtg.files import dataset, own_data, run_folder, versions
from rtg.files.dataset import Origin, Transitions
from rtg.files.episodes import Episode, replayed_plans
from rtg.run import effective_config


class RunData(NamedTuple):
    """The stored transitions of a run."""

    config: _core.Config
    transitions: Transitions
    origin: Origin
    sha256: str  # of transitions.npz
    maker: str  # of the transitions: a generator of the search, or "own" for those of `--data`


def read(run: Path) -> RunData:
    """Reads the transitions of a run. Raises UserError if its folder lacks them or is damaged."""
    config = effective_config.load_written(run_folder.config_file(run))
    path = run / "transitions.npz"
    transitions, origin = dataset.read_with_origin(path, config.task)
    is_given = own_data.of_run(run)
    maker = "own" if is_given else config.search.generator
    return RunData(config, transitions, origin, versions.digest(path), maker)


def origin_figures(data: RunData) -> dict[str, Any]:
    """Returns what the metadata of a data set tell of its origin."""
    return {
        "rtg_task": str(data.origin.task),  # JSON keeps 53 bits of a number
        "rtg_seed": data.origin.seed,
        "rtg_revision": data.origin.revision,
        "rtg_transitions_sha256": data.sha256,
    }


def plans(data: RunData, count: int | None) -> list[Episode]:
    """Returns the plans of the data, replayed from their first states. Raises UserError for none.

    `count`: at most so many, those that begin nearest to the start; None: all.
    """
    found = replayed_plans(data.config, data.transitions, count)
    if not found:
        raise UserError(
            f"the {len(data.transitions.action)} transitions have no plan: no chain of steps ends "
            "in a success; legal: --transitions, or a run whose search finds goals"
        )
    return found


def order_of_episodes(data: RunData) -> list[np.ndarray]:
    """Returns the rows of each stored episode, in order."""
    chains = dataset.chains(data.transitions)
    order = np.lexsort((chains.step, chains.episode))
    return np.split(order, np.flatnonzero(chains.step[order] == 0)[1:]) if len(order) else []


def stored(data: RunData, rows: np.ndarray) -> Episode:
    """Returns the episode that rows of one episode form."""
    t = data.transitions
    poses = np.concatenate([t.poses[rows[:1]], t.next_poses[rows]])
    return Episode(poses, t.action[rows].astype(np.int64), bool(t.terminated[rows[-1]]))


def words(data: RunData, episodes: Sequence[Episode]) -> str:
    """Says what is exported: episodes and steps, and how many succeed or begin at a start."""
    successes = sum(episode.success for episode in episodes)
    steps = sum(len(episode.action) for episode in episodes)
    first = np.stack([episode.poses[0] for episode in episodes])
    at_start = int(data.config.task.in_start_region(first).sum())
    begin = f"{at_start:,} of them begin" if at_start else "none of them begins"
    return (
        f"{len(episodes):,} episodes, {successes:,} of them succeed, {begin} at a start of the "
        f"task, {steps:,} steps"
    )
