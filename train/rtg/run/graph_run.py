"""A run as a graph of processes over LCM."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import Any

from rtg import paths
from rtg.bus import lcm_tools
from rtg.bus.bus import Bus
from rtg.bus.transition_stream import TransitionStream
from rtg.errors import RunError
from rtg.files import run_folder
from rtg.files.recorder import Recorder
from rtg.processes.graph import ProcessGraph
from rtg.processes.interrupts import Interrupts
from rtg.run.plan import RunPlan
from rtg.run.progress import Display, RunState
from rtg.run.run_watch import RunWatch
from rtg.run.train_run import trainer_command
from rtg.run.training_watch import TrainingWatch

_POLL = 0.1  # [s]
_EXIT_GRACE = 5.0  # [s] that the coordinator may take to end after all rows were consumed


class _Recording:
    """Receives and records the transitions (rows) of a run without a trainer."""

    def __init__(self, plan: RunPlan, bus: Bus) -> None:
        task = plan.config.task
        self._recorder = Recorder(task)
        self._stream = TransitionStream(bus, task.bodies, task.headings, self._recorder.add)

    def poll(self, timeout: float) -> None:
        self._stream.poll(timeout)

    @property
    def complete(self) -> bool:
        return self._stream.complete

    def write(self, plan: RunPlan) -> int:
        """Writes transitions.npz if no row is missing; returns the number of missing rows."""
        missing = int(run_folder.read_json(plan.report_file)["transitions"]) - self._recorder.count
        if missing == 0:
            self._recorder.write(plan.transitions_file)
        return missing


def generation_defects(plan: RunPlan) -> list[str]:
    """Describes the defects of the finished generation; [] without defects or generation."""
    report = run_folder.read_json(plan.report_file)
    wanted = plan.config.search.transitions
    given_up, found = report.get("units_given_up", 0), report.get("transitions", wanted)
    defects = [f"the coordinator gave up {given_up} units of work"] if given_up else []
    if found < wanted:
        what = plan.config.search.generator
        defects.append(
            f"the search ({what}) found {found:,} transitions of the {wanted:,} asked for and then "
            "nothing more, see generation.json; a wider one may find more (search.breadth, "
            "search.gap_tolerance)"
        )
    return defects


class GraphRun:
    """Starts the programs of a run, watches them and restarts dead workers."""

    def __init__(self, plan: RunPlan, display: Display) -> None:
        self._plan, self._display = plan, display
        self._bus = Bus(plan.config.run.bus, plan.name)
        self._watch = RunWatch(self._bus, RunState(budget=plan.interactions))
        self._training = TrainingWatch(plan.folder)
        self._recording = None if plan.train else _Recording(plan, self._bus)
        self._graph = ProcessGraph(plan.folder / "logs")
        self._sealed = False
        self._consumed = math.inf  # [s], when the consumer was first seen to be finished
        if self._bus.warning:
            display.note(self._bus.warning)

    def run(self) -> dict[str, Any]:
        """Starts all programs, waits for their end and returns further figures for summary.json.

        Raises RunError if transitions are missing, StoppedError on a signal.
        """
        with Interrupts(on_second_signal=self._graph.kill) as interrupts:
            try:
                self._start_programs()
                while self._graph.working() and not self._is_over():
                    self._step()
                    interrupts.raise_if_requested()
                self._graph.check_and_restart(leaving=True)
                self._listen(0.0)  # messages that arrived since the last step
                defects = self._graph.failures()
            finally:
                self._graph.stop()
                self._bus.close()
        missing = self._recording.write(self._plan) if self._recording else 0
        if missing:
            raise RunError(f"the coordinator ended, {missing} transitions have not arrived")
        return {
            "lost_transitions": missing,
            "worker_restarts": self._graph.restarts,
            "counters": self._watch.counters(),
            "defects": defects or generation_defects(self._plan),
        }

    def _start_programs(self) -> None:
        plan, graph = self._plan, self._graph
        arguments: list[str | Path] = [plan.config_file, plan.name]
        if plan.config.run.record:
            url, log = plan.config.run.bus, plan.folder / "lcm.log"
            graph.add("lcm_logger", lcm_tools.logger_command(url, log), helper=True)
        server = paths.program("rtg_forward_sim_server")
        graph.add("forward_sim_server", [server, *arguments], helper=True)
        worker = paths.program("rtg_reverse_worker")
        for number in range(plan.config.run.workers):
            name = f"reverse_worker_{number}"
            graph.add(name, [worker, *arguments, str(number)], helper=True)
        coordinator = paths.program("rtg_beam_coordinator")
        graph.add("beam_coordinator", [coordinator, *arguments, plan.folder])
        if plan.train:
            graph.add("trainer", trainer_command(plan, "--run-name", plan.name))

    def _listen(self, seconds: float) -> None:
        if self._recording:
            self._recording.poll(seconds)
        else:
            self._bus.spin(seconds)

    def _step(self) -> None:
        self._listen(_POLL)
        if self._watch.state.phase == "sealed" and not self._sealed:
            self._on_sealed()
        for note in self._graph.check_and_restart(leaving=self._watch.leaving):
            self._display.note(note)
        self._display.show(self._training.update(self._watch.state))

    def _is_over(self) -> bool:
        """Returns whether the run is over although the coordinator has not ended.

        The coordinator waits for the final acknowledgements of consumers, which may be lost.
        """
        if not self._sealed or (self._plan.train and self._graph.working("trainer")):
            return False
        if self._recording and not self._recording.complete:
            return False
        now = time.monotonic()
        self._consumed = min(self._consumed, now)
        return now - self._consumed > _EXIT_GRACE

    def _on_sealed(self) -> None:
        """Tolerates failures of the coordinator from now on, because its search is over."""
        self._sealed = True
        self._graph.ignore_failure("beam_coordinator")


def run(plan: RunPlan, display: Display) -> dict[str, Any]:
    """Generates and trains at the same time; returns further figures for summary.json."""
    return GraphRun(plan, display).run()
