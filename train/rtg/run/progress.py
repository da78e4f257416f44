"""The display of a run: progress bars on a terminal, else a line of text for each change."""

from __future__ import annotations

import time
from dataclasses import dataclass
from types import TracebackType
from typing import Protocol, Self, TextIO

from rich.console import Console, Group, RenderableType
from rich.live import Live
from rich.progress import (
    BarColumn,
    Progress,
    ProgressColumn,
    Task,
    TaskID,
    TextColumn,
    TimeElapsedColumn,
)
from rich.text import Text

_REDRAW = 0.2  # [s]


@dataclass(frozen=True)
class RunState:
    """The progress of a run."""

    generates: bool = True  # False if the run generates no transitions
    phase: str = ""  # phase of the generation, such as "tree 1", "plan 3", "random walks"
    layer: int = 0  # current layer of the search, of `depth` layers
    depth: int = 0
    transitions: int = 0
    target: int = 0
    contact_share: float = 0.0
    start_region: int = 0
    workers: int = 0
    interactions: int = 0
    budget: int = 0  # total number of interactions; 0: no training
    rate: float = 0.0  # interactions per second
    evaluations: int = 0
    success_rate: float | None = None  # of the last evaluation


def generation_text(state: RunState) -> str:
    """Describes the generation in one line."""
    parts = [state.phase or "starting"]
    if state.depth:
        parts.append(f"layer {state.layer}/{state.depth}")
    parts.append(f"contact share {state.contact_share:.2f}")
    parts.append(f"{state.start_region:,} in the start region")
    if state.workers:
        parts.append(f"{state.workers} worker{'s' if state.workers != 1 else ''}")
    return ", ".join(parts)


def training_text(state: RunState) -> str:
    """Describes the training in one line."""
    if not state.interactions:
        return "waiting for transitions" if state.generates else "starting"
    success = "-" if state.success_rate is None else f"{state.success_rate:.2f}"
    rate = f"{state.rate:,.0f}" if state.rate else "-"
    return f"success {success}, {rate} interactions/s"


class ScreenContext(Protocol):
    """A context manager that shows something on the screen until its exit."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None: ...


class Display(ScreenContext, Protocol):
    """A display of the state of a run, with notes."""

    def show(self, state: RunState) -> None:
        """Shows the newest state; may be called at any rate."""

    def note(self, message: str) -> None:
        """Prints a line that stays visible."""


class TimedLines:
    """Prints lines that begin with the seconds since construction."""

    def __init__(self, out: TextIO) -> None:
        self._out = out
        self._start = time.monotonic()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def note(self, message: str) -> None:
        print(f"[{time.monotonic() - self._start:7.1f} s] {message}", file=self._out, flush=True)


class PlainDisplay(TimedLines):
    """Prints a line when the state of the run changes."""

    def __init__(self, out: TextIO) -> None:
        super().__init__(out)
        self._shown = RunState()

    def show(self, state: RunState) -> None:
        last = self._shown
        if (state.phase, state.layer) != (last.phase, last.layer):
            counts = f"{state.transitions:,} of {state.target:,} transitions"
            self.note(f"{counts}: {generation_text(state)}")
        tenth = max(1, state.budget // 10)
        if (
            state.interactions // tenth != last.interactions // tenth
            or state.evaluations != last.evaluations
        ):
            counts = f"{state.interactions:,} of {state.budget:,} interactions"
            self.note(f"{counts}: {training_text(state)}")
        self._shown = state


class _Counts(ProgressColumn):
    """The column of a progress bar with the text "COMPLETED of TOTAL"."""

    def render(self, task: Task) -> Text:
        total = "?" if task.total is None else f"{task.total:,.0f}"
        return Text(f"{f'{task.completed:,.0f}':>9} of {total:>9}", style="progress.download")


class LiveDisplay:
    """Shows two progress bars that change in place, each with a line of text below."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._bars = [self._bar("generate"), self._bar("train")]
        # No refresh thread, because this process starts other processes with fork.
        self._live = Live(console=console, auto_refresh=False)
        self._drawn = 0.0

    def _bar(self, name: str) -> Progress:
        bar = Progress(
            TextColumn("{task.description:<8}"),
            BarColumn(bar_width=28),
            _Counts(),
            TimeElapsedColumn(),  # training may end early, so the remaining time is unknown
            console=self._console,
        )
        bar.add_task(name, total=None, start=False)
        return bar

    def __enter__(self) -> Self:
        self._live.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._live.stop()

    def note(self, message: str) -> None:
        self._console.print(message, highlight=False)

    def show(self, state: RunState) -> None:
        generate, train = self._bars
        only = TaskID(0)
        for bar, begun in ((generate, state.transitions), (train, state.interactions)):
            if begun and bar.tasks[0].start_time is None:
                bar.start_task(only)
        generate.update(only, completed=state.transitions, total=state.target or None)
        rows: list[RenderableType] = []
        if state.generates:
            rows += [generate, _indented(generation_text(state))]
        if state.budget:
            train.update(only, completed=state.interactions, total=state.budget)
            rows += [train, _indented(training_text(state))]
        now = time.monotonic()
        refresh = now - self._drawn >= _REDRAW
        self._drawn = now if refresh else self._drawn
        self._live.update(Group(*rows), refresh=refresh)


def _indented(words: str) -> Text:
    return Text(f"         {words}", style="dim", no_wrap=True, overflow="ellipsis")


def display(out: TextIO) -> Display:
    """Returns a LiveDisplay if `out` is a terminal, else a PlainDisplay."""
    console = Console(file=out)
    return LiveDisplay(console) if console.is_terminal else PlainDisplay(out)


class RateMeter:
    """The rate of a count [1/s] over the last `window` seconds."""

    def __init__(self, window: float = 10.0) -> None:
        self._window = window
        self._samples: list[tuple[float, int]] = []

    def rate(self, count: int, now: float) -> float:
        """Adds a count at time `now` [s] and returns the rate. A decrease resets the meter."""
        if self._samples and count < self._samples[-1][1]:
            self._samples.clear()
        if not self._samples or count != self._samples[-1][1]:
            self._samples.append((now, count))
        while len(self._samples) > 2 and now - self._samples[0][0] > self._window:
            self._samples.pop(0)
        (first_time, first), (_, last) = self._samples[0], self._samples[-1]
        return (last - first) / (now - first_time) if now > first_time else 0.0
