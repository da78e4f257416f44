"""A training run: take transitions in, interact, learn, evaluate, write down."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rtg import _core
from rtg.envs.curriculum import Curriculum
from rtg.envs.vector_env import PushVecEnv
from rtg.errors import RunError, UserError
from rtg.files import checkpoint, run_folder
from rtg.learn import device, networks, policy_file, training_result
from rtg.learn.clock import Clock
from rtg.learn.cloning import Cloning, imitated
from rtg.learn.ddqn import DoubleDqn
from rtg.learn.evaluation import FINAL, Evaluation, Floats, evaluate, held_out_starts
from rtg.learn.offline_data import OfflineData, Source, read_rows
from rtg.learn.settings import OF_CHECKPOINT
from rtg.learn.training_log import TrainingLog

MAX_ENVIRONMENTS = 4  # stepped together; the least legal train.buffer
_FORMAT = 6  # of the checkpoint; another one is not read
WAIT = 0.1  # [s], for transitions when there is nothing else to do

Stop = Callable[[], bool]


class Training:
    """The learner with everything around it, writing to a run folder.

    Once begun, learning does not wait for transitions that still come in. What it does next depends
    on its checkpoint, the transitions and at which step they come in: from a finished set, and from
    a stream that delivers alike, a resumed run goes on with the same bits. LCM does not deliver
    alike, so over it two runs of one seed may learn differently.

    Without `train.interact` learning waits for all transitions, and does its rounds without the
    interactions before them. Schedules and progress.csv count these all the same; the result has
    those of the environment: none.
    """

    def __init__(self, config: _core.Config, folder: Path) -> None:
        self.clock = Clock()
        self.config, self.task, self.folder = config, config.task, folder
        self.settings = s = config.train
        self.discount = s.discount or self.task.discount
        self.seed = seed = config.run.seed
        count = math.gcd(s.train_frequency, MAX_ENVIRONMENTS)
        jitter = max(s.start_jitter, self.task.randomisation) if s.randomise else s.start_jitter
        curriculum = Curriculum(config, s.curriculum, seed) if s.curriculum else None
        self.env = PushVecEnv(config, count, jitter, seed, curriculum)
        clones = s.learner == "cloning"
        self.model = (Cloning if clones else DoubleDqn)(self.env, s, self.discount, seed)
        chosen = {"chosen": imitated} if clones else {}
        self.data = OfflineData(self.task, self.model.replay_buffer, **chosen)
        self.log = TrainingLog(folder)
        fixed = {name: getattr(s, name) for name in OF_CHECKPOINT}
        self._identity = {
            "format": _FORMAT,
            "seed": seed,
            **fixed,
            **policy_file.identity(self.task, s),
        }
        self.starts = held_out_starts(self.task, s.eval_episodes, randomise=s.randomise)
        self.runs = 1  # that learn in this process
        self.place: dict[str, Any] = {}  # where it has last learned something
        self.tell: Callable[[str, int], None] = lambda state, done: None  # as NodeStatus.tick
        self._checkpoint = run_folder.checkpoint_file(folder)
        self._saved_at = 0  # interactions of the schedule
        self._saved_rows = 0  # offline transitions

    @property
    def scheduled(self) -> int:
        """Interactions so far by the schedule."""
        return self.model.num_timesteps

    @property
    def interactions(self) -> int:
        """Interactions with the environment so far."""
        return self.scheduled if self.settings.interact else 0

    @property
    def pushes(self) -> int:
        """Pushes of the simulator for learning: those of evaluations are not counted."""
        curriculum = self.env.curriculum
        return self.interactions + (curriculum.pushes if curriculum else 0)

    @property
    def done(self) -> bool:
        """Says whether the budget is used up or success has been high for long enough."""
        return self.scheduled >= self.settings.interactions or self._is_good()

    def _is_good(self) -> bool:
        bar, count = self.settings.stop_at_success, self.settings.stop_evaluations
        last = [row["success_rate"] for row in self.log.rows[-count:]]
        return bar > 0.0 and len(last) == count and min(last) >= bar

    def run(self, source: Source, stop: Stop, record: bool) -> bool:
        """Until learning is done and all transitions are in; False if `stop` said so before.

        Leaves a checkpoint either way. `record`: write what comes in to transitions.npz.
        """
        while not (stop() or source.complete or self._may_begin()):
            self._take_in(source, record, WAIT)
        if not self.done:
            self.place = self._here()
        self.clock.start(alone=self.runs == 1)
        while not (stop() or self.done):
            self._take_in(source, record, 0.0)
            self._learn()
            self._write_down()
        self.clock.stop()
        while not (stop() or source.complete):
            self._take_in(source, record, WAIT)
        self.save()
        return self.done and source.complete

    def _may_begin(self) -> bool:
        """Says whether learning can begin with some of the transitions."""
        return self.settings.interact and self.data.count >= self.settings.start_at

    def _learn(self) -> None:
        """A round."""
        if self.settings.interact:
            self.model.learn(self.settings.train_frequency, reset_num_timesteps=False)
        elif self.model.replay_buffer.size():
            self.model.learn_offline()
        else:
            raise RunError(f"{self.folder}: none of {self.data.count} transitions to learn from")

    def _here(self) -> dict[str, Any]:
        kind = self.model.device.type
        return {
            "device": device.name(kind),
            "precision": networks.precision(self.settings.reduced_precision, kind),
            "runs_in_process": self.runs,
        }

    def _take_in(self, source: Source, record: bool, timeout: float) -> None:
        news = not source.complete
        source.poll(timeout)  # also when complete: the stream is told so again and again
        if news:
            self.data.prove_bounds(source.complete)
            if source.complete and record:
                self.data.record.write(self._transition_files()[0])
        self.log.display(self._state())
        self.tell(self._activity(), self.scheduled)

    def _activity(self) -> str:
        """The words for what it does, and how well it did in the last evaluation."""
        if not self.clock.running:
            return "waiting"
        rows = self.log.rows
        return f"learning, success {rows[-1]['success_rate']:.2f}" if rows else "learning"

    def _write_down(self) -> None:
        """Evaluation and checkpoint, where they are due."""
        evaluated_at = self.log.rows[-1]["interactions"] if self.log.rows else 0
        over = self.scheduled >= self.settings.interactions > evaluated_at
        if over or self._is_due(self.settings.eval_every, evaluated_at):
            self._log_row(self.evaluate())
        if self._is_due(self.settings.checkpoint_every, self._saved_at):
            self.save()

    def _is_due(self, every: int, last: int) -> bool:
        return self.scheduled // every > last // every

    def evaluate(self) -> Evaluation:
        """The greedy policy on the held-out starts; changes nothing."""
        return self._evaluate(self.starts)

    def _evaluate(self, starts: Floats) -> Evaluation:
        return evaluate(self.config, self.model.greedy, starts, self.discount)

    def _log_row(self, evaluation: Evaluation) -> None:
        self.log.add(
            {
                "interactions": self.scheduled,
                "gradient_steps": self.model.gradient_steps_done,
                **evaluation.summary(),
                **self.model.recent_episodes(),
                "online_successes": self.env.successes,
                **({"epsilon": self.model.exploration_rate} if self.settings.interact else {}),
                **self._values_at_start(),
                **self.model.statistics.take(),
                "offline_transitions": self.data.count,
                "pushes": self.pushes,
                **self.clock.seconds(),
            }
        )
        self.log.display(self._state(), force=True)

    def _values_at_start(self) -> dict[str, float]:
        if self.settings.learner != "q_learning":
            return {}
        nominal = self.task.observation(self.task.start[None])
        return {"q_start_max": float(self.model.values(nominal).max())}

    def _state(self) -> dict[str, Any]:
        """The figures that a display shows; interactions of the schedule."""
        rows = self.log.rows
        return {
            "interactions": self.scheduled,
            "budget": self.settings.interactions,
            "transitions": self.data.count,
            "online_successes": self.env.successes,
            "success_rate": rows[-1]["success_rate"] if rows else None,
            "done": self.done,
        }

    def save(self) -> None:
        """Writes the checkpoint, and the transitions in hand as long as their file is not there."""
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
            "replay": self.model.replay_buffer.state(),
            "env": self.env.state(),
            "data": self.data.state(),
            "rows": self.log.rows,
            "seconds": self.clock.seconds(),
            "learner": self.place,
        }
        checkpoint.write(self._checkpoint, state)
        self._saved_at = self.scheduled

    def has_checkpoint(self) -> bool:
        return self._checkpoint.exists()

    def restore(self) -> None:
        """Goes back to the checkpoint in the run folder. Raises UserError if it does not fit."""
        path = self._checkpoint
        state = checkpoint.read(path)
        policy_file.check_identity(path, state.get("identity"), self._identity)
        rows = read_rows(self._seen_transitions(), self.task)
        self.data.restore(state["data"], rows)
        self.model.replay_buffer.restore(state["replay"])
        self.model.restore(state["model"])
        self.env.restore(state["env"])
        self.log.rows = state["rows"]
        self.log.write()
        self.clock.restore(state["seconds"])
        self.place = state["learner"]
        self._saved_at, self._saved_rows = self.scheduled, self.data.count

    def _transition_files(self) -> tuple[Path, Path]:
        """All of the run; those that were in at the checkpoint, while the former is not there."""
        return self.folder / "transitions.npz", self._checkpoint.parent / "transitions.npz"

    def _seen_transitions(self) -> Path:
        for path in self._transition_files():
            if path.exists():
                return path
        raise UserError(
            f"{path}: missing, the checkpoint beside it learned from these transitions; legal: "
            f"{self._checkpoint.parent} whole, or removed, to learn anew"
        )

    def finish(self, lost: int) -> None:
        """Writes the model, the best final episode and training.json.

        The final figures are of starts that no evaluation before has seen: training may have been
        stopped because those of the others went well by chance.
        """
        s = self.settings
        starts = held_out_starts(self.task, s.eval_episodes, FINAL, s.randomise)
        final = self._evaluate(starts)
        weights = self.model.mean_net.state_dict()
        policy_file.write(self.folder / "model.pt", self.task, s, weights)
        self.log.write_result(final, training_result.figures(self, final, lost))
        self.log.display(self._state(), force=True)
