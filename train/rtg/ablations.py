"""What each departure of the preset `default` from `paper` is worth: the reference without it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from rtg import effective_config
from rtg.run_args import Override

PAPER = "train.preset=paper"
# What decides how learning is measured, not how it goes.
_OF_MEASUREMENT = ("preset", "eval_every", "stop_at_success")
# Keys that mean something only with each other.
_TOGETHER = (
    ("target_sync", "target_rate"),
    ("epsilon_start", "epsilon_end", "epsilon_share"),
)

Settings = tuple[str, ...]


def ablations(file: Path) -> list[Settings]:
    """Of the cells of a task: nothing changed; one departure after the other, as in the paper; the
    whole preset `paper`. Raises UserError."""
    ours = effective_config.values(file)["train"]
    paper = effective_config.values(file, [Override(f"--set {PAPER}", PAPER)])["train"]
    return [(), *departures(ours, paper), (PAPER,)]


def departures(ours: dict[str, Any], paper: dict[str, Any]) -> list[Settings]:
    """The settings that take back what `ours` does otherwise than `paper`, one by one."""
    found = dict[tuple[str, ...], Settings]()
    for key in ours:
        if ours[key] != paper[key] and key not in _OF_MEASUREMENT:
            group = next((keys for keys in _TOGETHER if key in keys), (key,))
            found[group] = tuple(f"train.{name}={json.dumps(paper[name])}" for name in group)
    return list(found.values())
