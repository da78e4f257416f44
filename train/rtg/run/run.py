"""A run from the configuration to the results."""

from __future__ import annotations

import shlex
import sys
from typing import Any

from rtg import paths
from rtg.errors import RunError, StoppedError
from rtg.files import locks, own_data, run_folder
from rtg.run import effective_config
from rtg.run.early_pictures import EarlyPictures
from rtg.run.plan import RunPlan, make_plan
from rtg.run.progress import Display, display
from rtg.run.run_args import RunArgs
from rtg.run.run_times import RunTimes
from rtg.run.time_left import usual_rate


def run(args: RunArgs) -> int:
    """Carries out `rtg run`; returns the exit status.

    Raises UserError for bad input. Raises RunError if a part of the run failed or the user stopped
    the run.
    """
    if args.print_config:
        print(effective_config.load(args.file, args.overrides).yaml, end="")
        return 0
    if args.resume:
        with locks.exclusive_lock(args.file.parent, "another run"):
            return _carry_out(make_plan(args))
    plan = make_plan(args)
    with locks.exclusive_lock(plan.folder, "another run"):
        return _carry_out(plan)


def _carry_out(plan: RunPlan) -> int:
    """Generates, trains and writes the results; returns the exit status."""
    screen = display(sys.stdout, usual_rate(plan.config.train))
    with RunTimes(screen) as shown, EarlyPictures(plan, shown.note) as pictures:
        for note in (f"{plan.title}: {plan.folder}", *plan.notes):
            shown.note(note)
        try:
            measured = _generate_and_train(plan, shown)
        except StoppedError:
            pictures.warn_again()
            flags = "--resume" if plan.train else "--resume --no-train"
            command = f"{paths.COMMAND} {flags} --out {shlex.quote(str(plan.folder))}"
            raise RunError(f"stopped; to go on: {command}") from None
        pictures.finish()
        from rtg.run import results  # imports matplotlib

        results.draw(plan)
        summary = results.finish(plan, {**measured, **shown.seconds()})
    print(results.summary_text(plan, summary))
    for defect in measured["defects"]:
        print(f"rtg: {defect}", file=sys.stderr)
    return 1 if measured["defects"] else 0


def _generate_and_train(plan: RunPlan, shown: Display) -> dict[str, Any]:
    from rtg.run import graph_run, in_process, train_run

    if not plan.offline:
        shown.note("no generated data: all that is learned or planned comes from the simulator")
    elif plan.is_generated():
        (plan.folder / run_folder.JOURNAL_FILE).unlink(missing_ok=True)
        report = run_folder.read_json(plan.report_file) if plan.own_data else None
        shown.note(
            own_data.words(report["data"]) if report else "the transitions are there already"
        )
    elif plan.in_process:
        in_process.generate(plan, shown)
    else:
        return graph_run.run(plan, shown)
    if plan.train:
        if plan.resume and run_folder.checkpoint_file(plan.folder).exists():
            shown.note(_what_is_left(plan))
        train_run.run(plan, shown)
    return {"defects": graph_run.generation_defects(plan)}


def _what_is_left(plan: RunPlan) -> str:
    done = run_folder.read_json(plan.folder / "training_state.json").get("interactions", 0)
    if done >= plan.interactions:
        return f"nothing is left to learn: {done:,} of {plan.interactions:,} interactions are done"
    return "learning goes on from its last checkpoint"
