"""Ablations: settings that remove or change single parts of search and training."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rtg.run import effective_config
from rtg.run.run_args import Override

PAPER_PRESET = "train.preset=paper"
# Keys of `train` that are equal in all ablations, so that their figures can be compared.
_EVALUATION_KEYS = ("eval_every", "stop_at_success")
# Values of `search` that switch one part of it off, or set it to the other end of its range. They
# show how much the part contributes. TREE_ABLATIONS applies only to generators that grow trees.
BRANCH_ABLATIONS: dict[str, tuple[Any, ...]] = {
    "branches": (0,),
}
TREE_ABLATIONS: dict[str, tuple[Any, ...]] = {
    "plans_per_node": (1,),
    "whole_plan_share": (0, 1),
    "predecessors_per_solve": (1,),
    "root_draws": (1,),
    "patience": (1000,),  # no limit
}
# Groups of keys of `train` that only have a meaning together.
_KEY_GROUPS = (
    ("target_sync", "target_rate"),
    ("epsilon_start", "epsilon_end", "epsilon_share"),
)

Settings = tuple[str, ...]


def ablations(file: Path, common: Sequence[Override]) -> list[Settings]:
    """Returns the settings of each ablation of the task in `file`, in this order:

    - no change;
    - each part of the search switched off, if transitions are generated;
    - each value of `train` that differs from the preset `paper`, set to the value of `paper`;
    - the whole preset `paper`, unless it is in use already.

    `common` holds the overrides that all ablations share. Raises UserError.
    """
    values = effective_config.values(effective_config.load(file, common))
    current = values["train"]
    as_paper = effective_config.load(
        file, [Override(f"--set {PAPER_PRESET}", PAPER_PRESET), *common]
    )
    paper = effective_config.values(as_paper)["train"]
    evaluation = _settings(_EVALUATION_KEYS, current)
    of_search = search_ablations(values["search"]) if current["offline"] else []
    whole_preset = [] if current["preset"] == "paper" else [(PAPER_PRESET, *evaluation)]
    return [(), *of_search, *departures(current, paper), *whole_preset]


def search_ablations(search: dict[str, Any]) -> list[Settings]:
    """Returns the settings that switch off or change one part of the search each.

    Skips values that `search` has already.
    """
    alternatives = BRANCH_ABLATIONS | (
        TREE_ABLATIONS if search["generator"] in effective_config.TREE_GENERATORS else {}
    )
    return [
        (f"search.{key}={effective_config.as_typed(value)}",)
        for key, values in alternatives.items()
        for value in values
        if search[key] != value
    ]


def departures(current: dict[str, Any], paper: dict[str, Any]) -> list[Settings]:
    """Returns, for each difference of `current` from `paper`, the settings that undo it.

    Keys of one group of _KEY_GROUPS count as one difference.
    """
    found = dict[tuple[str, ...], Settings]()
    for key in current:
        if current[key] != paper[key] and key not in ("preset", *_EVALUATION_KEYS):
            group = next((keys for keys in _KEY_GROUPS if key in keys), (key,))
            found[group] = _settings(group, paper)
    return list(found.values())


def _settings(keys: Sequence[str], values: dict[str, Any]) -> Settings:
    return tuple(f"train.{key}={effective_config.as_typed(values[key])}" for key in keys)
