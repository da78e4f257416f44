"""The Gymnasium environment that a run's transitions are steps of."""

from __future__ import annotations

from typing import Any

import gymnasium

from rtg import _core
from rtg.run import effective_config
from rtg.task_config import read_config

_SECTIONS = ("task", "physics", "forward")  # of a configuration: what an environment consists of


def _content(config: _core.Config) -> list[Any]:
    values = effective_config.values(config)
    return [values[section] for section in _SECTIONS]


def environment_of(config: _core.Config) -> gymnasium.Env[Any, Any]:
    """Makes the environment of a run, whose spec is text and makes it again anywhere.

    It is the registered one of the task. If that differs in task or physics, it is RTG/Task-v0 with
    the whole configuration in its spec.
    """
    for spec in gymnasium.registry.values():
        name = spec.kwargs.get("config")
        is_of_task = spec.namespace == "RTG" and name == config.task.name
        if is_of_task and _content(read_config(config.task.name)) == _content(config):
            return gymnasium.make(spec.id)
    return gymnasium.make("RTG/Task-v0", config=config.yaml)
