"""Follows a run: by the files in its folder and, while it generates, by the messages on its bus."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rtg import _core
from rtg.bus.bus import defect
from rtg.bus.channel_monitor import SILENCE_LIMIT
from rtg.bus.stream_listener import StreamListener
from rtg.files.dataset import Rows
from rtg.run.progress import generation_text
from rtg.run.run_state import RunState
from rtg.run.run_watch import RunWatch
from rtg.run.training_watch import TrainingWatch
from rtg.view.activity import is_over
from rtg.view.run_events import Event, Ints, RunEvents, Steps
from rtg.view.run_view import RunView


class Heard:
    """Keeps what the bus of a run has told since the last call of its methods. It only listens."""

    def __init__(self, bus: _core.Bus, config: _core.Config) -> None:
        self._bus = bus
        self._watch = RunWatch(bus, RunState())
        self._rows: list[tuple[Ints, Rows]] = []
        task, most = config.task, config.search.transitions
        StreamListener(bus, task.bodies, task.actions, most, self._keep)

    def state(self) -> RunState:
        """Returns the state of the generation; `phase` is "" if it has not been heard of."""
        return self._watch.state

    def is_alive(self) -> bool:
        """Returns whether a process of the run tells something within SILENCE_LIMIT."""
        deadline = time.monotonic() + SILENCE_LIMIT
        while time.monotonic() - self._watch.heard_at > SILENCE_LIMIT:
            if (left := deadline - time.monotonic()) <= 0.0:
                return False
            self._bus.spin(left)
        return True

    def steps(self, at: float) -> list[Event]:
        """Returns the transitions heard meanwhile, as stored at time `at` [s]."""
        self._bus.spin(0.0)
        heard, self._rows = self._rows, []
        if not heard:
            return []
        numbers, rows = zip(*heard, strict=True)
        joined = Rows(*(np.concatenate(column) for column in zip(*rows, strict=True)))
        return [Steps(at, np.concatenate(numbers), joined)]

    def _keep(self, numbers: Ints, rows: Rows) -> None:
        self._rows.append((numbers, rows))


def why_unheard(folder: Path, config: _core.Config) -> str | None:
    """Returns why the bus of a run tells nothing that its folder does not; None if it may."""
    if is_over(folder) or (folder / "transitions.npz").is_file():
        return "its transitions are in the folder"
    if not config.train.offline:
        return "it generates no transitions"
    if config.run.in_process:
        return "with --in-process its transitions are seen once all are found"
    why = defect(config.run.bus)
    return why and f"its transitions are seen once all are found: {why}"


class Follower:
    """Logs the course of a run to a RunView, up to now.

    The clock shows the time since the run began. If the folder tells of something already, it
    starts at the last of that, as the run may have been stopped long ago.
    """

    def __init__(
        self,
        folder: Path,
        view: RunView,
        events: RunEvents,
        heard: Heard | None = None,
    ) -> None:
        self._folder, self._view, self._events, self._heard = folder, view, events, heard
        self._training = TrainingWatch(folder)
        self._begin = (folder / "config.yaml").stat().st_mtime
        self._first: list[Event] = events.new()
        if self._first:
            self._begin = time.time() - events.end

    def now(self) -> float:
        """Returns the time since the run began [s]."""
        return time.time() - self._begin

    def step(self) -> None:
        """Logs what is new."""
        now = self.now()
        found, self._first = [*self._first, *self._events.new()], []
        if self._heard is not None:
            found = [*self._heard.steps(now), *found]
        for event in found:
            self._view.take(event)
        self._tell_state()
        self._view.say_state(now)
        self._view.player.advance(now)

    def finish(self) -> None:
        """Logs what is new, and the last episode to its end."""
        self.step()
        self._view.player.advance(np.inf)

    def _tell_state(self) -> None:
        state = self._training.update(self._heard.state() if self._heard else RunState())
        self._view.generation = generation_text(state) if state.phase else ""
        if state.interactions:
            self._view.count_interactions(state.interactions)


def play_all(view: RunView, found: Sequence[Event]) -> None:
    """Logs the events of a finished run and plays its last episode."""
    for event in found:
        view.player.advance(event.at)
        view.take(event)
    view.player.advance(np.inf)
