"""The course of a run, as its folder tells it: events with times, from the files that it has."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rtg import _core, errors
from rtg.files import best_episode, dataset, run_folder
from rtg.files.dataset import Rows
from rtg.run.results import learning_curve

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_PARTS = 120  # into which the rows of a finished generation are divided
_GAP_PARTS = 20


class Steps(NamedTuple):
    """Transitions that the generation has stored."""

    at: float  # [s] since the begin of the run
    numbers: Ints  # [n], places in the sequence of generation
    rows: Rows


class Evaluation(NamedTuple):
    """One row of progress.csv."""

    at: float
    row: Mapping[str, float]


class Gaps(NamedTuple):
    """The replay gaps of all reverse steps simulated so far."""

    at: float
    gaps: Floats  # [m]


class BestEpisode(NamedTuple):
    """The episode that a run leaves: the best one of its policy, or a plan of its data."""

    at: float
    states: Floats  # [T + 1, bodies, 3]
    success: bool
    is_learned: bool


Event = Steps | Evaluation | Gaps | BestEpisode


class RunEvents:
    """Reads the files of a run folder when they appear or change.

    The files do not tell when each transition was stored: those of a finished generation are spread
    evenly over its time. `generate_wall_s` of generation.json and `wall_s` of progress.csv tell the
    rest. Over LCM a learner begins with the generation, in one process after it.
    """

    def __init__(self, folder: Path, config: _core.Config) -> None:
        self._folder, self._config = folder, config
        self._seen: dict[str, tuple[int, int]] = {}
        self._evaluations = 0
        self.end = 0.0  # [s], time of the last event so far

    def new(self) -> list[Event]:
        """Returns the events since the last call, by time. Raises UserError for a damaged file."""
        found = [*self._generation(), *self._learning()]
        self.end = max([self.end, *(event.at for event in found)])
        return sorted([*found, *self._episode()], key=lambda event: event.at)

    def _changed(self, name: str) -> bool:
        """Returns whether a file has appeared or changed since the last call."""
        path = self._folder / name
        if not path.is_file():
            return False
        found = path.stat()
        state = found.st_mtime_ns, found.st_size
        changed = self._seen.get(name) != state
        self._seen[name] = state
        return changed

    def _generation_time(self) -> float:
        file = self._folder / "generation.json"
        report = run_folder.read_json(file)
        with errors.fields_of(file):
            return float(report.get("generate_wall_s", 0.0))

    def _generation(self) -> list[Event]:
        found: list[Event] = []
        if self._changed("transitions.npz"):
            found += self._stored(self._generation_time())
        if self._changed("generation.json"):
            file = self._folder / "generation.json"
            report = run_folder.read_json(file)
            with errors.fields_of(file):
                gaps = np.array(report.get("replay_gaps", []), float)
            length = self._generation_time()
            for share in np.arange(1, _GAP_PARTS + 1) / _GAP_PARTS if len(gaps) else ():
                found.append(Gaps(share * length, gaps[: max(1, int(share * len(gaps)))]))
        return found

    def _stored(self, length: float) -> list[Event]:
        data = dataset.read(self._folder / "transitions.npz", self._config.task)
        rows = Rows._make(getattr(data, name) for name in Rows._fields)
        bounds = np.linspace(0, len(rows.action), _PARTS + 1).astype(int)
        return [
            Steps(length * part / _PARTS, np.arange(begin, end), rows.slice(begin, end))
            for part, (begin, end) in enumerate(itertools.pairwise(bounds))
            if end > begin
        ]

    def _learning(self) -> list[Event]:
        if not self._changed("progress.csv"):
            return []
        file = self._folder / "progress.csv"
        curve = learning_curve(file)
        with errors.fields_of(file):
            if curve and not np.isfinite([curve["interactions"], curve["wall_s"]]).all():
                raise ValueError("interactions and wall_s have to be numbers")
        count = len(curve["interactions"]) if curve else 0
        in_row = self._config.train.offline and self._config.run.in_process
        begin = self._generation_time() if in_row else 0.0
        first, self._evaluations = min(self._evaluations, count), count
        rows = [{name: float(curve[name][k]) for name in curve} for k in range(first, count)]
        return [Evaluation(begin + row["wall_s"], row) for row in rows]

    def _episode(self) -> list[Event]:
        """The file of the episode is whole when the next one is there."""
        is_learned = (self._folder / "training.json").is_file()
        after = "training.json" if is_learned else "summary.json"
        if not self._changed(after) or not (self._folder / best_episode.FILE).is_file():
            return []
        states, success = best_episode.read(self._folder, self._config.task.bodies)
        return [BestEpisode(self.end, states, success, is_learned)]
