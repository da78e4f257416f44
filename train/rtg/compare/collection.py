"""Collects comparisons and single runs, for one report on all of them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any, NamedTuple

from rtg.compare import cell_checks
from rtg.compare.cells import Cell, Grid, read_grid
from rtg.compare.report import read_remarks
from rtg.compare.run_results import Comparison, read_runs
from rtg.errors import UserError
from rtg.files import own_data, run_folder
from rtg.run import effective_config

# Settings that change no result, or are no choice of the method.
_INCIDENTAL = ("train.device", "train.checkpoint_every")


class Collection(NamedTuple):
    """Holds what a report is made of."""

    grid: Grid
    comparison: Comparison
    remarks: str


class _Entry(NamedTuple):
    """A run with the origin of its name."""

    source: Path  # a comparison, or the run itself
    folder: Path
    cell: Cell
    command: str
    failure: str  # "": none

    @property
    def row(self) -> tuple[str, str, str]:
        """The task, the label and the source: runs with equal ones differ in the seed alone."""
        return self.cell.task, self.cell.label, str(self.source)


def collect(sources: Sequence[Path]) -> Collection:
    """Reads the comparisons and single runs in the folders `sources`.

    Where rows of different sources have the same label, the settings in which they differ are added
    to it. Raises UserError if there is no such folder, or if runs cannot stand in one table.
    """
    found = [entry for source in dict.fromkeys(sources) for entry in _entries(source)]
    if len(sources) > 1:
        found = _told_apart(found)
    grid = Grid(
        {entry.cell: entry.command for entry in found},
        {entry.cell.name: entry.failure for entry in found if entry.failure},
    )
    comparison = read_runs({entry.cell: entry.folder for entry in found}, grid.failure_by_name)
    remarks = "\n\n".join(text for source in sources if (text := read_remarks(source)))
    return Collection(grid, comparison, remarks)


def is_single_run(folder: Path) -> bool:
    return (folder / "config.yaml").is_file()


def check_sources(sources: Sequence[Path]) -> None:
    """Raises UserError unless each folder holds a comparison or a run."""
    for source in sources:
        run_folder.check_folder(source)
        if not is_single_run(source) and not read_grid(source).commands_by_cell:
            raise UserError(
                f"{source}: holds neither a comparison (grid.json) nor a run (config.yaml); legal: "
                "the --out of `reproduce` or of a run"
            )


def _entries(source: Path) -> Iterator[_Entry]:
    if is_single_run(source):
        config = effective_config.load_recorded(source / "config.yaml")
        cell = Cell(config.task.name, config.run.method, _data(source), config.run.seed)
        yield _Entry(source, source, cell, f"(a single run: {source})", "")
        return
    grid = read_grid(source)
    for cell, command in grid.commands_by_cell.items():
        failure = grid.failure_by_name.get(cell.name, "")
        yield _Entry(source, source / cell.name, cell, command, failure)


def _data(run: Path) -> tuple[str, ...]:
    """Returns, as a setting, which data a run was given; () if it was given none."""
    own = own_data.of_run(run)
    return (f"data={re.sub('[/@ ]+', '-', own['name'] or 'arrays')}",) if own else ()


def _told_apart(entries: Sequence[_Entry]) -> list[_Entry]:
    """Adds the settings to the labels. Raises UserError if runs cannot stand in one table."""
    # One run stands for its row; a row none of whose runs has begun is left as it is.
    settings = {entry.row: _settings(entry) for entry in entries if is_single_run(entry.folder)}
    found = []
    for twins in _by_label(entries):
        rows = dict.fromkeys(entry.row for entry in twins)
        keys = _differing([settings[row] for row in rows if row in settings])
        for entry in twins:
            own = settings.get(entry.row)
            added = [_setting(entry, key, own[key]) for key in keys] if own else []
            cell = replace(entry.cell, settings=(*entry.cell.settings, *added))
            found.append(entry._replace(cell=cell))
    _check(found)
    return found


def _differing(settings: Sequence[dict[str, Any]]) -> list[str]:
    """Returns the keys whose values are not the same in all of `settings`."""
    if not settings:
        return []
    first, *others = settings
    return [key for key in first if any(other[key] != first[key] for other in others)]


def _by_label(entries: Sequence[_Entry]) -> list[list[_Entry]]:
    """Groups the runs by task and label."""
    found: dict[tuple[str, str], list[_Entry]] = {}
    for entry in entries:
        found.setdefault(entry.row[:2], []).append(entry)
    return list(found.values())


def _settings(entry: _Entry) -> dict[str, Any]:
    """Returns all settings of a run that has begun, but those of its execution, and its data."""
    config = effective_config.load_recorded(entry.folder / "config.yaml")
    own = own_data.of_run(entry.folder)
    found = {
        f"{section}.{key}": value
        for section, values in effective_config.values(config).items()
        for key, value in values.items()
        if section != "run" and f"{section}.{key}" not in _INCIDENTAL
    }
    return {"data.sha256": (own["sha256"] or "")[:12] if own else "", **found}


def _setting(entry: _Entry, key: str, value: Any) -> str:
    text = effective_config.as_typed(value)
    if isinstance(value, dict | list) or any(bad in text for bad in "/@ "):
        raise UserError(
            f"{entry.folder}: differs from another run of {entry.cell.task}, {entry.cell.label} in "
            f"{key}; legal: runs of the same task"
        )
    return f"{key}={text}"


def _check(entries: Sequence[_Entry]) -> None:
    """Raises UserError if two runs are the same, or if tables cannot compare two of a task."""
    of_cell: dict[Cell, _Entry] = {}
    for entry in entries:
        twin = of_cell.setdefault(entry.cell, entry)
        if twin is not entry:
            raise UserError(
                f"{entry.folder}: is {entry.cell.name} with the same settings as {twin.folder}; "
                "legal: runs that differ in task, method, settings or seed"
            )
    begun = {entry.row: entry for entry in entries if is_single_run(entry.folder)}
    for one, other in combinations(begun.values(), 2):
        if one.cell.task == other.cell.task and one.source != other.source:
            cell_checks.check_pair(
                (one.folder, one.cell.label), (other.folder, other.cell.label), "another DIR"
            )
