"""The processes of a run: helpers are replaced when they die, the others take the run with them."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rtg.errors import RunError, UserError
from rtg.processes.children import Node, kill_all, stop_all

_QUICK = 5.0  # [s]; a worker that dies this soon after its start may never do better
_QUICK_DEATHS = 10  # in a row, of one worker; one job may take down three
_GOOD_BYE = 1.0  # [s]; a helper that ended well may have heard earlier than we that all is over


@dataclass
class _Member:
    node: Node
    helper: bool
    quick_deaths: int = 0
    left: float | None = None  # when it was first seen to have ended well

    def has_left_early(self) -> bool:
        """Says whether it has been gone for longer than a good-bye needs."""
        now = time.monotonic()
        self.left = now if self.left is None else self.left
        return now - self.left > _GOOD_BYE


class ProcessGraph:
    """Starts, watches and stops the programs; their output goes to RUN/logs/NAME.log."""

    def __init__(self, logs: Path) -> None:
        logs.mkdir(parents=True, exist_ok=True)
        self._logs = logs
        self._members: list[_Member] = []
        self._spared: set[str] = set()
        self.restarts = 0

    def add(self, name: str, command: Sequence[str | Path], helper: bool = False) -> None:
        """Starts a program; a helper is started again when it dies."""
        node = Node(name, command, self._logs / f"{name}.log")
        self._members.append(_Member(node, helper))

    def tend(self, leaving: bool = False) -> list[str]:
        """Replaces dead helpers, unless they are `leaving`; returns what there is to say about it.

        Raises RunError with the last words of a program that the run cannot do without, UserError
        if bad input is what ended it.
        """
        notes = []
        for member in self._members:
            status = member.node.exit_status()
            if status is None or (status == 0 and not member.helper):
                continue
            if not member.helper:
                if member.node.name not in self._spared:
                    raise _failure(member.node, status)
                continue
            if leaving or (status == 0 and not member.has_left_early()):
                continue
            notes.append(f"{member.node.epitaph()}, started again")
            self._replace(member)
        return notes

    def spare(self, name: str) -> None:
        """From now on the failure of that program is no reason to stop the others."""
        self._spared.add(name)

    def failures(self) -> list[str]:
        """The last words of programs, no helpers, that ended badly."""
        essential = [member.node for member in self._members if not member.helper]
        return [obituary(node) for node in essential if node.exit_status() not in (None, 0)]

    def _replace(self, member: _Member) -> None:
        quick = time.monotonic() - member.node.started < _QUICK
        member.quick_deaths = member.quick_deaths + 1 if quick else 0
        if member.quick_deaths >= _QUICK_DEATHS:
            raise RunError(f"{obituary(member.node)}\n(died {_QUICK_DEATHS} times in a row)")
        member.node.start()
        member.left = None
        self.restarts += 1

    def pids(self) -> dict[str, int]:
        """Process ids of the programs by name."""
        return {member.node.name: member.node.pid for member in self._members}

    def working(self, name: str | None = None) -> bool:
        """Says whether a program that is no helper still runs, or the one of that name."""
        return any(name in (None, node.name) for node in self._running(helpers=False))

    def wait(self, seconds: float) -> bool:
        """working(), once one has ended or so much time has passed."""
        for node in self._running(helpers=False)[:1]:
            node.wait(seconds)
        return self.working()

    def stop(self) -> None:
        """Ends all programs within 5 s."""
        stop_all(self._running())

    def kill(self) -> None:
        """Ends all programs at once."""
        kill_all(self._running())

    def _running(self, helpers: bool = True) -> list[Node]:
        nodes = [member.node for member in self._members if helpers or not member.helper]
        return [node for node in nodes if node.exit_status() is None]


def _failure(node: Node, status: int) -> Exception:
    """The error to raise for a program that has ended badly; all of ours end with 2 on bad
    input."""
    words = node.last_words(lines=1)
    return UserError(words) if status == 2 and words else RunError(obituary(node))


def obituary(node: Node) -> str:
    """How it ended and the end of its log."""
    words = node.last_words()
    return f"{node.epitaph()}; the end of {node.log}:\n{words}" if words else node.epitaph()
