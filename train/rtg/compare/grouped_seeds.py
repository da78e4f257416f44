"""Jobs in which several seeds learn in one process, so that they share one GPU context.

A comparison does these jobs before it starts the runs themselves:
1. Each run generates its transitions in a process of its own.
2. The seeds of each method learn together in one process.

The runs find this work done, or continue with what is left.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rtg.compare.cell_run import CellRun, module_command
from rtg.learn import log_sinks
from rtg.run import shared_transitions


@dataclass(frozen=True)
class Generation:
    """The job that generates the transitions of one run."""

    run: CellRun

    @property
    def name(self) -> str:
        return f"{self.run.name}: transitions"

    @property
    def log(self) -> Path:
        return self.run.log

    @property
    def folders(self) -> tuple[Path, ...]:
        return self.run.folders

    @property
    def done(self) -> bool:
        return shared_transitions.is_generated(self.run.folder)

    @property
    def pending_generation_key(self) -> str | None:
        return self.run.pending_generation_key

    def command(self) -> list[str]:
        return [*self.run.command(), "--no-train"]

    def outcome(self) -> str:
        return "generated"


@dataclass(frozen=True)
class Learning:
    """The job in which several seeds learn in one process."""

    runs: tuple[CellRun, ...]

    @property
    def name(self) -> str:
        return f"{self._folder.parent.name}/{self._folder.name}: {len(self.runs)} seeds learn"

    @property
    def log(self) -> Path:
        return self._folder / "learning.log"

    @property
    def folders(self) -> tuple[Path, ...]:
        return tuple(run.folder for run in self.runs)

    @property
    def done(self) -> bool:
        return not self._unfinished()

    @property
    def pending_generation_key(self) -> str | None:
        return None

    def command(self) -> list[str]:
        unfinished = self._unfinished()
        for run in unfinished:
            if not run.begun:  # no Generation has made its folder
                run.begin()
        folders = [str(run.folder) for run in unfinished]
        flags = ["--no-stream", "--resume", *log_sinks.flags(self.runs[0].sinks)]
        return module_command("rtg.learn.trainer", *folders, *flags)

    def outcome(self) -> str:
        return "learned"

    def _unfinished(self) -> list[CellRun]:
        return [run for run in self.runs if not (run.folder / "training.json").is_file()]

    @property
    def _folder(self) -> Path:
        return self.runs[0].folder.parent


def stages(runs: Sequence[CellRun], together: bool) -> tuple[list[Generation], list[Learning]]:
    """Returns the jobs to do before `runs`: all generation, then all learning.

    A job of learning is for at least two unfinished seeds of the same task, method and settings.
    Unless `together`, only runs with networks on a GPU have such jobs.
    """
    groups: dict[Path, list[CellRun]] = {}
    for run in runs:
        if not run.done and (together or _on_gpu(run)):
            groups.setdefault(run.folder.parent, []).append(run)
    several = [tuple(group) for group in groups.values() if len(group) > 1]
    generations = [Generation(run) for group in several for run in group if run.generation_key]
    return generations, [Learning(group) for group in several]


def _on_gpu(run: CellRun) -> bool:
    from rtg.learn import device  # imports PyTorch, which takes seconds

    return device.chosen(run.device) == "cuda"
