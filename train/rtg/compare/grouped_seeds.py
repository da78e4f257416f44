"""Seeds that learn in one process: they share one GPU context.

What a comparison does before it lets each run end on its own: all runs generate, a process each;
then the seeds of each method learn together. The runs find that done, or go on with what is left.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rtg.compare.cell_run import CellRun, program
from rtg.run import shared_transitions


@dataclass(frozen=True)
class Generation:
    """The transitions of one run."""

    run: CellRun

    @property
    def name(self) -> str:
        return f"{self.run.name}: transitions"

    @property
    def log(self) -> Path:
        return self.run.log

    @property
    def done(self) -> bool:
        return shared_transitions.are_there(self.run.folder)

    @property
    def generates(self) -> str | None:
        return self.run.generates

    def command(self) -> list[str]:
        return [*self.run.command(), "--no-train"]

    def outcome(self) -> str:
        return "generated"


@dataclass(frozen=True)
class Learning:
    """Several seeds in one process."""

    runs: tuple[CellRun, ...]

    @property
    def name(self) -> str:
        return f"{self._folder.parent.name}/{self._folder.name}: {len(self.runs)} seeds learn"

    @property
    def log(self) -> Path:
        return self._folder / "learning.log"

    @property
    def done(self) -> bool:
        return all((run.folder / "training.json").is_file() for run in self.runs)

    @property
    def generates(self) -> str | None:
        return None

    def command(self) -> list[str]:
        for run in self.runs:
            if not run.begun:  # nothing was generated for it
                run.begin()
        folders = [str(run.folder) for run in self.runs]
        return program("rtg.learn.trainer", *folders, "--no-stream", "--resume")

    def outcome(self) -> str:
        return "learned"

    @property
    def _folder(self) -> Path:
        return self.runs[0].folder.parent


def stages(runs: Sequence[CellRun], wanted: bool) -> tuple[list[Generation], list[Learning]]:
    """The jobs before the runs, one stage after the other; nothing unless networks are on a GPU,
    or that is `wanted`."""
    groups: dict[Path, list[CellRun]] = {}
    for run in runs:
        if not run.done and (wanted or _on_gpu(run)):
            groups.setdefault(run.folder.parent, []).append(run)
    several = [tuple(group) for group in groups.values() if len(group) > 1]
    generations = [Generation(run) for group in several for run in group if run.kind]
    return generations, [Learning(group) for group in several]


def _on_gpu(run: CellRun) -> bool:
    from rtg.learn import device  # takes seconds

    return device.chosen(run.device) == "cuda"
