"""Training on a finished transition set."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from rtg.files.run_folder import read_json
from rtg.processes.graph import ProcessGraph
from rtg.processes.interrupts import Interrupts
from rtg.run.plan import RunPlan
from rtg.run.progress import Display, RunState
from rtg.run.training_watch import TrainingWatch

_POLL = 0.1  # [s]


def trainer_command(plan: RunPlan, *flags: str) -> Sequence[str | Path]:
    """Returns the command that starts the learner."""
    resume = ["--resume"] if plan.resume else []
    return [sys.executable, "-m", "rtg.learn.trainer", plan.folder, *resume, *flags]


def _initial_state(plan: RunPlan) -> RunState:
    """Returns the state to display before training, with the figures of the generation."""
    if not plan.offline:
        return RunState(generates=False, budget=plan.interactions)
    report = read_json(plan.report_file)
    return RunState(
        phase="done",
        transitions=report["transitions"],
        target=report["transitions"],
        contact_share=report["contact_share"],
        start_region=report["start_region_transitions"],
        budget=plan.interactions,
    )


def run(plan: RunPlan, display: Display) -> None:
    """Trains in a separate process, so that training can be stopped at any time."""
    graph = ProcessGraph(plan.folder / "logs")
    watch = TrainingWatch(plan.folder)
    state = _initial_state(plan)
    with Interrupts(on_second_signal=graph.kill) as interrupts:
        try:
            graph.add("trainer", trainer_command(plan, "--no-stream"))
            while graph.wait(_POLL):
                graph.check_and_restart()
                display.show(watch.update(state))
                interrupts.raise_if_requested()
        finally:
            graph.stop()
    graph.check_and_restart()
