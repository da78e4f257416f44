"""Turns the events of a run into what a recording shows."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from rtg import _core
from rtg.files import replay_gaps
from rtg.files.dataset import SOURCES, Rows
from rtg.view import figures, scene, trees
from rtg.view.player import Player
from rtg.view.run_events import BestEpisode, Evaluation, Event, Gaps, Ints, Steps
from rtg.view.step_tree import StepTree

Bools = NDArray[np.bool_]

_BRANCH = SOURCES.index("branch")


def deepest_shown(config: _core.Config) -> int:
    """Returns the depth that gets the last colour: the largest that a tree of the run may have."""
    return max(2, min(config.search.depth, config.task.horizon))


class _Figures(NamedTuple):
    """The newest figures of the run, for the words on its state."""

    gaps: tuple[float, float] | None = None  # [m], median and 90th percentile
    success: float = float("nan")
    interactions: int = 0


class RunView:
    """Logs the events of one run to `recording`.

    `push`: duration of a push on the time line [s].
    """

    def __init__(self, recording: rr.RecordingStream, config: _core.Config, push: float) -> None:
        self._recording, self._config, self._task = recording, config, config.task
        self._tree = StepTree(config.task.bodies)
        self._taken: Bools = np.zeros(0, bool)  # of each transition: whether it has been logged
        self._deepest = deepest_shown(config)
        self._figures = _Figures()
        self._said = ""
        self.generation = ""  # its state in words
        self.player = Player(self._task, push, self._show, self._say)
        recording.set_log_time_enabled(False)
        recording.set_log_tick_enabled(False)
        scene.log_scene(recording, self._task)
        start = np.array(self._task.start)
        scene.log_poses(recording, self._task, np.zeros(1), start[None])
        scene.log_caption(recording, self._task, 0.0, "nominal start")
        figures.log_curve_styles(recording)
        if config.train.offline:
            trees.log_legend(recording, self._task, self._deepest)

    def take(self, event: Event) -> None:
        """Logs an event."""
        if not isinstance(event, Steps):
            self._log_steps(event.at, self._tree.rest())
        match event:
            case Steps():
                self._take_steps(event)
            case Evaluation(at, row):
                figures.log_evaluation(self._recording, at, row)
                if np.isfinite(success := row.get("success_rate", np.nan)):
                    count = int(row["interactions"])
                    self._figures = self._figures._replace(success=success, interactions=count)
            case Gaps(at, gaps):
                figures.log_gaps(self._recording, at, gaps.tolist())
                median, p90 = np.percentile(gaps, [50, 90])
                self._figures = self._figures._replace(gaps=(float(median), float(p90)))
            case BestEpisode():
                self._take_episode(event)
        self.say_state(event.at)

    def count_interactions(self, interactions: int) -> None:
        """Takes the number of interactions of the learner so far."""
        self._figures = self._figures._replace(interactions=interactions)

    def say_state(self, at: float) -> None:
        """Shows the state of the run in words at time `at` [s], if they have changed."""
        words = self._words()
        if words != self._said:
            self._said = words
            figures.log_state(self._recording, at, words)

    def _take_steps(self, event: Steps) -> None:
        rows = self._new(event)
        steps = Rows._make(column[rows.source != _BRANCH] for column in rows)
        if not len(steps.action):
            return
        settled = self._tree.add(steps)
        self._log_steps(event.at, settled)
        depths = self._tree.depths[settled]
        if depths.max(initial=0) > 1:
            plan = self._tree.plan(int(settled[depths.argmax()]))
            self.player.offer(plan, f"plan of the data, {len(plan) - 1} pushes")

    def _log_steps(self, at: float, steps: Ints) -> None:
        if len(steps):
            trees.log_steps(self._recording, self._task, at, self._tree, steps, self._deepest)

    def _new(self, event: Steps) -> Rows:
        """Returns those rows, by number, that have not been taken before; some come twice."""
        numbers, places = np.unique(event.numbers, return_index=True)
        missing = int(numbers[-1]) + 1 - len(self._taken)
        if missing > 0:
            self._taken = np.concatenate([self._taken, np.zeros(missing, bool)])
        fresh = places[~self._taken[numbers]]
        self._taken[numbers] = True
        return Rows._make(column[fresh] for column in event.rows)

    def _take_episode(self, event: BestEpisode) -> None:
        end = "success after" if event.success else "not solved in"
        origin = "best episode" if event.is_learned else "plan of the data, replayed"
        self.player.offer(event.states, f"{origin}: {end} {len(event.states) - 1} pushes")

    def _show(self, times: scene.Floats, states: scene.Floats) -> None:
        scene.log_poses(self._recording, self._task, times, states)

    def _say(self, at: float, words: str) -> None:
        scene.log_caption(self._recording, self._task, at, words)

    def _words(self) -> str:
        run, now = self._config.run, self._figures
        lines = [f"**{self._task.name}**, {run.method}, seed {run.seed}", ""]
        if self.generation:
            lines.append(f"- {self.generation}")
        if stored := int(self._taken.sum()):
            steps, deepest = len(self._tree.depths), int(self._tree.depths.max(initial=0))
            lines.append(
                f"- {stored:,} transitions, {steps:,} of them steps, up to {deepest} from success "
                "(the colours of moves)"
            )
        if now.gaps is not None:
            lines.append(
                f"- replay gap: median {now.gaps[0]:.2g}, 90 % below {now.gaps[1]:.2g} "
                f"[{replay_gaps.UNIT}]"
            )
        if now.interactions:
            success = "" if np.isnan(now.success) else f", success {now.success:.2f}"
            lines.append(f"- {now.interactions:,} interactions{success}")
        return "\n".join(lines)
