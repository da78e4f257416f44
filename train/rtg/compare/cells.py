"""The cells (single runs) of a comparison, and the file that lists them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rtg.errors import UserError
from rtg.files.locks import lock
from rtg.files.run_folder import read_json, write_json


@dataclass(frozen=True)
class Cell:
    """A run of a comparison: its task, method, swept settings and seed.

    A swept setting is one that --sweep or --ablations varies.
    """

    task: str
    method: str
    settings: tuple[str, ...]  # KEY=VALUE for each swept setting
    seed: int

    @property
    def label(self) -> str:
        """The method with its swept settings, METHOD@KEY=VALUE...: a row of the tables."""
        return "@".join((self.method, *self.settings))

    @property
    def name(self) -> str:
        """TASK/LABEL/seed-N, also the path of the run folder within the comparison folder."""
        return f"{self.task}/{self.label}/seed-{self.seed}"


@dataclass
class Grid:
    """All cells that were ever requested in one comparison folder."""

    commands_by_cell: dict[Cell, str]  # last command that requested the cell; all are equivalent
    failure_by_name: dict[str, str]  # Cell.name -> how its run failed, with the end of the log

    @property
    def commands(self) -> list[str]:
        """The distinct commands in `commands_by_cell`."""
        return list(dict.fromkeys(self.commands_by_cell.values()))

    def add(self, command: str, cells: Iterable[Cell]) -> None:
        """Adds cells. A known cell keeps its position and gets the new command."""
        self.commands_by_cell.update(dict.fromkeys(cells, command))

    def write(self, folder: Path) -> None:
        """Replaces grid.json in `folder`."""
        cells = [
            {**vars(cell), "settings": list(cell.settings), "command": command}
            for cell, command in self.commands_by_cell.items()
        ]
        write_json(_file(folder), {"cells": cells, "failed": self.failure_by_name})


def _file(folder: Path) -> Path:
    return folder / "grid.json"


def _cell(value: dict[str, Any]) -> Cell:
    settings = tuple(map(str, value["settings"]))
    return Cell(str(value["task"]), str(value["method"]), settings, int(value["seed"]))


def _texts(value: Any) -> list[str]:
    """Returns `value`. Raises TypeError unless it is a list of non-empty strings."""
    if not (isinstance(value, list) and all(isinstance(one, str) and one for one in value)):
        raise TypeError
    return value


def read_grid(folder: Path) -> Grid:
    """Reads grid.json; the grid is empty if there is no file. Raises UserError if it is damaged."""
    value = read_json(_file(folder))
    try:
        failed = value.get("failed", {})
        cells = value.get("cells", [])
        commands = _texts([cell["command"] for cell in cells])
        return Grid(
            commands_by_cell=dict(zip(map(_cell, cells), commands, strict=True)),
            failure_by_name=dict(zip(failed, _texts(list(failed.values())), strict=True)),
        )
    except (AttributeError, KeyError, TypeError, ValueError):
        raise UserError(
            f"{_file(folder)}: is damaged; legal: the file as `reproduce` wrote it"
        ) from None


def grid_lock(folder: Path) -> Path:
    """Returns the lock file of whoever changes which cells, or which kind of runs, `folder` has."""
    return folder / ".grid.lock"


def update_grid(folder: Path, change: Callable[[Grid], object]) -> None:
    """Applies `change` to grid.json as it is now, without losing what other processes write.

    Raises UserError if the file is damaged.
    """
    with lock(grid_lock(folder)):
        grid = read_grid(folder)
        change(grid)
        grid.write(folder)
