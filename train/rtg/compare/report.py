"""The report of a comparison: one Markdown page."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from rtg import paths
from rtg.compare import report_robustness as robustness
from rtg.compare import report_tables as tables
from rtg.compare.cells import Grid
from rtg.compare.estimates import RESAMPLES
from rtg.compare.methods import RANDOMISED, REFERENCE
from rtg.compare.report_costs import NOTE as COST_NOTE
from rtg.compare.report_costs import cost_comparison
from rtg.compare.run_results import THRESHOLD, Comparison, RunResult
from rtg.errors import UserError
from rtg.files import own_data, replay_gaps

_LEGEND = f"""\
Means ± standard deviations over the seeds. **success**: of the final greedy policy from held-out
starts, objects jittered by `task.start_jitter`, that no earlier evaluation has used. In a state
to which an episode returns, the policy takes the best action that it has not yet tried there,
unless `train.leave_loops` is off. **length**: pushes of its episodes, failures included;
**roll-outs**: of the last 100 training episodes from the starts of the task, exploration
included; **at ⅓**: greedy success at a third of the budget, from other held-out starts, or the
final one of a run that had ended by then; **to 0.70**, **to {THRESHOLD}**: thousand interactions
until the first of two evaluations in a row with that greedy success, the final one counted as
the last ("2 of 3": so many of the seeds ever), and **pushes** (in thousands) and **CPU s** of
the whole run until then. Exploration falls over a share of the budget (`train.epsilon_share`),
so that these depend on the budget. Pushes are those of the forward simulator for data, starts,
interactions and plans. CPU seconds are those of all threads (of several runs in one process,
those of the run's thread). Both leave out evaluations, but for the CPU seconds of learning in
the second table. Methods without interactions have the rounds of learning here that so many
would have brought. In the second table of a task, which says what the whole run cost,
**transitions**, **pushes** and **interactions** are in thousands, and wall clock is that of
generation on one core, of learning on what is named *learner* above. All figures are in
[runs.csv](runs.csv), the learning curves in [curves.csv](curves.csv); in their pictures a run
that ended early keeps its last value, and of more rows than there are methods those with swept
settings are left out. Strips and films show the shortest successful episode of the final
evaluations, of `{REFERENCE}` if it has one."""
_POOLED = f"""\
IQM: mean of the final successes without the lowest and the highest quarter of them, over the
tasks that more than one method was run on, if any; mean: that of the tasks' means; both with a
95 % interval by stratified bootstrap (seeds drawn within a task, {RESAMPLES:,} resamples), which
does not cover the choice of the starts, the same for all runs; lowest: of all runs. Last column:
the probability that a run of the method does better than one of `{REFERENCE}` on the same task,
mean over the tasks, equal ones counted half. Single seeds have no interval, and of few it is too
narrow. Methods with fewer tasks are not comparable with those with more, nor is `{RANDOMISED}`
with any: its starts, also those it is measured from, lie all over a wider region."""
_PROFILES = "Share of a method's runs with at least that final success, mean over the tasks:"
REMARKS = "remarks.md"  # beside grid.json
_QUICK = (
    "**Small budgets (`--quick`): these figures show that everything works and are no results.**"
)
_RUNTIME = """\
CPU time per reverse solve that was not pruned, and per push of the simulator; how many solves
and pushes, the share of the solves that converged, and of these of the ones that move an object,
which take more of the time, and their iterations. The paper's figures (Appendix E) are wall
time: of a backward action, that of 48 in parallel on 16 cores, divided by 48."""
_DATA = f"""\
**transitions**: stored, in thousands; **tree rows**: of them steps found backwards and kept;
**branches**: outcomes of other headings in the same states; **headings per state**: distinct ones
stored from a state; **contact share**: of the transitions, those that move an object; **trees**:
how many were grown; **replay gap**: distance between the state in which the push of a reverse step
was to end and that in which it ends in the simulator, mean over the bodies, in {replay_gaps.UNIT};
quantiles over simulated reverse steps; **rank correlation of Q**: Spearman's, of the
learner's final Q with the simulator over all headings of a stored state, mean over some hundred
states; **error**: root mean square of the difference; **spread**: standard deviation of the
simulator's values over the headings of a state, mean over the states. States are those of a run's
own data and values beyond a success what its own Q says, so that these three judge data of one
method, not methods against each other."""


def _listed(name: str, done: Sequence[RunResult], of: Callable[[RunResult], str]) -> str:
    """Returns the line on what `of` says of the runs. If it differs, adds the runs of each.

    The difference between runs of different commits or machines may not come from the methods.
    """
    found: dict[str, list[RunResult]] = {}
    for run in done:
        found.setdefault(of(run), []).append(run)
    if len(found) < 2:
        return f"- {name}: " + (next(iter(found), "unknown"))
    lines = [f"  - {words}: {tables.run_names(runs)}" for words, runs in found.items()]
    return "\n".join([f"- {name}, not the same for all runs:", *lines])


def _machine(versions: dict[str, Any]) -> str:
    model, memory = versions.get("processor"), versions.get("memory_gib")
    parts = [model or "unknown processor", f"{versions.get('processors')} cores"]
    parts += [f"{memory} GiB"] if memory else []
    return ", ".join([*parts, versions.get("system", "unknown system")])


def _learner(summary: dict[str, Any]) -> str:
    if not summary.get("gradient_steps", 1):
        return "none"
    runs = summary.get("runs_in_process") or 1
    shared = f"{runs} runs in one process" if runs > 1 else "one core"
    parts = [summary.get("device") or "unknown device", summary.get("precision"), shared]
    return ", ".join(part for part in parts if part)


def _programs(versions: dict[str, Any]) -> str:
    packages = {**versions.get("packages", {}), **versions.get("debian", {})}
    named = [f"{name} {version}" for name, version in packages.items()]
    return ", ".join([f"Python {versions.get('python')}", *named])


def _given_data(done: Sequence[RunResult]) -> list[str]:
    """Returns a line for each data set that runs were given."""
    found = {run.cell.label: run.summary["data"] for run in done if run.summary.get("data")}
    return [f"- data of `{label}`: {own_data.words(data)}" for label, data in found.items()]


def _origin(grid: Grid, comparison: Comparison) -> str:
    done = comparison.all_done()
    lines = [f"    {command}" for command in grid.commands]
    return "\n".join(
        [
            *lines,
            "",
            _listed("commit", done, lambda run: run.commits),
            _listed("machine", done, lambda run: _machine(run.versions)),
            *_given_data(done),
            _listed("learner", done, lambda run: _learner(run.summary)),
            _listed("with", done, lambda run: _programs(run.versions)),
        ]
    )


def _brief(name: str, words: str) -> str:
    """Shortens the failure message `words` of run `name` to its first and its last line.

    The last line is that of the quoted log.
    """
    how, *log = words.splitlines()
    how = how.removeprefix(f"{name} ").removesuffix("; the end of its log:")
    return f"{how}: {log[-1]}" if log else how


def _trouble_section(grid: Grid, runs: Sequence[RunResult]) -> list[str]:
    """Returns the section on failures and defects of `runs`; [] if there are none."""
    lines = []
    for run in runs:
        name = f"`{run.cell.name}`"
        if run.state == "failed":
            lines.append(
                f"- {name} failed: {_brief(run.cell.name, grid.failure_by_name[run.cell.name])}"
            )
        lines += [f"- {name}: {defect}" for defect in run.summary.get("defects", [])]
    return ["## Trouble", "\n".join(lines)] if lines else []


def _picture(folder: Path, name: str, words: str) -> list[str]:
    return [f"![{words}]({name})"] if (folder / name).is_file() else []


def _described(words: str, picture: list[str]) -> list[str]:
    return [words, *picture] if picture else []


def _numbers(values: Iterable[float]) -> str:
    return " or ".join(f"{value:,}" for value in sorted(set(values)))


def _budget(runs: Sequence[RunResult]) -> list[str]:
    """Returns a line on how long runs learn, and how they are evaluated; [] if none learns."""
    learners = [run for run in runs if not run.is_planned]
    settings = [run.train for run in learners if run.train is not None]
    if not settings:
        return []
    final = _numbers(run.summary.get("final_episodes") or 0 for run in learners)
    early = sum(run.ended_early for run in learners)
    return [
        f"Budget: {_numbers(one.interactions for one in settings)} interactions, an evaluation "
        f"every {_numbers(one.eval_every for one in settings)} from "
        f"{_numbers(one.eval_episodes for one in settings)} starts, the final one from "
        f"{final if final != '0' else 'as many'}. {early or 'None'} of the {len(learners)} runs "
        "ended before, because their success was enough."
    ]


def _task_section(folder: Path, comparison: Comparison, task: str) -> list[str]:
    done = [run for run in comparison.all_done() if run.cell.task == task]
    return [
        f"## {task}",
        *_budget(done),
        tables.results_table(comparison, task),
        tables.cost_table(comparison, task),
        *_picture(folder, f"costs_{task}.png", f"Success against cost on {task}"),
        *_picture(folder, f"curves_{task}.png", f"Learning curves on {task}"),
        *_picture(folder, f"sweep_{task}.png", f"What the swept values do on {task}"),
        *_picture(folder, f"strip_{task}.png", f"An episode of {task} in pictures"),
        *_picture(folder, f"film_{task}.gif", f"The same episode of {task} as a film"),
    ]


def _cost_section(comparison: Comparison) -> list[str]:
    """Returns the section that compares costs with the reference; [] without other labels."""
    shown = cost_comparison(comparison)
    return [f"## Beside `{REFERENCE}`", shown, COST_NOTE] if shown else []


def _robustness_section(folder: Path, comparison: Comparison) -> list[str]:
    """Returns the section on evaluations elsewhere; [] if there are none."""
    parts = []
    for task in comparison.tasks:
        if robustness.is_evaluated(comparison, task):
            parts.append(robustness.robustness_table(comparison, task))
            name = f"robustness_{task}.png"
            parts += _picture(folder, name, f"Success on {task} where it was not trained")
    return ["## Where it was not trained", robustness.NOTE, *parts] if parts else []


def read_remarks(runs: Path) -> str:
    """Returns the text that people wrote in remarks.md; "" if there is no file.

    Raises UserError if the file cannot be read.
    """
    path = runs / REMARKS
    if not path.is_file():
        return ""
    try:
        return path.read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(f"{path}: {error}; legal: text in UTF-8, or no such file") from None


def report(folder: Path, grid: Grid, comparison: Comparison, remarks: str) -> str:
    """Returns the Markdown page of the report. It shows the pictures that exist in `folder`."""
    missing = ", ".join(f"`{method}`" for method in tables.not_run(comparison))
    parts = [
        "# Results",
        f"Written by `{paths.COMMAND} plot` from the folders of these runs and `{REMARKS}`.",
        *([_QUICK] if any("--quick" in command.split() for command in grid.commands) else []),
        _origin(grid, comparison),
        *_trouble_section(grid, comparison.results),
        _LEGEND + (f" Not run: {missing}." if missing else ""),
        *(part for task in comparison.tasks for part in _task_section(folder, comparison, task)),
        "## All tasks together",
        tables.pooled_table(comparison),
        _POOLED,
        *_described(_PROFILES, _picture(folder, "profiles.png", "Performance profiles")),
        *_cost_section(comparison),
        "## Run time",
        tables.runtime_table(comparison),
        _RUNTIME,
        "## Data",
        tables.data_table(comparison),
        _DATA,
        *_picture(folder, "replay_gap.png", "Histogram of the replay gap"),
        *_robustness_section(folder, comparison),
        *(["## Remarks", remarks] if remarks else []),
    ]
    return "\n\n".join(parts) + "\n"
