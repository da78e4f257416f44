"""Performs the runs of a comparison (methods x seeds x tasks) in parallel and writes its report."""

from __future__ import annotations

import sys

from rtg.compare import grouped_seeds, shards
from rtg.compare.cell_run import prepare_runs
from rtg.compare.cells import update_grid
from rtg.compare.executors import choice
from rtg.compare.grid_display import Row, counts, display
from rtg.compare.job_pool import Failures, JobPool
from rtg.compare.reproduce_args import ReproduceArgs
from rtg.errors import RunError, StoppedError
from rtg.files import run_folder
from rtg.processes.interrupts import Interrupts

_POLL = 0.2  # [s]


def reproduce(args: ReproduceArgs) -> int:
    """Runs the comparison, writes its report and returns the exit status.

    Other commands may work on the same folder at the same time. Raises UserError before the first
    run if the arguments are illegal or do not fit the folder. Raises UserError after the last run
    if a file of a run is damaged. Raises RunError if the user stopped the comparison.
    """
    runs = prepare_runs(args)
    with run_folder.write_errors_as_user_errors(args.out):
        args.out.mkdir(parents=True, exist_ok=True)
    with choice.opened(args.executor, args.executor_options, args.out) as executor:
        with run_folder.write_errors_as_user_errors(args.out):
            update_grid(args.out, lambda grid: grid.add(args.command, args.cells))
        # If a job of these stages fails, the run itself does the work again.
        for stage in (*shards.stages(runs), *grouped_seeds.stages(runs, args.together)):
            _run_all(args, JobPool(stage, executor, args.jobs))
        rows = _run_all(args, JobPool(runs, executor, args.jobs, Failures(args.out)))
    from rtg.compare.report_files import write_report  # imports matplotlib, which takes long

    report = write_report(args.out, args.out)
    print(f"{counts(rows)}\nreport: {report}")
    return 1 if any(row.phase == "failed" for row in rows) else 0


def _run_all(args: ReproduceArgs, pool: JobPool) -> list[Row]:
    """Does all jobs and returns the final row of each. Raises RunError if the user stopped them."""
    with display(sys.stdout) as shown, Interrupts(on_second_signal=pool.kill) as interrupts:
        try:
            while pool.poll(shown):
                pool.wait(_POLL)
                interrupts.raise_if_requested()
        except StoppedError:
            raise RunError(f"stopped; to go on: {args.command_line}") from None
        finally:
            pool.stop()
    return pool.rows()
