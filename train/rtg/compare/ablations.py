"""Ablations of the recipe: the reference without it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rtg.run import effective_config
from rtg.run.run_args import Override

PAPER = "train.preset=paper"
# How learning is watched and ended: alike for all, so that their figures can be compared.
_ALIKE = ("eval_every", "stop_at_success")
# What each part of the search is worth: values that take it away, or stand at the other end of its
# range.
OF_BRANCHES: dict[str, tuple[Any, ...]] = {
    "branches": (0,),
    "near_branches": (0,),
    "near_headings": (24,),  # of 48, either way: near is anywhere
}
OF_TREES: dict[str, tuple[Any, ...]] = {
    "followed": (1,),
    "plans": (0, 1),
    "contact_quota": (0,),
    "gap_tolerance": (0.05, 100),  # hardly any miss, any miss
    "starts": (1,),
    "free_moves": (0, 48),  # none, all
    "per_layout": (100000,),  # no limit
    "root_draws": (1,),
    "patience": (1000,),  # no limit
}
# Of `search`, with no ablation of their own: sizes, and what a method decides.
SIZES = ("transitions", "breadth", "depth")
DECIDED = ("generator", "randomise")
_TREES = ("rrbs", "naive")  # generators that grow trees
# Keys that mean something only with each other.
_TOGETHER = (
    ("target_sync", "target_rate"),
    ("epsilon_start", "epsilon_end", "epsilon_share"),
)

Settings = tuple[str, ...]


def ablations(file: Path, common: Sequence[Override]) -> list[Settings]:
    """The settings of the cells of a task: nothing changed; without each part of the search; each
    departure of the preset `default` as `paper` has it; the whole preset `paper`. common: what else
    all of them are set to. Raises UserError."""
    values = effective_config.values(effective_config.load(file, common))
    ours = values["train"]
    as_paper = effective_config.load(file, [Override(f"--set {PAPER}", PAPER), *common])
    paper = effective_config.values(as_paper)["train"]
    alike = _settings(_ALIKE, ours)
    data = parts_of_search(values["search"]) if ours["offline"] else []
    whole = [] if ours["preset"] == "paper" else [(PAPER, *alike)]
    return [(), *data, *departures(ours, paper), *whole]


def parts_of_search(search: dict[str, Any]) -> list[Settings]:
    """The settings that take each part of it away, one by one, but for those that it is without."""
    tried = OF_BRANCHES | (OF_TREES if search["generator"] in _TREES else {})
    return [
        (f"search.{key}={json.dumps(value)}",)
        for key, values in tried.items()
        for value in values
        if search[key] != value
    ]


def departures(ours: dict[str, Any], paper: dict[str, Any]) -> list[Settings]:
    """The settings that take back what `ours` does otherwise than `paper`, one by one."""
    found = dict[tuple[str, ...], Settings]()
    for key in ours:
        if ours[key] != paper[key] and key not in ("preset", *_ALIKE):
            group = next((keys for keys in _TOGETHER if key in keys), (key,))
            found[group] = _settings(group, paper)
    return list(found.values())


def _settings(keys: Sequence[str], values: dict[str, Any]) -> Settings:
    return tuple(f"train.{key}={json.dumps(values[key])}" for key in keys)
