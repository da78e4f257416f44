"""Starts and monitors the processes of a run.

A helper is a process that is restarted when it dies. The failure of any other process ends the run.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rtg.errors import RunError, UserError
from rtg.processes.children import Node, kill_all, stop_all

_QUICK_DEATH_AGE = 5.0  # [s]; a death this soon after the start may recur at every start
_MAX_QUICK_DEATHS = 10  # in a row, of one helper; a single bad job may cause three
# [s]; a helper that ends with status 0 may know of the end of the run before this process does.
_EXIT_GRACE = 1.0


@dataclass
class _Member:
    node: Node
    helper: bool
    quick_deaths: int = 0
    exit_seen_at: float | None = None  # [s], when exit status 0 was first seen

    def has_left_early(self) -> bool:
        """Returns whether exit status 0 was first seen more than _EXIT_GRACE s ago."""
        now = time.monotonic()
        self.exit_seen_at = now if self.exit_seen_at is None else self.exit_seen_at
        return now - self.exit_seen_at > _EXIT_GRACE


class ProcessGraph:
    """Starts, monitors and stops the programs of a run. Their output goes to `logs`/NAME.log."""

    def __init__(self, logs: Path) -> None:
        logs.mkdir(parents=True, exist_ok=True)
        self._logs = logs
        self._members: list[_Member] = []
        self._ignored_failures: set[str] = set()
        self.restarts = 0

    def add(self, name: str, command: Sequence[str | Path], helper: bool = False) -> None:
        """Starts program `name`. check_and_restart() restarts it after its death if `helper`."""
        node = Node(name, command, self._logs / f"{name}.log")
        self._members.append(_Member(node, helper))

    def check_and_restart(self, leaving: bool = False) -> list[str]:
        """Restarts dead helpers and returns a message for each. Restarts none if `leaving`.

        `leaving`: the run is about to end. Raises RunError if any other program has failed, or
        UserError if it reported bad input. Raises RunError if a helper keeps dying soon after its
        start.
        """
        notes = []
        for member in self._members:
            status = member.node.exit_status()
            if status is None or (status == 0 and not member.helper):
                continue
            if not member.helper:
                if member.node.name not in self._ignored_failures:
                    raise _failure(member.node, status)
                continue
            if leaving or (status == 0 and not member.has_left_early()):
                continue
            notes.append(f"{member.node.exit_text()}, started again")
            self._replace(member)
        return notes

    def ignore_failure(self, name: str) -> None:
        """Makes check_and_restart() ignore a failure of program `name` from now on."""
        self._ignored_failures.add(name)

    def failures(self) -> list[str]:
        """Returns a failure_report() for each program that failed, helpers excluded."""
        essential = [member.node for member in self._members if not member.helper]
        return [failure_report(node) for node in essential if node.exit_status() not in (None, 0)]

    def _replace(self, member: _Member) -> None:
        quick = time.monotonic() - member.node.started < _QUICK_DEATH_AGE
        member.quick_deaths = member.quick_deaths + 1 if quick else 0
        if member.quick_deaths >= _MAX_QUICK_DEATHS:
            raise RunError(
                f"{failure_report(member.node)}\n(died {_MAX_QUICK_DEATHS} times in a row)"
            )
        member.node.start()
        member.exit_seen_at = None
        self.restarts += 1

    def pids(self) -> dict[str, int]:
        """Returns the process ids of the programs by name."""
        return {member.node.name: member.node.pid for member in self._members}

    def working(self, name: str | None = None) -> bool:
        """Returns whether program `name` runs, or any program if None. Helpers do not count."""
        return any(name in (None, node.name) for node in self._running(helpers=False))

    def wait(self, seconds: float) -> bool:
        """Waits at most `seconds` for the end of the first running program; returns working().

        Helpers do not count.
        """
        for node in self._running(helpers=False)[:1]:
            node.wait(seconds)
        return self.working()

    def stop(self) -> None:
        """Stops all programs with SIGTERM, then SIGKILL; takes at most 5 s."""
        stop_all(self._running())

    def kill(self) -> None:
        """Kills all programs at once."""
        kill_all(self._running())

    def _running(self, helpers: bool = True) -> list[Node]:
        nodes = [member.node for member in self._members if helpers or not member.helper]
        return [node for node in nodes if node.exit_status() is None]


def _failure(node: Node, status: int) -> Exception:
    """Returns the error to raise for a failed program.

    It is a UserError for exit status 2, which all programs of RTG use for bad input.
    """
    words = node.log_tail(lines=1)
    return UserError(words) if status == 2 and words else RunError(failure_report(node))


def failure_report(node: Node) -> str:
    """Describes how a program ended, with the end of its log."""
    words = node.log_tail()
    return f"{node.exit_text()}; the end of {node.log}:\n{words}" if words else node.exit_text()
