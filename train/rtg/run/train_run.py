"""Training on a finished transition set."""

from __future__ import annotations

import sys

from rtg.files.run_folder import read_json
from rtg.processes.children import Node, kill_all, stop_all
from rtg.processes.interrupts import Interrupts
from rtg.run.plan import RunPlan
from rtg.run.progress import Display, RunState
from rtg.run.training_watch import TrainingWatch

_POLL = 0.1  # [s]


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
    flags = ["--no-stream", *(["--resume"] if plan.resume else [])]
    command = [sys.executable, "-m", "rtg.learn.trainer", str(plan.folder), *flags]
    watch, state = TrainingWatch(plan.folder), _initial_state(plan)
    logs = plan.folder / "logs"
    logs.mkdir(parents=True, exist_ok=True)
    nodes: list[Node] = []
    with Interrupts(on_second_signal=lambda: kill_all(nodes)) as interrupts:
        try:
            nodes.append(Node("trainer", command, logs / "trainer.log"))
            while not nodes[0].wait(_POLL):
                display.show(watch.update(state))
                interrupts.raise_if_requested()
        finally:
            stop_all(nodes)
    nodes[0].raise_if_failed()
