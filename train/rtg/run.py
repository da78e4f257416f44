"""One run from the configuration to the results."""

from __future__ import annotations

import sys

from rtg import effective_config
from rtg.errors import RunError
from rtg.progress import display
from rtg.run_args import RunArgs
from rtg.run_plan import RunPlan, make_plan


def run(args: RunArgs) -> int:
    """Exit status. Raises UserError for bad input, RunError if a part of the run failed."""
    if args.print_config:
        print(effective_config.canonical(args.file, args.overrides), end="")
        return 0
    plan = make_plan(args)
    return _carry_out(plan)


def _carry_out(plan: RunPlan) -> int:
    from rtg import results

    with display(sys.stdout) as shown:
        shown.note(f"{plan.task_name}, seed {plan.config['run']['seed']}: {plan.folder}")
        for note in plan.notes:
            shown.note(note)
        if plan.in_process:
            from rtg.in_process import generate_and_train
        else:
            from rtg.graph_run import generate_and_train
        measured = generate_and_train(plan, shown)
        shown.note("drawing")
        summary = results.finish(plan, measured)
    print(results.words(plan, summary))
    return 0
