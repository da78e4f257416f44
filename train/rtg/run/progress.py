"""The display of a run: progress bars on a terminal, else a line of text for each change."""

from __future__ import annotations

import time
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
)
from rich.text import Text

from rtg.run.clock import duration, process_age
from rtg.run.run_state import RunState
from rtg.run.time_left import TimeLeft, words

_REDRAW = 0.2  # [s]


def generation_text(state: RunState) -> str:
    """Describes the generation in one line."""
    parts = [state.phase or "starting"]
    if state.depth:
        parts.append(f"layer {state.layer}/{state.depth}")
    parts.append(f"contact share {state.contact_share:.2f}")
    if state.starts_reached:
        parts.append(f"starts reached: {state.starts_reached:,}")
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
    """Prints lines that begin with the seconds since the command was given."""

    def __init__(self, out: TextIO) -> None:
        self._out = out

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def note(self, message: str) -> None:
        print(f"[{process_age():7.1f} s] {message}", file=self._out, flush=True)


class PlainDisplay(TimedLines):
    """Prints a line when the state of the run changes."""

    def __init__(self, out: TextIO, usual_rate: float) -> None:
        super().__init__(out)
        self._shown = RunState()
        self._left = TimeLeft(usual_rate)

    def show(self, state: RunState) -> None:
        last = self._shown
        left = words(self._left.seconds(state, time.monotonic()), state)
        end = left and f", {left}"
        if (state.phase, state.layer) != (last.phase, last.layer):
            counts = f"{state.transitions:,} of {state.target:,} transitions"
            self.note(f"{counts}: {generation_text(state)}{end}")
        tenth = max(1, state.budget // 10)
        if (
            state.interactions // tenth != last.interactions // tenth
            or state.evaluations != last.evaluations
        ):
            counts = f"{state.interactions:,} of {state.budget:,} interactions"
            self.note(f"{counts}: {training_text(state)}{end}")
        self._shown = state


class _Counts(ProgressColumn):
    """The column of a progress bar with the text "COMPLETED of TOTAL"."""

    def render(self, task: Task) -> Text:
        total = "?" if task.total is None else f"{task.total:,.0f}"
        return Text(f"{f'{task.completed:,.0f}':>9} of {total:>9}", style="progress.download")


class _Time(ProgressColumn):
    """The column of the bar of the whole run: the time since the command, and what is left."""

    left = ""  # in words

    def render(self, task: Task) -> Text:
        end = self.left and f", {self.left}"
        return Text(f"{duration(process_age())}{end}", style="progress.elapsed")


class LiveDisplay:
    """Shows progress bars that change in place: of the whole run, by its time, and of its halves,
    each with a line of text below."""

    def __init__(self, console: Console, usual_rate: float) -> None:
        self._console = console
        self._time = _Time()
        self._run = self._bar("run", self._time)
        self._bars = [self._bar("generate", _Counts()), self._bar("train", _Counts())]
        self._left = TimeLeft(usual_rate)
        # No refresh thread, because this process starts other processes with fork.
        self._live = Live(console=console, auto_refresh=False)
        self._drawn = 0.0

    def _bar(self, name: str, column: ProgressColumn) -> Progress:
        bar = Progress(
            TextColumn("{task.description:<8}"),
            BarColumn(bar_width=28),
            column,
            console=self._console,
        )
        bar.add_task(name, total=None)
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
        now = time.monotonic()
        left = self._left.seconds(state, now)
        self._time.left = words(left, state)
        if left is not None:
            age = process_age()
            self._run.update(only, completed=age, total=age + left)
        generate.update(only, completed=state.transitions, total=state.target or None)
        rows: list[RenderableType] = [self._run]
        if state.generates:
            rows += [generate, _indented(generation_text(state))]
        if state.budget:
            train.update(only, completed=state.interactions, total=state.budget)
            rows += [train, _indented(training_text(state))]
        refresh = now - self._drawn >= _REDRAW
        self._drawn = now if refresh else self._drawn
        self._live.update(Group(*rows), refresh=refresh)


def _indented(words: str) -> Text:
    return Text(f"         {words}", style="dim", no_wrap=True, overflow="ellipsis")


def display(out: TextIO, usual_rate: float) -> Display:
    """Returns a LiveDisplay if `out` is a terminal, else a PlainDisplay.

    `usual_rate`: of interactions, before their own is known [1/s].
    """
    console = Console(file=out)
    if console.is_terminal:
        return LiveDisplay(console, usual_rate)
    return PlainDisplay(out, usual_rate)
