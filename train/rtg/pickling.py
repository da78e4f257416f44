"""Makes objects of the core anew from their text, for pickle and copy."""

from __future__ import annotations

from rtg import _core


def config_of(yaml: str) -> _core.Config:
    return _core.Config.from_text(yaml)


def task_of(yaml: str) -> _core.Task:
    return _core.Config.from_text(yaml).task
