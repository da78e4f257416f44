"""Sends the rows of progress.csv elsewhere, too: to TensorBoard, to Weights & Biases.

Both are optional, and keep to the machine: Weights & Biases writes to the run folder, for `wandb
sync`, unless WANDB_MODE says otherwise.
"""

from __future__ import annotations

import json
import os
import secrets
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from rtg import _core, extras
from rtg.errors import UserError
from rtg.files.run_folder import write_text

SINKS = ("tensorboard", "wandb")
Row = Mapping[str, Any]


class Sink(Protocol):
    """Takes the rows of one process of a run, after `earlier` ones that its log begins with."""

    def add(self, row: Row) -> None: ...

    def close(self) -> None: ...


class TensorBoard:
    """Event files in RUN/tensorboard. They hold the rows of the log, whatever they held before.

    A process that had no sink may have logged some of the earlier rows. Those logged after the last
    checkpoint come again. Times are those of learning, without the breaks between processes.
    """

    def __init__(
        self, folder: Path, config: _core.Config, earlier: Sequence[Row], row: Row
    ) -> None:
        from torch.utils.tensorboard import SummaryWriter

        first = [*earlier, row][0]["interactions"]
        self._writer = SummaryWriter(folder / "tensorboard", purge_step=first)
        for old in earlier:
            self._write(old, time.time() - (row.get("wall_s", 0.0) - old.get("wall_s", 0.0)))

    def add(self, row: Row) -> None:
        self._write(row, time.time())
        self._writer.flush()

    def _write(self, row: Row, at: float) -> None:
        for name, value in _values(row).items():
            self._writer.add_scalar(name, value, row["interactions"], walltime=at)

    def close(self) -> None:
        self._writer.close()


class Wandb:
    """A run of Weights & Biases, whose files lie in RUN/wandb; RUN/wandb_id holds its id.

    It takes rows in the order of their steps alone: earlier ones only if it has none yet.
    """

    def __init__(
        self, folder: Path, config: _core.Config, earlier: Sequence[Row], row: Row
    ) -> None:
        import wandb

        os.environ.setdefault("WANDB_MODE", "offline")
        missing = [] if (folder / "wandb_id").is_file() else earlier
        run = config.run
        try:
            self._run = wandb.init(
                project="rtg",
                name=f"{config.task.name}, {run.method}, seed {run.seed}",
                id=_stored_id(folder / "wandb_id"),
                resume="allow",
                reinit="create_new",  # runs that learn in one process are apart
                dir=folder,
                config=json.loads(config.json),
                settings=wandb.Settings(console="off", silent=True, x_disable_stats=True),
            )
        except wandb.errors.Error as error:
            raise UserError(f"--log wandb: {error}; legal: after wandb login, or offline") from None
        for old in missing:
            self.add(old)

    def add(self, row: Row) -> None:
        self._run.log(_values(row), step=row["interactions"])

    def close(self) -> None:
        self._run.finish()


_KINDS: dict[str, type[TensorBoard] | type[Wandb]] = dict(
    zip(SINKS, (TensorBoard, Wandb), strict=True)
)


class LazySinks:
    """The sinks `names` of a run, opened with the first row."""

    def __init__(self, names: Sequence[str], folder: Path, config: _core.Config) -> None:
        self._names, self._folder, self._config = names, folder, config
        self._open: list[Sink] = []

    def add(self, row: Row, earlier: Sequence[Row]) -> None:
        """Hands the row on. Raises UserError if a sink cannot be opened.

        `earlier`: the rows of the log before it, also those of earlier processes of the run.
        """
        if not self._open:
            for name in self._names:
                self._open.append(_KINDS[name](self._folder, self._config, earlier, row))
        for sink in self._open:
            sink.add(row)

    def close(self) -> None:
        for sink in self._open:
            sink.close()
        self._open = []


def parse(words: str | None) -> tuple[str, ...]:
    """Parses the value of --log, names of SINKS, and looks for their packages. Raises UserError."""
    names = tuple(dict.fromkeys(words.split(","))) if words is not None else ()
    for name in names:
        if name not in SINKS:
            raise UserError(f"--log {name}: no such log; legal: {','.join(SINKS)}")
        extras.require(name, name, f"--log {name}")
    return names


def flags(names: Sequence[str]) -> list[str]:
    """Returns the flags that parse() has read, for another program."""
    return ["--log", ",".join(names)] if names else []


def _values(row: Row) -> dict[str, Any]:
    """Returns the columns of a row that have values, but for the step."""
    return {name: value for name, value in row.items() if name != "interactions"}


def _stored_id(path: Path) -> str:
    """Returns the id in the file `path`, which it writes with a new one if there is none."""
    if not path.is_file():
        write_text(path, secrets.token_hex(8))
    return path.read_text()
