"""The processes of a run: workers are replaced when they die, the others take the run with them."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rtg.errors import RunError
from rtg.processes import Node, kill_all, stop_all

_QUICK = 5.0  # [s]; a worker that dies this soon after its start may never do better
_QUICK_DEATHS = 10  # in a row, of one worker; one job may take down three


@dataclass
class _Member:
    node: Node
    replaceable: bool
    quick_deaths: int = 0


class ProcessGraph:
    """Starts, watches and stops the programs; their output goes to RUN/logs/NAME.log."""

    def __init__(self, logs: Path) -> None:
        logs.mkdir(parents=True, exist_ok=True)
        self._logs = logs
        self._members: list[_Member] = []
        self.restarts = 0

    def add(self, name: str, command: Sequence[str | Path], replaceable: bool = False) -> Node:
        """Starts a program; a replaceable one is started again when it dies."""
        node = Node(name, command, self._logs / f"{name}.log")
        self._members.append(_Member(node, replaceable))
        return node

    def tend(self, leaving: bool) -> list[str]:
        """Replaces dead workers, unless they are `leaving`; returns what there is to say about it.

        Raises RunError with the last words of a program that the run cannot do without.
        """
        notes = []
        for member in self._members:
            status = member.node.exit_status()
            if status is None or (status == 0 and (leaving or not member.replaceable)):
                continue
            if not member.replaceable:
                raise RunError(_obituary(member.node))
            notes.append(f"{member.node.epitaph()}, started again")
            self._replace(member)
        return notes

    def _replace(self, member: _Member) -> None:
        quick = time.monotonic() - member.node.started < _QUICK
        member.quick_deaths = member.quick_deaths + 1 if quick else 0
        if member.quick_deaths >= _QUICK_DEATHS:
            raise RunError(f"{_obituary(member.node)}\nfor the {_QUICK_DEATHS}th time in a row")
        member.node.start()
        self.restarts += 1

    def running(self) -> list[Node]:
        """Programs that have not ended."""
        nodes = [member.node for member in self._members]
        return [node for node in nodes if node.exit_status() is None]

    def stop(self) -> None:
        """Ends all programs within 5 s."""
        stop_all(self.running())

    def kill(self) -> None:
        """Ends all programs at once."""
        kill_all(self.running())


def _obituary(node: Node) -> str:
    words = node.last_words()
    return f"{node.epitaph()}; the end of {node.log}:\n{words}" if words else node.epitaph()
