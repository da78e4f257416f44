"""Runs one child process to its end."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from rtg.processes.children import Node, kill_all, stop_all
from rtg.processes.interrupts import Interrupts


def run_child(
    name: str,
    command: Sequence[str | Path],
    log: Path,
    step: Callable[[Node], object],
    grace: float = 4.0,
    descriptors: Sequence[int] = (),
) -> Node:
    """Runs a program with its output in `log`, whose folder is created; returns it at its end.

    Calls `step`, which should wait a little, until then. Stops the program if `step` raises, or on
    a signal, and kills it if it has not ended within `grace` s. The program inherits the open
    `descriptors`. Raises StoppedError on a signal.
    """
    log.parent.mkdir(parents=True, exist_ok=True)
    nodes: list[Node] = []
    with Interrupts(on_second_signal=lambda: kill_all(nodes)) as interrupts:
        try:
            node = Node(name, command, log, descriptors)
            nodes.append(node)
            while node.exit_status() is None:
                step(node)
                interrupts.raise_if_requested()
        finally:
            stop_all(nodes, grace)
    return node
