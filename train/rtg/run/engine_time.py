"""Says before a run how long the pushes of its forward simulator will take, if it is a slow one."""

from __future__ import annotations

import time

import numpy as np

from rtg import _core
from rtg.engines import simulator
from rtg.run.clock import duration

# Pushes simulated for each that is stored: 2.6 to 5.9 in docs/results/tasks.
_PER_TRANSITION = 4.0
_BATCH = 64


def push_seconds(config: _core.Config) -> float:
    """Returns how long a push that meets a body takes, one of a batch [s].

    The robot is pushed towards the nearest object of the start; the time is that of a stride.
    """
    task = config.task
    offsets = task.start[1:, :2] - task.start[0, :2]
    way = offsets[np.linalg.norm(offsets, axis=1).argmin()]
    ways = way * np.linspace(0.95, 1.05, _BATCH)[:, None]
    states = np.repeat(task.start[None], _BATCH, 0)
    engine = simulator(config)
    engine.push_along(states[:1], ways[:1])  # the first push may start threads
    began = time.perf_counter()
    engine.push_along(states, ways)
    taken = time.perf_counter() - began
    stride = np.linalg.norm(task.ways(np.arange(task.actions)), axis=1).max()
    return taken / _BATCH * float(stride / np.linalg.norm(way))


def words(config: _core.Config, transitions: int, interactions: int) -> list[str]:
    """Returns the time in words, a line; [] for a simulator of the core, which takes 0.1 ms."""
    if config.has_built_in_engine:
        return []
    push, train = push_seconds(config), config.train
    pushes = _PER_TRANSITION * transitions
    evaluated = train.eval_episodes * config.task.horizon / train.eval_every
    learning = interactions * (1.0 + evaluated)
    return [
        f"forward.engine {config.forward.engine}: {1000.0 * push:.2g} ms a push that meets a body; "
        f"about {pushes:,.0f} pushes for the transitions, {duration(pushes * push)}, and at most "
        f"{learning:,.0f} for learning, {duration(learning * push)}"
    ]
