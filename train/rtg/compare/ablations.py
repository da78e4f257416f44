"""Ablations: settings that remove or change single parts of search and training."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rtg.run import effective_config
from rtg.run.run_args import Override

PAPER = "train.preset=paper"
# Keys of `train` that are equal in all cells, so that the figures of the cells can be compared.
_ALIKE = ("eval_every", "stop_at_success")
# Values of `search` that switch a part of it off or stand at the other end of its range: they show
# how much the part contributes. OF_TREES applies only to generators that grow trees.
OF_BRANCHES: dict[str, tuple[Any, ...]] = {
    "branches": (0,),
    "near_branches": (0,),
    "near_headings": (24,),  # of 48, to either side: all headings count as near
}
OF_TREES: dict[str, tuple[Any, ...]] = {
    "followed": (1,),
    "plans": (0, 1),
    "contact_quota": (0,),
    "gap_tolerance": (0.05, 100),  # keeps only steps with hardly any miss, keeps all
    "starts": (1,),
    "free_moves": (0, 48),  # none, all of them
    "per_layout": (100000,),  # no limit
    "root_draws": (1,),
    "patience": (1000,),  # no limit
}
# Keys of `search` without an ablation: sizes, and keys that the method decides.
SIZES = ("transitions", "breadth", "depth")
DECIDED = ("generator", "randomise")
_TREES = ("rrbs", "naive")  # generators that grow trees
# Keys of `train` that have a meaning only together.
_TOGETHER = (
    ("target_sync", "target_rate"),
    ("epsilon_start", "epsilon_end", "epsilon_share"),
)

Settings = tuple[str, ...]


def ablations(file: Path, common: Sequence[Override]) -> list[Settings]:
    """Returns the settings of each cell of a task, in this order:

    - no change;
    - each part of the search taken away, if transitions are generated;
    - each value of `train` that differs from the preset `paper`, set to the value of `paper`;
    - the whole preset `paper`, unless it is in use already.

    `common` holds the overrides that all cells share. Raises UserError.
    """
    values = effective_config.values(effective_config.load(file, common))
    ours = values["train"]
    as_paper = effective_config.load(file, [Override(f"--set {PAPER}", PAPER), *common])
    paper = effective_config.values(as_paper)["train"]
    alike = _settings(_ALIKE, ours)
    data = parts_of_search(values["search"]) if ours["offline"] else []
    whole = [] if ours["preset"] == "paper" else [(PAPER, *alike)]
    return [(), *data, *departures(ours, paper), *whole]


def parts_of_search(search: dict[str, Any]) -> list[Settings]:
    """Returns, for each part of the search, the settings that take it away or change it.

    Skips values that `search` has already.
    """
    tried = OF_BRANCHES | (OF_TREES if search["generator"] in _TREES else {})
    return [
        (f"search.{key}={json.dumps(value)}",)
        for key, values in tried.items()
        for value in values
        if search[key] != value
    ]


def departures(ours: dict[str, Any], paper: dict[str, Any]) -> list[Settings]:
    """Returns, for each difference of `ours` from `paper`, the settings that take `paper`'s value.

    Keys of one group of _TOGETHER count as one difference.
    """
    found = dict[tuple[str, ...], Settings]()
    for key in ours:
        if ours[key] != paper[key] and key not in ("preset", *_ALIKE):
            group = next((keys for keys in _TOGETHER if key in keys), (key,))
            found[group] = _settings(group, paper)
    return list(found.values())


def _settings(keys: Sequence[str], values: dict[str, Any]) -> Settings:
    return tuple(f"train.{key}={json.dumps(values[key])}" for key in keys)
