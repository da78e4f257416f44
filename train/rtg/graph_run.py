"""A run as a graph of processes over LCM."""

from __future__ import annotations

import sys
import time
from typing import Any

from rtg import _core, lcm_tools, paths
from rtg.bus import Bus
from rtg.errors import RunError
from rtg.interrupts import Interrupts
from rtg.process_graph import ProcessGraph
from rtg.progress import Display, RunState
from rtg.recorder import Recorder
from rtg.run_plan import RunPlan
from rtg.run_watch import RunWatch
from rtg.training_watch import TrainingWatch
from rtg.transition_stream import TransitionStream

_POLL = 0.1  # [s]


class GraphRun:
    """The programs, and what this process does meanwhile: it watches, replaces dead workers, and
    consumes the transition stream beside the trainer to write transitions.npz."""

    def __init__(self, plan: RunPlan, display: Display) -> None:
        self._plan, self._display = plan, display
        task = _core.Config.from_file(plan.config_file).task
        bus = Bus(plan.config["run"]["bus"], plan.name)
        self._watch = RunWatch(bus, RunState(budget=plan.interactions))
        self._training = TrainingWatch(plan.folder)
        self._recorder = Recorder(task)
        self._stream = TransitionStream(bus, task.bodies, task.headings, self._recorder.add)
        self._graph = ProcessGraph(plan.folder / "logs")
        self._start = time.monotonic()
        self._generate_wall_s: float | None = None

    def run(self) -> dict[str, Any]:
        """Starts everything, waits for the end of it; returns what was measured."""
        with Interrupts(on_demand=self._graph.kill) as interrupts:
            try:
                self._start_programs()
                while self._graph.working():
                    self._step()
                    interrupts.raise_if_requested()
                self._finish_generation()
            finally:
                self._graph.stop()
        return {
            "generate_wall_s": self._generate_wall_s,
            "lost_transitions": self._stream.lost,
            "worker_restarts": self._graph.restarts,
            "counters": self._watch.counters(),
        }

    def _start_programs(self) -> None:
        plan, graph = self._plan, self._graph
        arguments = [plan.config_file, plan.name]
        if plan.config["run"]["record"]:
            url, log = plan.config["run"]["bus"], plan.folder / "lcm.log"
            graph.add("lcm_logger", lcm_tools.logger_command(url, log), helper=True)
        server = paths.program("rtg_forward_sim_server")
        graph.add("forward_sim_server", [server, *arguments], helper=True)
        worker = paths.program("rtg_reverse_worker")
        for number in range(plan.config["run"]["workers"]):
            name = f"reverse_worker_{number}"
            graph.add(name, [worker, *arguments, str(number)], helper=True)
        consumers = 2 if plan.train else 1
        coordinator = paths.program("rtg_beam_coordinator")
        graph.add(
            "beam_coordinator", [coordinator, *arguments, plan.folder, "--consumers", str(consumers)]
        )
        if plan.train:
            trainer = [sys.executable, "-m", "rtg.trainer", plan.folder, "--run", plan.name]
            graph.add("trainer", trainer)

    def _step(self) -> None:
        self._stream.poll(_POLL)
        for note in self._graph.tend(leaving=self._watch.leaving):
            self._display.note(note)
        if self._stream.complete and self._generate_wall_s is None:
            self._finish_generation()
        self._display.show(self._training.update(self._watch.state))

    def _finish_generation(self) -> None:
        if self._generate_wall_s is not None:
            return
        if not self._stream.complete:
            raise RunError(f"the coordinator ended with {self._stream.lost} transitions unsent")
        self._generate_wall_s = time.monotonic() - self._start
        self._recorder.write(self._plan.folder / "transitions.npz")


def generate_and_train(plan: RunPlan, display: Display) -> dict[str, Any]:
    """The whole job; returns what was measured, for summary.json."""
    return GraphRun(plan, display).run()
