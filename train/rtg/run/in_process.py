"""Generates transitions without LCM, on threads of this process."""

from __future__ import annotations

import atexit
import json
import os
import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from rtg import _core
from rtg.engines import replay_function
from rtg.errors import RunError, StoppedError
from rtg.files import row_digest, run_folder
from rtg.files.dataset import Rows
from rtg.files.recorder import Recorder
from rtg.processes.interrupts import Interrupts
from rtg.run.plan import RunPlan
from rtg.run.progress import Display
from rtg.run.run_state import RunState

_POLL = 0.1  # [s]
_STOP_TIMEOUT = 4.0  # [s] that stop() waits for the end of a layer


class Generation:
    """Runs `_core.generate` on a thread, so that the calling thread can display and stop it.

    The generation goes on from the file `journal`.
    """

    def __init__(self, config: _core.Config, recorder: Recorder, journal: Path) -> None:
        self._config, self._recorder, self._journal = config, recorder, journal
        self._workers: int = config.run.workers
        self._engine = replay_function(config)
        self._progress: dict[str, Any] = {}
        self._stop = False
        self._report: str | None = None
        self._failure: BaseException | None = None
        self._thread = threading.Thread(target=self._generate, daemon=True)
        self._thread.start()

    def wait(self, seconds: float) -> bool:
        """Waits at most `seconds`; returns whether the generation has ended. Raises its error."""
        self._thread.join(seconds)
        if self._failure is not None:
            raise self._failure
        return not self._thread.is_alive()

    def stop(self) -> None:
        """Stops the generation at the end of the current layer of the search.

        If that takes longer than _STOP_TIMEOUT, this process will end by os._exit(1).
        """
        self._stop = True
        self._thread.join(_STOP_TIMEOUT)
        if self._thread.is_alive():
            # Its threads still use the interpreter, which therefore must not be finalised.
            atexit.register(os._exit, 1)

    def state(self) -> RunState:
        """Returns the current state of the generation."""
        return replace(RunState(), **self._progress, workers=self._workers)

    def report(self) -> dict[str, Any]:
        """Returns the report of the generation. To be called only after the end."""
        assert self._report is not None
        report: dict[str, Any] = json.loads(self._report)
        return report

    def _generate(self) -> None:
        try:
            self._report = _core.generate(
                self._config, self._on_rows, self._on_progress, self._journal, self._engine
            )
        except _core.JournalError as error:
            self._failure = RunError(str(error))
        except BaseException as error:
            self._failure = error

    def _on_rows(self, poses: Any, action: Any, next_poses: Any, success: Any, source: Any) -> None:
        reward = success.astype(np.float32)
        self._recorder.add(Rows(poses, action, next_poses, reward, success, source))

    def _on_progress(self, progress: dict[str, Any]) -> None:
        self._progress = progress
        if self._stop:
            raise StoppedError


def generate(plan: RunPlan, display: Display) -> None:
    """Generates the transitions; writes generation.json and transitions.npz.

    Raises StoppedError on a signal, RunError if the journal cannot be written.
    """
    recorder = Recorder(plan.config)
    with Interrupts() as interrupts:
        generation = Generation(plan.config, recorder, plan.folder / run_folder.JOURNAL_FILE)
        try:
            while not generation.wait(_POLL):
                display.show(replace(generation.state(), budget=plan.interactions))
                interrupts.raise_if_requested()
        finally:
            generation.stop()
    report = {**generation.report(), row_digest.KEY: recorder.digest()}
    run_folder.write_json(plan.report_file, report, indent=None)
    recorder.finish(plan.transitions_file)
    display.show(replace(generation.state(), budget=plan.interactions))
