"""Training on a finished transition set."""

from __future__ import annotations

import sys

from rtg import errors
from rtg.files.run_folder import read_json
from rtg.learn import log_sinks
from rtg.processes.child_run import run_child
from rtg.processes.children import Node
from rtg.run.plan import RunPlan
from rtg.run.progress import Display
from rtg.run.run_state import FINISHED, RunState
from rtg.run.training_watch import TrainingWatch

_POLL = 0.1  # [s]


def _initial_state(plan: RunPlan) -> RunState:
    """Returns the state to display before training, with the figures of the generation."""
    if not plan.offline:
        return RunState(generates=False, budget=plan.interactions)
    report = read_json(plan.report_file)
    with errors.fields_of(plan.report_file):
        return RunState(
            phase=FINISHED,
            transitions=report["transitions"],
            target=report["transitions"],
            contact_share=report["contact_share"],
            starts_reached=report.get("starts_reached", 0),  # no trees made own data
            budget=plan.interactions,
        )


def run(plan: RunPlan, display: Display) -> None:
    """Trains in a separate process, so that training can be stopped at any time."""
    flags = ["--no-stream", *(["--resume"] if plan.resume else []), *log_sinks.flags(plan.sinks)]
    command = [sys.executable, "-m", "rtg.learn.trainer", str(plan.folder), *flags]
    watch, state = TrainingWatch(plan.folder), _initial_state(plan)

    def step(trainer: Node) -> None:
        trainer.wait(_POLL)
        display.show(watch.update(state))

    run_child("trainer", command, plan.folder / "logs" / "trainer.log", step).raise_if_failed()
