"""The configuration of a task, read as users of the package name it."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

from rtg import _core, paths
from rtg.errors import UserError


def read_config(
    config: _core.Config | str | Path | None, settings: Sequence[str] = ()
) -> _core.Config:
    """Returns the configuration that is meant: itself, or that of a task's name, file or text.

    A text has several lines. Raises ValueError for None and for a bad file, text or setting.
    """
    if isinstance(config, _core.Config):
        return config
    if not isinstance(config, str | PathLike):
        wrong = "is missing" if config is None else f"is {config!r:.80}"
        raise ValueError(
            f"config {wrong}; legal: config= with the name of a task, the path or the text of a "
            "YAML file, or a configuration"
        )
    if isinstance(config, str) and "\n" in config:
        return _core.Config.from_text(config, overrides=list(settings))
    try:
        file = paths.task_file(config) if isinstance(config, str) else config
    except UserError as error:
        raise ValueError(str(error)) from None
    return _core.Config.from_file(file, list(settings))
