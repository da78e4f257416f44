"""The cells of a comparison, one run each, and the file that lists them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rtg.errors import UserError
from rtg.files.run_folder import read_json, write_json


@dataclass(frozen=True)
class Cell:
    """A run of a comparison."""

    task: str
    method: str
    settings: tuple[str, ...]  # of swept keys, KEY=VALUE each
    seed: int

    @property
    def label(self) -> str:
        """The method with what was swept: a row of the tables."""
        return "@".join((self.method, *self.settings))

    @property
    def name(self) -> str:
        """TASK/LABEL/seed-N, also of the run folder below that of the comparison."""
        return f"{self.task}/{self.label}/seed-{self.seed}"


@dataclass
class Grid:
    """All that was ever asked for in one folder."""

    cells: dict[Cell, str]  # with the command that asked last; they all come to the same run
    failed: dict[str, str]  # name of the cell -> its last words

    @property
    def commands(self) -> list[str]:
        """Those that are still the last to ask for a cell."""
        return list(dict.fromkeys(self.cells.values()))

    def add(self, command: str, cells: Iterable[Cell]) -> None:
        """Adds cells; those that are there already stay where it is."""
        self.cells.update(dict.fromkeys(cells, command))

    def write(self, folder: Path) -> None:
        """Replaces grid.json."""
        cells = [
            {**vars(cell), "settings": list(cell.settings), "command": command}
            for cell, command in self.cells.items()
        ]
        write_json(_file(folder), {"cells": cells, "failed": self.failed})


def _file(folder: Path) -> Path:
    return folder / "grid.json"


def _cell(value: dict[str, Any]) -> Cell:
    settings = tuple(map(str, value["settings"]))
    return Cell(str(value["task"]), str(value["method"]), settings, int(value["seed"]))


def _texts(value: Any) -> list[str]:
    """Raises TypeError unless they are, none of them empty."""
    if not (isinstance(value, list) and all(isinstance(one, str) and one for one in value)):
        raise TypeError
    return value


def read_grid(folder: Path) -> Grid:
    """An empty one where there is none yet. Raises UserError if it is damaged."""
    value = read_json(_file(folder))
    try:
        failed = value.get("failed", {})
        cells = value.get("cells", [])
        commands = _texts([cell["command"] for cell in cells])
        return Grid(
            cells=dict(zip(map(_cell, cells), commands, strict=True)),
            failed=dict(zip(failed, _texts(list(failed.values())), strict=True)),
        )
    except (AttributeError, KeyError, TypeError, ValueError):
        raise UserError(f"{_file(folder)}: damaged; legal: as `reproduce` left it") from None
