"""The cells of a comparison, one run each, and the file that lists them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rtg.errors import UserError
from rtg.run_folder import read_json, write_json


@dataclass(frozen=True)
class Cell:
    """One run of a comparison."""

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

    commands: list[str]
    cells: list[Cell]
    failed: dict[str, str]  # name of the cell -> its last words

    def add(self, command: str, cells: Iterable[Cell]) -> None:
        """What is there already stays as it is."""
        self.commands += [command] if command not in self.commands else []
        known = set(self.cells)
        self.cells += [cell for cell in cells if cell not in known]

    def write(self, folder: Path) -> None:
        """Replaces grid.json."""
        cells = [{**vars(cell), "settings": list(cell.settings)} for cell in self.cells]
        grid = {"commands": self.commands, "cells": cells, "failed": self.failed}
        write_json(_file(folder), grid)


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
        return Grid(
            commands=_texts(value.get("commands", [])),
            cells=[_cell(cell) for cell in value.get("cells", [])],
            failed=dict(zip(failed, _texts(list(failed.values())), strict=True)),
        )
    except (AttributeError, KeyError, TypeError, ValueError):
        raise UserError(f"{_file(folder)}: damaged; legal: as `reproduce` left it") from None
