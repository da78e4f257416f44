"""Follows the progress of the learner by the file that the learner writes for displays."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

from rtg import errors
from rtg.files.run_folder import read_json
from rtg.run.run_state import RateMeter, RunState


class TrainingWatch:
    """Reads RUN/training_state.json whenever it changes."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / "training_state.json"
        self._changed = 0
        self._meter = RateMeter()
        self._state = RunState()

    def update(self, state: RunState) -> RunState:
        """Returns `state` with the current figures of the learner."""
        changed = self._path.stat().st_mtime_ns if self._path.is_file() else 0
        if changed != self._changed:
            self._changed = changed
            self._read()
        learner = self._state
        return replace(
            state,
            interactions=learner.interactions,
            rate=learner.rate,
            evaluations=learner.evaluations,
            success_rate=learner.success_rate,
        )

    def _read(self) -> None:
        learner = read_json(self._path)
        with errors.fields_of(self._path):
            interactions = int(learner["interactions"])
            self._state = RunState(
                interactions=interactions,
                rate=self._meter.rate(interactions, time.monotonic()),
                evaluations=learner["evaluations"],
                success_rate=learner["success_rate"],
            )
