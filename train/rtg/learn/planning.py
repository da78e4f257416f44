"""The rival that learns nothing: a beam search forwards from each start that it is judged by."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from itertools import takewhile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from rtg import _core
from rtg.files import checkpoint, run_folder
from rtg.learn import policy_file
from rtg.learn.evaluation import FINAL, Evaluation, Floats, held_out_starts
from rtg.learn.offline_data import Source
from rtg.learn.training_log import TrainingLog

_FORMAT = 2  # of the checkpoint
_TURN = threading.Lock()  # a search takes all workers, and the process's time is counted as its own


class Plan(NamedTuple):
    """The plan that a search found, and its cost."""

    states: Floats  # [T + 1, bodies, 3], the start alone if it found nothing
    pushes: int  # of the simulator
    wall_s: float
    cpu_s: float  # of all workers


def plan(config: _core.Config, start: Floats) -> Plan:
    """A function of the arguments, its seconds aside. start [bodies, 3]"""
    with _TURN:
        began, cpu = time.monotonic(), time.process_time()
        states, pushes = _core.plan(config, start[None])
        return Plan(states, pushes, time.monotonic() - began, time.process_time() - cpu)


def judged(task: _core.Task, plans: list[Plan], discount: float) -> Evaluation:
    """The plans as episodes of a policy: one without success, or beyond the horizon, takes all of
    it. At least one plan; paths are those of the plans."""
    actions = np.array([len(one.states) - 1 for one in plans])
    success = task.succeeded(np.stack([one.states[-1] for one in plans]))
    success &= (actions > 0) & (actions <= task.horizon)
    length = np.where(success, actions, task.horizon)
    discounted = np.where(success, discount ** (length - 1.0), 0.0)
    return Evaluation(success, length, discounted, [one.states for one in plans])


class Planning:
    """Plans from the final held-out starts, writing to a run folder as Training does.

    Resumed, it goes on with the next start.
    """

    def __init__(self, config: _core.Config, folder: Path) -> None:
        self.config, self.task = config, config.task
        self.settings = s = config.train
        self.discount = s.discount or self.task.discount
        self.starts = held_out_starts(self.task, s.eval_episodes, FINAL, s.randomise)
        self.plans: list[Plan] = []  # of the first starts
        self.log = TrainingLog(folder)
        self.runs = 1  # in this process
        self.scheduled = 0  # interactions
        self.tell: Callable[[str, int], None] = lambda state, done: None  # as NodeStatus.tick
        self._checkpoint = run_folder.checkpoint_file(folder)
        self._identity = {"learner": "planning", "format": _FORMAT}

    def run(self, source: Source, stop: Callable[[], bool], record: bool) -> bool:
        """Until all starts are planned from; False if `stop` said so before. A checkpoint follows
        each start. There is nothing to take in and to record."""
        del source, record
        self._display()
        while not self.done and not stop():
            self.plans.append(plan(self.config, self.starts[len(self.plans)]))
            self._save()
            self._display()
        return self.done

    @property
    def done(self) -> bool:
        """Says whether there is a plan, or none to be found, from each start."""
        return len(self.plans) == len(self.starts)

    def finish(self, lost: int) -> None:
        """Writes progress.csv, of one row, the best plan and training.json."""
        final = judged(self.task, self.plans, self.discount)
        wall, cpu = sum(one.wall_s for one in self.plans), sum(one.cpu_s for one in self.plans)
        pushes = sum(one.pushes for one in self.plans)
        figures = {
            "interactions": 0,
            "gradient_steps": 0,
            "online_successes": 0,
            **final.summary(),
            "offline_transitions": 0,
        }
        self.log.add({**figures, "pushes": pushes, "wall_s": wall, "cpu_s": cpu})
        figures |= {
            "train_wall_s": round(wall, 3),
            "train_cpu_s": round(cpu, 3),
            "lost_transitions": lost,
            "learning_pushes": pushes,
            "planned_starts": len(self.plans),
        }
        self.log.write_result(final, figures)
        self._display()

    def _display(self) -> None:
        """training_state.json, with the success so far."""
        found = judged(self.task, self.plans, self.discount) if self.plans else None
        state = {
            "interactions": 0,
            "budget": self.settings.interactions,
            "transitions": 0,
            "online_successes": 0,
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
        """Takes over the plans of the checkpoint as far as their starts are those of this run.

        Raises UserError if it is another learner's.
        """
        state = checkpoint.read(self._checkpoint)
        policy_file.check_identity(self._checkpoint, state.get("identity"), self._identity)
        known = [Plan(**{**one, "states": np.asarray(one["states"])}) for one in state["plans"]]
        pairs: Any = zip(known, self.starts, strict=False)
        same = takewhile(lambda pair: np.array_equal(pair[0].states[0], pair[1]), pairs)
        self.plans = [one for one, _ in same]
