"""A training run: receives transitions, interacts, learns, evaluates and writes the results."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rtg import _core, errors
from rtg.envs.curriculum import Curriculum
from rtg.envs.training_environments import TrainingEnvironments
from rtg.errors import RunError, UserError
from rtg.files import checkpoint, run_folder
from rtg.learn import device, policy_file, training_result
from rtg.learn.clock import Clock
from rtg.learn.cloning import Cloning, imitated
from rtg.learn.ddqn import DoubleDqn
from rtg.learn.evaluation import (
    FINAL_FACTOR,
    Evaluation,
    Floats,
    evaluate,
    final_starts,
    held_out_starts,
)
from rtg.learn.offline_data import OfflineData, Source, read_rows
from rtg.learn.settings import CHECKPOINT_SETTINGS
from rtg.learn.training_log import TrainingLog

MAX_ENVIRONMENTS = 4  # stepped together at most; train.buffer must not be smaller
_FORMAT = 10  # version of the checkpoint format; other versions are rejected
POLL_TIMEOUT = 0.1  # [s], how long a poll waits for transitions while not learning

Stop = Callable[[], bool]


class Training:
    """A training run: the learner with its environments and its data. Writes to a run folder.

    Once learning has begun, it does not wait for further transitions. Its course depends on the
    step at which each transition arrives. So a resumed run continues bit for bit if the transition
    set is finished. Over LCM arrival times vary, so two runs with one seed may differ.

    Without `train.interact`, learning waits for all transitions, and its rounds have no
    interactions. Schedules and progress.csv count the interactions all the same. training.json
    holds their true number, 0.
    """

    def __init__(self, config: _core.Config, folder: Path) -> None:
        self.clock = Clock()
        self.config, self.task, self.folder = config, config.task, folder
        self.settings = s = config.train
        self.discount = config.learner_discount
        self.seed = seed = config.run.seed
        count = math.gcd(s.train_frequency, MAX_ENVIRONMENTS)
        curriculum = Curriculum(config, s.curriculum, seed) if s.curriculum else None
        self.env = TrainingEnvironments(config, count, config.training_jitter, seed, curriculum)
        clones = s.learner == "cloning"
        self.model = (Cloning if clones else DoubleDqn)(self.env, s, self.discount, seed)
        selection = {"select": imitated} if clones else {}
        self.model.threads = config.run.workers
        self.data = OfflineData(config, self.model.replay, **selection)
        self.log = TrainingLog(folder)
        fixed = {name: getattr(s, name) for name in CHECKPOINT_SETTINGS}
        self._identity = {
            "format": _FORMAT,
            "seed": seed,
            **policy_file.identity(self.task, s),
            **fixed,
        }
        self.runs = 1  # number of runs that learn in this process
        # Device of the last period of learning, see _current_device_info().
        self.device_info: dict[str, Any] = {}
        # NodeStatus.tick, if there is a bus.
        self.publish_status: Callable[[str, int], None] = lambda state, done: None
        self._checkpoint = run_folder.checkpoint_file(folder)
        self._saved_at = 0  # `scheduled_interactions` at the last save
        self._saved_rows = 0  # offline transitions at the last save

    @property
    def scheduled_interactions(self) -> int:
        """Number of interactions so far as schedules count them, also without `train.interact`."""
        return self.model.interactions

    @property
    def interactions(self) -> int:
        """Number of interactions with the environment so far; 0 without `train.interact`."""
        return self.scheduled_interactions if self.settings.interact else 0

    @property
    def pushes(self) -> int:
        """Number of simulated pushes for learning; those of evaluations do not count."""
        curriculum = self.env.curriculum
        return self.interactions + (curriculum.pushes if curriculum else 0)

    @property
    def done(self) -> bool:
        """True if the budget is used up or the last evaluations reached `stop_at_success`."""
        return (
            self.scheduled_interactions >= self.settings.interactions or self._has_lasting_success()
        )

    def _has_lasting_success(self) -> bool:
        bar, count = self.settings.stop_at_success, self.settings.stop_evaluations
        last = [row["success_rate"] for row in self.log.rows[-count:]]
        return bar > 0.0 and len(last) == count and min(last) >= bar

    def run(self, source: Source, stop: Stop, record: bool) -> bool:
        """Learns and receives transitions until both are complete or `stop` returns True.

        Writes a checkpoint at the end and returns whether both are complete. If `record`, writes
        transitions.npz when all transitions have arrived.
        """
        while not (stop() or source.complete or self._may_begin()):
            self._receive(source, record, POLL_TIMEOUT)
        if not self.done:
            self.device_info = self._current_device_info()
        if self.runs > 1:
            self.model.share_process()
        self.clock.start(alone=self.runs == 1)
        while not (stop() or self.done):
            with self.model.stages["receiving"]:
                self._receive(source, record, 0.0)
            self._learn()
            self._evaluate_and_save()
        self.clock.stop()
        while not (stop() or source.complete):
            self._receive(source, record, POLL_TIMEOUT)
        self.save()
        return self.done and source.complete

    def _may_begin(self) -> bool:
        """Returns whether learning can begin before all transitions have arrived."""
        return (
            self.settings.interact and self.data.count >= self.settings.transitions_before_learning
        )

    def _learn(self) -> None:
        """Performs one round of learning. Raises RunError if there is nothing to learn from."""
        if self.settings.interact:
            self.model.learn()
        elif self.model.replay.size():
            self.model.learn_offline()
        else:
            raise RunError(
                f"{self.folder}: none of the {self.data.count} transitions can be learned from"
            )

    def _current_device_info(self) -> dict[str, Any]:
        return {"device": device.name(self.model.device), "runs_in_process": self.runs}

    def _receive(self, source: Source, record: bool, timeout: float) -> None:
        news = not source.complete
        source.poll(timeout)  # also when complete, to repeat the final acknowledgement
        if news:
            self.data.refresh_bounds_if_grown(source.complete)
            if source.complete and record:
                self.data.record.finish(self._transition_files()[0])
        self.log.display(self._display_state())
        self.publish_status(self._activity(), self.scheduled_interactions)

    def _activity(self) -> str:
        """Describes the current activity and the last success rate, for people."""
        if not self.clock.running:
            return "waiting"
        rows = self.log.rows
        return f"learning, success {rows[-1]['success_rate']:.2f}" if rows else "learning"

    def _evaluate_and_save(self) -> None:
        """Evaluates if an evaluation is due; writes a checkpoint if a checkpoint is due."""
        evaluated_at = self.log.rows[-1]["interactions"] if self.log.rows else 0
        over = self.scheduled_interactions >= self.settings.interactions > evaluated_at
        if over or self._is_due(self.settings.eval_every, evaluated_at):
            with self.model.stages["evaluation"]:
                found = self.evaluate()
            self._log_row(found)
        if self._is_due(self.settings.checkpoint_every, self._saved_at):
            with self.model.stages["saving"]:
                self.save()

    def _is_due(self, every: int, last: int) -> bool:
        return self.scheduled_interactions // every > last // every

    def evaluate(self) -> Evaluation:
        """Evaluates the greedy policy from starts of its own; changes no state of the learner."""
        return self._evaluate(held_out_starts(self.config, number=len(self.log.rows)))

    def _evaluate(self, starts: Floats) -> Evaluation:
        return evaluate(self.config, self.model.values, starts, self.discount)

    def _log_row(self, evaluation: Evaluation) -> None:
        self.log.add(
            {
                "interactions": self.scheduled_interactions,
                "gradient_steps": self.model.gradient_steps,
                **evaluation.summary(),
                **self.model.recent_episodes(),
                "online_successes": self.env.successes,
                **({"epsilon": self.model.exploration_rate} if self.settings.interact else {}),
                **self._values_at_start(),
                **self.model.statistics.pop(),
                "offline_transitions": self.data.count,
                "pushes": self.pushes,
                **self.clock.seconds(),
                "evaluation_cpu_s": self.model.stages["evaluation"].cpu_s,
            }
        )
        self.log.display(self._display_state(), force=True)

    def _values_at_start(self) -> dict[str, float]:
        if self.settings.learner != "q_learning":
            return {}
        nominal = self.task.observation(self.task.start[None])
        return {"q_start_max": float(self.model.values(nominal).max())}

    def _display_state(self) -> dict[str, Any]:
        """Returns the figures for displays; "interactions" is `scheduled_interactions`."""
        rows = self.log.rows
        return {
            "interactions": self.scheduled_interactions,
            "budget": self.settings.interactions,
            "transitions": self.data.count,
            "online_successes": self.env.successes,
            "evaluations": len(rows),
            "success_rate": rows[-1]["success_rate"] if rows else None,
            "done": self.done,
        }

    def save(self) -> None:
        """Writes the checkpoint.

        Until transitions.npz exists, also writes the transitions so far, next to the checkpoint.
        """
        self._checkpoint.parent.mkdir(exist_ok=True)
        whole, part = self._transition_files()
        if whole.exists():
            part.unlink(missing_ok=True)
        elif self.data.count > self._saved_rows or not part.exists():
            self.data.record.write(part)
            self._saved_rows = self.data.count
        state = {
            "identity": self._identity,
            "model": self.model.state(),
            "replay": self.model.replay.state(),
            "env": self.env.state(),
            "data": self.data.state(),
            "rows": self.log.rows,
            "seconds": self.clock.seconds(),
            "learner": self.device_info,
        }
        checkpoint.write(self._checkpoint, state)
        self._saved_at = self.scheduled_interactions

    def has_checkpoint(self) -> bool:
        return self._checkpoint.exists()

    def restore(self) -> None:
        """Restores the checkpoint of the run folder. Raises UserError if it does not fit."""
        path = self._checkpoint
        state = checkpoint.read(path)
        policy_file.check_identity(path, state.get("identity"), self._identity)
        rows = read_rows(self._seen_transitions(), self.task)
        with errors.fields_of(path):
            self.data.restore(state["data"], rows)
            self.model.replay.restore(state["replay"])
            self.model.restore(state["model"])
            self.env.restore(state["env"])
            self.log.rows = state["rows"]
            self.log.write()
            self.clock.restore(state["seconds"])
            self.device_info = state["learner"]
        self._saved_at, self._saved_rows = self.scheduled_interactions, self.data.count

    def _transition_files(self) -> tuple[Path, Path]:
        """Returns the path for all transitions, and the path for those at the checkpoint.

        save() removes the second file once the first one exists.
        """
        return self.folder / "transitions.npz", self._checkpoint.parent / "transitions.npz"

    def _seen_transitions(self) -> Path:
        for path in self._transition_files():
            if path.exists():
                return path
        raise UserError(
            f"{path}: is missing, but the checkpoint beside it learned from these transitions; "
            f"legal: {self._checkpoint.parent} complete, or removed, to learn anew"
        )

    def finish(self) -> None:
        """Writes the model, the best final episode and training.json.

        The final evaluation has starts of its own. Those of earlier evaluations would be biased: an
        evaluation with chance success may have stopped training.
        """
        episodes = FINAL_FACTOR * self.settings.eval_episodes
        final = self._evaluate(final_starts(self.config, episodes))
        weights = self.model.mean.state_dict()
        policy_file.write(self.folder / "model.pt", self.task, self.settings, weights)
        self.log.write_result(final, training_result.figures(self, final))
        self.log.display(self._display_state(), force=True)
