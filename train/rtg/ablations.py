"""What each part of the recipe is worth: the reference without it."""

from __future__ import annotations

import itertools
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rtg import effective_config
from rtg.run_args import Override

PAPER = "train.preset=paper"
# How learning is watched and ended: alike for all, so that their figures can be compared.
_ALIKE = ("eval_every", "stop_at_success")
# Data that are found forwards from starts, beside those of trees.
_FORWARDS = ("mended", "rollout_share")
# Keys that mean something only with each other.
_TOGETHER = (
    ("target_sync", "target_rate"),
    ("epsilon_start", "epsilon_end", "epsilon_share"),
)

Settings = tuple[str, ...]


def ablations(file: Path, common: Sequence[Override]) -> list[Settings]:
    """Of the cells of a task: nothing changed; without mended episodes, roll-outs, both; each
    departure of the preset `default` as `paper` has it; the whole preset `paper`. common: what else
    all of them are set to. Raises UserError."""
    values = effective_config.values(file, common)
    ours, search = values["train"], values["search"]
    paper = effective_config.values(file, [Override(f"--set {PAPER}", PAPER), *common])["train"]
    alike = _settings(_ALIKE, ours)
    searched = ours["offline"] and search["reverse"] != "random"
    kept = [key for key in _FORWARDS if searched and search[key]]
    data = [tuple(f"search.{key}=0" for key in keys) for keys in _subsets(kept)]
    as_paper = [] if ours["preset"] == "paper" else [(PAPER, *alike)]
    return [(), *data, *departures(ours, paper), *as_paper]


def departures(ours: dict[str, Any], paper: dict[str, Any]) -> list[Settings]:
    """The settings that take back what `ours` does otherwise than `paper`, one by one."""
    found = dict[tuple[str, ...], Settings]()
    for key in ours:
        if ours[key] != paper[key] and key not in ("preset", *_ALIKE):
            group = next((keys for keys in _TOGETHER if key in keys), (key,))
            found[group] = _settings(group, paper)
    return list(found.values())


def _subsets(keys: Sequence[str]) -> list[tuple[str, ...]]:
    """None of them empty, the small ones first."""
    sizes = range(1, len(keys) + 1)
    return [some for size in sizes for some in itertools.combinations(keys, size)]


def _settings(keys: Sequence[str], values: dict[str, Any]) -> Settings:
    return tuple(f"train.{key}={json.dumps(values[key])}" for key in keys)
