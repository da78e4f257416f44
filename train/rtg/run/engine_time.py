"""Says before a run how long the pushes of its forward simulator will take, if it is of Python."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.engines import simulator
from rtg.learn.evaluation import FINAL_FACTOR
from rtg.run.clock import duration

# Pushes simulated for each that is stored: 2.6 to 7.6 with `rrbs` in docs/results/tasks, mostly 4.
_PER_TRANSITION = 4.0
_BATCH = 64
_LONGEST = 1.0  # of the trial [s]


def meeting_pushes(task: _core.Task) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Returns states in which the robot is one push away from a loose body's centre, and the push.

    [N, bodies, 3], [N]. All pushes of the start if there are no such states.
    """
    every = np.arange(task.actions)
    ways = task.ways(every)
    loose = [i for i in range(1, len(task.fixed)) if not task.fixed[i]]
    states = np.repeat(task.start[None], len(loose) * len(every), 0)
    states[:, 0, :2] = np.concatenate([task.start[i, :2] - ways for i in loose] or [ways])
    legal = task.is_legal(states)
    if not legal.any():
        return np.repeat(task.start[None], len(every), 0), every
    return states[legal], np.tile(every, len(loose))[legal]


def push_seconds(config: _core.Config) -> float:
    """Returns how long a push that meets a body takes, one of a batch [s]."""
    states, actions = meeting_pushes(config.task)
    engine = simulator(config)

    def taken(count: int) -> float:
        some = np.linspace(0, len(states) - 1, count).astype(np.int64)
        began = time.perf_counter()
        engine.push(states[some], actions[some])
        return time.perf_counter() - began

    one = taken(1)  # which may start threads
    count = int(np.clip(_LONGEST / max(one, 1e-9), 1, _BATCH))
    return taken(count) / count


def words(config: _core.Config, transitions: int, interactions: int) -> list[str]:
    """Returns the time in words, a line; [] for a simulator of the core, which takes 0.1 ms."""
    if config.has_built_in_engine:
        return []
    push, train, name = push_seconds(config), config.train, config.forward.engine
    said = f"forward.engine {name}: {1000.0 * push:.2g} ms a push that meets a body"
    if transitions:
        pushes = _PER_TRANSITION * transitions
        said += f"; about {pushes:,.0f} for the transitions, {duration(pushes * push)}"
    if interactions and train.interact and train.learner != "planning":
        episodes = train.eval_episodes * (interactions / train.eval_every + FINAL_FACTOR)
        pushes = interactions + episodes * config.task.horizon
        said += f"; up to {pushes:,.0f} for learning, {duration(pushes * push)}"
    return [said]
