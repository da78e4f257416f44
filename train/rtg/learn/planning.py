"""The baseline without learning: a forward beam search from each start of the evaluation."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from itertools import takewhile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from rtg import _core, errors
from rtg.engines import Replay, replay_function
from rtg.files import checkpoint, run_folder
from rtg.learn import policy_file
from rtg.learn.evaluation import Evaluation, Floats, final_starts
from rtg.learn.offline_data import Source
from rtg.learn.training_log import TrainingLog

_FORMAT = 2  # version of the checkpoint format
# Allows one search at a time: it uses all workers, and cpu_s measures the whole process.
_SEARCH_LOCK = threading.Lock()


class Plan(NamedTuple):
    """The plan that a search found, and its cost."""

    states: Floats  # [T + 1, bodies, 3]; only the start if no plan was found
    pushes: int  # number of simulated pushes
    wall_s: float
    cpu_s: float  # of all workers


def plan(config: _core.Config, start: Floats, replay: Replay | None) -> Plan:
    """Searches for a plan from `start` [bodies, 3] and measures its cost. `replay`: of the engine.

    Equal arguments give equal plans, except for the times.
    """
    with _SEARCH_LOCK:
        began, cpu = time.monotonic(), time.process_time()
        states, pushes = _core.plan(config, start[None], replay)
        return Plan(states, pushes, time.monotonic() - began, time.process_time() - cpu)


def evaluate_plans(task: _core.Task, plans: list[Plan], discount: float) -> Evaluation:
    """Evaluates `plans`, at least one, as if they were episodes of a policy.

    A plan that fails, or is longer than the horizon, is a failure with the length of the horizon.
    """
    actions = np.array([len(one.states) - 1 for one in plans])
    success = task.succeeded(np.stack([one.states[-1] for one in plans]))
    success &= (actions > 0) & (actions <= task.horizon)
    length = np.where(success, actions, task.horizon)
    discounted = np.where(success, discount ** (length - 1.0), 0.0)
    return Evaluation(success, length, discounted, [one.states for one in plans])


class Planning:
    """Plans from the first `train.eval_episodes` of the final_starts(), in place of Training.

    A resumed run continues with the next start.
    """

    def __init__(self, config: _core.Config, folder: Path) -> None:
        self.config, self.task = config, config.task
        self.settings = config.train
        self.discount = config.learner_discount
        self.starts = final_starts(config, config.train.eval_episodes)
        self.plans: list[Plan] = []  # one for each start so far
        self._replay = replay_function(config)
        self.log = TrainingLog(folder)
        self.runs = 1  # number of runs in this process
        self.scheduled_interactions = 0  # number of interactions, as in Training
        # NodeStatus.tick, if there is a bus.
        self.publish_status: Callable[[str, int], None] = lambda state, done: None
        self._checkpoint = run_folder.checkpoint_file(folder)
        self._identity = {"learner": "planning", "format": _FORMAT}

    def run(self, source: Source, stop: Callable[[], bool], record: bool) -> bool:
        """Plans from the remaining starts until `stop` returns True; returns whether all are done.

        Writes a checkpoint after each start. Ignores `source` and `record`.
        """
        del source, record
        self._display()
        while not self.done and not stop():
            self.plans.append(plan(self.config, self.starts[len(self.plans)], self._replay))
            self._save()
            self._display()
        return self.done

    @property
    def done(self) -> bool:
        """True if a search from each start has ended, with or without a plan."""
        return len(self.plans) == len(self.starts)

    def finish(self) -> None:
        """Writes progress.csv with one row, the best plan and training.json."""
        final = evaluate_plans(self.task, self.plans, self.discount)
        wall, cpu = sum(one.wall_s for one in self.plans), sum(one.cpu_s for one in self.plans)
        pushes = sum(one.pushes for one in self.plans)
        figures = {
            "interactions": 0,
            "gradient_steps": 0,
            "online_successes": 0,
            **final.summary(),
            "offline_transitions": 0,
        }
        times = {"wall_s": wall, "cpu_s": cpu, "evaluation_cpu_s": 0.0}  # nothing but plans
        self.log.add({**figures, "pushes": pushes, **times})
        figures |= {
            "train_wall_s": round(wall, 3),
            "train_cpu_s": round(cpu, 3),
            "learning_pushes": pushes,
            "final_episodes": len(self.plans),
        }
        self.log.write_result(final, figures)
        self._display()

    def _display(self) -> None:
        """Writes training_state.json with the success rate so far."""
        found = evaluate_plans(self.task, self.plans, self.discount) if self.plans else None
        state = {
            "interactions": 0,
            "budget": self.settings.interactions,
            "transitions": 0,
            "online_successes": 0,
            "evaluations": 0,
            "success_rate": float(found.success.mean()) if found else None,
            "done": self.done,
        }
        self.log.display(state, force=True)

    def _save(self) -> None:
        self._checkpoint.parent.mkdir(exist_ok=True)
        plans = [one._asdict() for one in self.plans]
        checkpoint.write(self._checkpoint, {"identity": self._identity, "plans": plans})

    def has_checkpoint(self) -> bool:
        return self._checkpoint.exists()

    def restore(self) -> None:
        """Restores the plans of the checkpoint, up to the first with a start that differs now.

        Raises UserError if another learner wrote the checkpoint.
        """
        state = checkpoint.read(self._checkpoint)
        policy_file.check_identity(self._checkpoint, state.get("identity"), self._identity)
        with errors.fields_of(self._checkpoint):
            known = [Plan(**{**one, "states": np.asarray(one["states"])}) for one in state["plans"]]
            pairs: Any = zip(known, self.starts, strict=False)
            same = takewhile(lambda pair: np.array_equal(pair[0].states[0], pair[1]), pairs)
            self.plans = [one for one, _ in same]
