"""The run of one cell of a comparison: its command, its folder and its state.

A cell is a combination of task, method, settings and seed.
"""

from __future__ import annotations

import shlex
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rtg import _core
from rtg.compare.cells import Cell
from rtg.compare.reproduce_args import ReproduceArgs
from rtg.errors import UserError
from rtg.files import run_folder
from rtg.run import effective_config, run_args, shared_transitions
from rtg.run import plan as run_plan
from rtg.run.effective_config import Values
from rtg.run.run_args import Override

# Keys of `train` that must be equal in runs of different methods.
_SHARED_KEYS = (
    "interactions",
    "eval_every",
    "eval_episodes",
    "stop_at_success",
    "stop_evaluations",
)
# Environment variables that limit numerical libraries to one thread.
_ONE_THREAD = [f"{name}_NUM_THREADS=1" for name in ("OMP", "OPENBLAS", "MKL")]


@dataclass(frozen=True)
class CellRun:
    """A cell with its run folder and its command line."""

    cell: Cell
    folder: Path
    arguments: tuple[str, ...]  # of `rtg run`, without --out
    generation_key: str | None = None  # see shared_transitions.generation_key()
    device: str = "auto"  # train.device

    @property
    def name(self) -> str:
        return self.cell.name

    @property
    def log(self) -> Path:
        """The log file. It lies beside the run folder, because the run makes that folder."""
        return self.folder.with_name(f"{self.folder.name}.log")

    @property
    def done(self) -> bool:
        """Returns whether the run has a result."""
        return bool(run_folder.result(self.folder))

    @property
    def begun(self) -> bool:
        """Returns whether the folder holds the run, finished or not."""
        return (self.folder / "config.yaml").is_file()

    @property
    def pending_generation_key(self) -> str | None:
        """The key of the transitions that the run must still generate; None if none."""
        return None if shared_transitions.is_generated(self.folder) else self.generation_key

    def begin(self) -> None:
        """Makes the run folder without starting `rtg run`. Raises UserError."""
        _remove_partial_configs(self.folder)
        run_plan.make_plan(run_args.parse([*self.arguments, "--out", str(self.folder)]))

    def command(self) -> list[str]:
        """Returns the command that begins or resumes the run, after preparing the run folder.

        Takes over transitions with the same key from another run. Removes partial configurations
        that a killed run has left. Raises UserError.
        """
        if self.pending_generation_key:
            place = self.folder.parents[1], self.folder.name
            if source := shared_transitions.find(self.pending_generation_key, *place):
                if not self.begun:
                    self.begin()
                shared_transitions.take_over(source, self.folder)
        if not self.begun:
            _remove_partial_configs(self.folder)
        arguments = ["--resume"] if self.begun else self.arguments
        return module_command("rtg", "run", *arguments, "--out", str(self.folder))

    def outcome(self) -> str:
        """Returns the result of a finished run in words."""
        found = run_folder.result(self.folder)
        return f"success {found['success_rate']:.2f} after {found['interactions']:,} interactions"


def module_command(module: str, *words: str) -> list[str]:
    """Returns the command that runs a Python module of RTG on one core."""
    return ["env", *_ONE_THREAD, sys.executable, "-m", module, *words]


def prepare_runs(args: ReproduceArgs) -> list[CellRun]:
    """Returns the runs of all cells, without starting them.

    Raises UserError if the configuration of a cell
    - is illegal,
    - cannot run on this machine,
    - equals that of another cell, or
    - does not fit the runs in the comparison folder.
    """
    runs, seen, checked = [], dict[str, str](), set[Path]()
    for cell in args.cells:
        config = effective_config.load(args.files[cell.task], _overrides(args, cell))
        twin = seen.setdefault(config.json, cell.name)
        if twin != cell.name:
            raise UserError(
                f"{cell.name}: has the same settings as {twin}; legal: settings that differ"
            )
        run_plan.check(config, train=True)
        folder = args.out / cell.name
        _check_folder(folder)
        if folder.parent not in checked:
            _check_seeds(folder.parent, config)
            _check_comparable(folder, config)
            checked.add(folder.parent)
        key, device = shared_transitions.generation_key(config), config.train.device
        runs.append(CellRun(cell, folder, _arguments(args, cell), key, device))
    return runs


def _flags(cell: Cell) -> list[str]:
    flags = ["--in-process", "--workers", "1", "--seed", str(cell.seed)]
    return [*flags, "--method", cell.method]


def _arguments(args: ReproduceArgs, cell: Cell) -> tuple[str, ...]:
    settings = [word for s in (*args.settings, *cell.settings) for word in ("--set", s)]
    return (str(args.files[cell.task]), *_flags(cell), *settings)


def _overrides(args: ReproduceArgs, cell: Cell) -> list[Override]:
    """Returns the overrides in _arguments(), each with the flag that the user typed."""
    overrides = [Override(f"--set {setting}", setting) for setting in args.settings]
    overrides += [Override(f"--sweep {setting}", setting) for setting in cell.settings]
    return [*overrides, *run_args.parse(_flags(cell)).overrides]


def _check_folder(folder: Path) -> None:
    """Raises UserError unless the folder holds a run, is empty or does not exist."""
    if (folder / "config.yaml").is_file():
        return
    if folder.exists() and not (folder.is_dir() and all(map(_is_partial_config, folder.iterdir()))):
        raise UserError(
            f"{folder}: is neither empty nor the folder of a run; legal: a new or an empty --out"
        )


def _is_partial_config(file: Path) -> bool:
    """Returns whether `file` is an unfinished config.yaml, left by a run killed at its start."""
    return file.name.startswith(".config.yaml.")


def _remove_partial_configs(folder: Path) -> None:
    if folder.is_dir():
        for file in filter(_is_partial_config, folder.iterdir()):
            file.unlink()


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


def _check_comparable(folder: Path, config: _core.Config) -> None:
    """Raises UserError unless tables can compare all runs of the task with the run in `folder`.

    They must agree with `config` in the values of _compared(): task, physics, forward, budget and
    evaluation, swept keys excluded. The number of transitions must agree only among runs that
    generate transitions. `config`: the configuration of the run in `folder`.
    """
    for found in sorted(folder.parents[1].glob("*/seed-*/config.yaml")):
        swept = _swept(found.parts[-3]) | _swept(folder.parts[-2])
        before = effective_config.load(found)
        old, new = _compared(before, swept), _compared(config, swept)
        if not (before.train.offline and config.train.offline):
            del old["search"], new["search"]
        for section in old:
            if old[section] != new[section]:
                what = _difference(section, old[section], new[section])
                raise UserError(
                    f"{found.parent}: was made with {what}; legal: the same, or another --out"
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


def _difference(section: str, old: dict[str, Any], new: dict[str, Any]) -> str:
    key = next(key for key in (*old, *new) if old.get(key) != new.get(key))
    words = f"{section}.{key} = {old.get(key)}, asked for is {new.get(key)}"
    return words if len(words) < 160 else f"another {section}.{key}"
