"""A run as a graph of processes over LCM, which graph.sh starts."""

from __future__ import annotations

import os
import sys
import time
from typing import Any

from rtg import paths
from rtg.bus.bus import new_key, open_bus
from rtg.errors import RunError, UserError
from rtg.files import run_folder
from rtg.learn import log_sinks
from rtg.processes.child_run import run_child
from rtg.processes.children import Node
from rtg.run.plan import RunPlan
from rtg.run.progress import Display
from rtg.run.run_state import RunState
from rtg.run.run_watch import RunWatch
from rtg.run.stall import Stall
from rtg.run.training_watch import TrainingWatch

_POLL = 0.1  # [s]
_GRACE = 25.0  # [s] from SIGTERM to SIGKILL; graph.sh allows its programs 20 s
_RESTARTED = ", started again"  # the end of the lines in which graph.sh says so


def generation_defects(plan: RunPlan) -> list[str]:
    """Describes the defects of the finished generation; [] without defects or generation."""
    report = run_folder.read_json(plan.report_file)
    given_up = report.get("units_given_up", 0)
    defects = [f"the coordinator gave up {given_up} units of work"] if given_up else []
    return [*defects, *report.get("shortfalls", ())]


class GraphRun:
    """Runs graph.sh and shows what its programs do."""

    def __init__(self, plan: RunPlan, display: Display) -> None:
        self._plan, self._display = plan, display
        self._key_file = plan.folder / run_folder.KEY_FILE
        self._bus = open_bus(plan.config.run.bus, new_key(self._key_file, plan.name))
        self._watch = RunWatch(self._bus, RunState(budget=plan.interactions))
        self._training = TrainingWatch(plan.folder)
        self._stall = Stall(time.monotonic())
        self._restarts = 0
        self._failure: list[str] = []  # lines of graph.sh that tell why it ended
        if self._bus.warning:
            display.note(self._bus.warning)

    def run(self) -> dict[str, Any]:
        """Waits for the end of all programs and returns further figures for summary.json.

        Raises RunError if a program failed, UserError if it reported bad input, StoppedError on a
        signal.
        """
        log = self._plan.folder / "logs" / "graph.log"
        try:
            graph = run_child("graph", self._command(), log, self._step, _GRACE)
            self._bus.spin(0.0)  # messages that arrived since the last step
        finally:
            self._bus.unsubscribe()
            self._key_file.unlink(missing_ok=True)
        self._read_log(graph)
        defects, status = generation_defects(self._plan), graph.exit_status()
        fell_short = status == 1 and defects and set(self._failure) <= set(defects)
        if status and not fell_short:
            raise self._error(graph, status)
        return {
            "worker_restarts": self._restarts,
            "counters": self._watch.counters(),
            "defects": defects,
        }

    def _command(self) -> list[str]:
        plan = self._plan
        flags = [*(["--resume"] if plan.resume else []), *log_sinks.flags(plan.sinks)]
        consumer = ["trainer", *flags] if plan.train else ["recorder"]
        settings = (
            "RTG_KEY=given",
            f"RTG_NODES={os.environ.get('RTG_NODES', paths.PROGRAMS)}",
            f"RTG_PYTHON={os.environ.get('RTG_PYTHON', sys.executable)}",
        )
        return ["env", *settings, str(paths.GRAPH), str(plan.folder), *consumer]

    def _step(self, graph: Node) -> None:
        self._bus.spin(_POLL)
        self._read_log(graph)
        state = self._training.update(self._watch.state)
        self._stall.check(state, time.monotonic())
        self._display.show(state)

    def _read_log(self, graph: Node) -> None:
        for line in graph.new_log_lines():
            if line.endswith(_RESTARTED):
                self._restarts += 1
                self._display.note(line)
            else:
                self._failure.append(line)

    def _error(self, graph: Node, status: int) -> Exception:
        if status == 2 and self._failure:
            return UserError(self._failure[-1])
        words = f"graph.sh ended with exit status {status}{graph.why_mute()}"
        return RunError("\n".join(self._failure) or words)


def run(plan: RunPlan, display: Display) -> dict[str, Any]:
    """Generates and trains at the same time; returns further figures for summary.json."""
    return GraphRun(plan, display).run()
