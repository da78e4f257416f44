"""The run of one cell of a comparison: its command, its folder and its state.

A cell is a combination of task, method, settings and seed.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

from rtg.compare import cell_checks
from rtg.compare.cells import Cell, grid_lock
from rtg.compare.reproduce_args import ReproduceArgs
from rtg.errors import UserError
from rtg.files import locks, run_folder
from rtg.learn import log_sinks
from rtg.run import effective_config, run_args, shared_transitions
from rtg.run import plan as run_plan
from rtg.run.run_args import Override

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
    sinks: tuple[str, ...] = ()  # of log_sinks.SINKS

    @property
    def name(self) -> str:
        return self.cell.name

    @property
    def log(self) -> Path:
        """The log file. It lies beside the run folder, because the run makes that folder."""
        return self.folder.with_name(f"{self.folder.name}.log")

    @property
    def folders(self) -> tuple[Path, ...]:
        return (self.folder,)

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
        """Makes the run folder without starting `rtg run`.

        Raises UserError, also if the run does not fit those that other commands have begun.
        """
        _remove_partial_configs(self.folder)
        args = run_args.parse([*self.arguments, "--out", str(self.folder)])
        with locks.lock(grid_lock(self.folder.parents[2])):
            config = effective_config.load(args.file, args.overrides)
            cell_checks.check_comparable(self.folder, config)
            run_plan.make_plan(args)

    def command(self) -> list[str]:
        """Returns the command that begins or resumes the run, after preparing the run folder.

        Takes over transitions with the same key from another run. Removes partial configurations
        that a killed run has left. Raises UserError.
        """
        if not self.begun:
            self.begin()
        if self.pending_generation_key:
            place = self.folder.parents[1], self.folder.name
            if source := shared_transitions.find(self.pending_generation_key, *place):
                shared_transitions.take_over(source, self.folder)
        flags = log_sinks.flags(self.sinks)
        return module_command("rtg", "run", "--resume", *flags, "--out", str(self.folder))

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
        cell_checks.check_folder(folder)
        if folder.parent not in checked:
            cell_checks.check_comparable(folder, config)
            checked.add(folder.parent)
        key, device = shared_transitions.generation_key(config), config.train.device
        runs.append(CellRun(cell, folder, _arguments(args, cell), key, device, args.sinks))
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


def _remove_partial_configs(folder: Path) -> None:
    if folder.is_dir():
        for file in filter(cell_checks.is_partial_config, folder.iterdir()):
            file.unlink()
