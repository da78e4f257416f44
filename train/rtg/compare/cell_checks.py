"""Checks that the run of a cell fits what its comparison folder holds already."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Any

from rtg import _core
from rtg.errors import UserError
from rtg.run import effective_config
from rtg.run.effective_config import Values

# Keys of `train` that must be equal in runs of different methods.
_SHARED_KEYS = (
    "interactions",
    "eval_every",
    "eval_episodes",
    "stop_at_success",
    "stop_evaluations",
)


def check_folder(folder: Path) -> None:
    """Raises UserError unless the folder holds a run, is empty or does not exist."""
    if (folder / "config.yaml").is_file():
        return
    if folder.exists() and not (folder.is_dir() and all(map(is_partial_config, folder.iterdir()))):
        raise UserError(
            f"{folder}: is neither empty nor the folder of a run; legal: a new or an empty --out"
        )


def is_partial_config(file: Path) -> bool:
    """Returns whether `file` is an unfinished config.yaml, left by a run killed at its start."""
    return file.name.startswith(".config.yaml.")


def check_comparable(folder: Path, config: _core.Config) -> None:
    """Raises UserError unless the run of `config` in `folder` can stand beside those of its task.

    Runs of other seeds must differ from it in the seed alone.
    """
    _check_seeds(folder.parent, config)
    _check_table(folder, config)


def _check_seeds(label_folder: Path, config: _core.Config) -> None:
    """Raises UserError unless all runs in `label_folder` differ from `config` only in the seed.

    Also checks seeds that are not requested now, because tables show means over all runs.
    """
    for found in sorted(label_folder.glob("seed-*/config.yaml")):
        seed = found.parent.name.removeprefix("seed-")
        if seed.isdigit():
            asked = effective_config.values(config)
            asked["run"]["seed"] = int(seed)
            _check_same(found.parent, asked)


def _check_same(folder: Path, asked: Values) -> None:
    """Raises UserError unless this version of RTG made the run, with the values `asked`."""
    found = folder / "config.yaml"
    before = effective_config.values(effective_config.load(found))
    for section, new in sorted(asked.items()):
        old = before[section]
        if old != new:
            what = _difference(section, old, new)
            remedy = f"another --out, or rm -r {shlex.quote(str(folder))}"
            raise UserError(f"{folder}: was made with {what}; legal: the same, {remedy}")
    effective_config.load_written(found)  # raises UserError if another version wrote it


def _check_table(folder: Path, config: _core.Config) -> None:
    """Raises UserError unless tables can compare all runs of the task with the run in `folder`.

    `config`: the configuration of the run in `folder`.
    """
    for found in sorted(folder.parents[1].glob("*/seed-*/config.yaml")):
        labels = found.parts[-3], folder.parts[-2]
        if what := _incomparable(labels, (effective_config.load(found), config)):
            raise UserError(
                f"{found.parent}: was made with {what}; legal: the same, or another --out"
            )


def check_pair(one: tuple[Path, str], other: tuple[Path, str], remedy: str) -> None:
    """Raises UserError unless tables can compare two runs, each a folder and a label.

    `remedy`: what else would be legal.
    """
    configs = [effective_config.load_recorded(run / "config.yaml") for run, _ in (one, other)]
    if what := _incomparable((one[1], other[1]), (configs[0], configs[1]), str(other[0])):
        raise UserError(f"{one[0]}: was made with {what}; legal: the same, or {remedy}")


def _incomparable(
    labels: tuple[str, str], configs: tuple[_core.Config, _core.Config], asked: str = "asked for"
) -> str:
    """Describes the first difference that keeps two runs out of one table; "" if there is none.

    They must agree in the values of _compared(): task, physics, forward, budget and evaluation,
    swept keys excluded. The number of transitions must agree only among runs that generate
    transitions; the label of a run of own data has the key "data". `asked`: the second run in
    words.
    """
    swept = _swept(labels[0]) | _swept(labels[1])
    old, new = (_compared(config, swept) for config in configs)
    if "data" in swept or not all(config.train.offline for config in configs):
        del old["search"], new["search"]
    differing = (section for section in old if old[section] != new[section])
    return next(
        (_difference(section, old[section], new[section], asked) for section in differing), ""
    )


def _swept(label: str) -> set[str]:
    """Returns the keys "section.name" that `label` sets, see Cell.label.

    A label with train.preset also sets all _SHARED_KEYS.
    """
    paths = (setting.partition("=")[0] for setting in label.split("@")[1:])
    found = {".".join(path.split(".")[:2]) for path in paths}
    of_preset = {f"train.{key}" for key in _SHARED_KEYS} if "train.preset" in found else set()
    return found | of_preset


def _compared(config: _core.Config, swept: set[str]) -> Values:
    """Returns, by section, the values that all runs in a table must share; omits `swept`."""
    values = effective_config.values(config)
    keys = {
        "task": tuple(values["task"]),
        "physics": tuple(values["physics"]),
        "forward": tuple(values["forward"]),
        "search": ("transitions",),
        "train": _SHARED_KEYS,
    }
    return {
        section: {name: values[section][name] for name in names if f"{section}.{name}" not in swept}
        for section, names in keys.items()
    }


def _difference(
    section: str, old: dict[str, Any], new: dict[str, Any], asked: str = "asked for"
) -> str:
    key = next(key for key in (*old, *new) if old.get(key) != new.get(key))
    words = f"{section}.{key} = {old.get(key)}, {asked} is {new.get(key)}"
    return words if len(words) < 160 else f"another {section}.{key}"
