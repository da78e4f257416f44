"""One view of a run: where it is logged to, and how far."""

from __future__ import annotations

import functools
from collections.abc import Callable
from pathlib import Path

import rerun as rr

from rtg import _core
from rtg.bus.bus import listen
from rtg.files.run_folder import config_file, run_name
from rtg.run.effective_config import load_recorded
from rtg.view import activity, follower
from rtg.view.layout import following, layout, playing
from rtg.view.run_events import RunEvents
from rtg.view.run_view import RunView

_PUSH = 0.5  # [s], duration of a push as it is seen
_FILM = 60.0  # [s], in which a finished run plays, without its last episode


class Session:
    """Logs one run to `recording`: all of it at once, or what is new at each step.

    Raises UserError if `folder` is not that of a run.
    """

    def __init__(self, folder: Path, say: Callable[[str], None]) -> None:
        self._folder, self._config = folder, load_recorded(config_file(folder))
        self._say = say
        self.recording = rr.RecordingStream("rtg")
        self.recording.send_recording_name(folder.resolve().name)
        self._bus: _core.Bus | None = None
        self._follower: follower.Follower | None = None

    def is_over(self) -> bool:
        """Returns whether the run has ended."""
        return activity.is_over(self._folder)

    def is_going_on(self) -> bool:
        """Returns whether the run has not ended and a process works on it."""
        return activity.is_going_on(
            self._folder, lambda: self._heard is not None and self._heard.is_alive()
        )

    def state(self) -> str:
        """Returns what is known of a run that has not ended, in words."""
        return activity.state(self._folder)

    def begin(self, follow: bool) -> None:
        """Lays out the panels and logs what the folder holds. Raises UserError or RunError.

        `follow`: further steps will log what is new. Else the run plays from its begin.
        """
        events = RunEvents(self._folder, self._config)
        if not follow:
            self._play(events)
            return
        heard = self._heard
        self.recording.send_blueprint(layout(self._config, following()))
        view = RunView(self.recording, self._config, _PUSH)
        self._follower = follower.Follower(self._folder, view, events, heard)

    def step(self) -> None:
        """Logs what is new, if it follows the run."""
        if self._follower is not None:
            self._follower.step()

    def finish(self) -> None:
        """Logs what is left of a run that it follows, its last episode to the end."""
        if self._follower is not None:
            self._follower.finish()

    def close(self) -> None:
        """Ends the recording."""
        if self._bus is not None:
            self._bus.unsubscribe()
        self.recording.flush()
        self.recording.disconnect()

    @functools.cached_property
    def _heard(self) -> follower.Heard | None:
        """What is heard of the run from now on; None if there is nothing to be heard."""
        if why := follower.why_unheard(self._folder, self._config):
            self._say(f"not listening to the run: {why}")
            return None
        name = run_name(self._folder)
        self._bus = listen(self._config.run.bus, name)
        heard = follower.Heard(self._bus, self._config)
        if self._bus.warning:
            self._say(self._bus.warning)
        self._say(f"listening to the run {name}")
        return heard

    def _play(self, events: RunEvents) -> None:
        found = events.new()
        speed = max(1.0, events.end / _FILM)
        self.recording.send_blueprint(layout(self._config, playing(speed)))
        follower.play_all(RunView(self.recording, self._config, speed * _PUSH), found)
