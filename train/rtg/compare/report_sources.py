"""Decides from the figures alone on which tasks reverse simulation is the better data source."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rtg.compare.methods import METHODS, RANDOMISED, REFERENCE
from rtg.compare.report_tables import NO_VALUE, spread, table, thousands
from rtg.compare.run_results import COSTS, THRESHOLD, Comparison

Floats = NDArray[np.float64]

# Methods that learn from data of a source other than reverse simulation.
SOURCES = ("ddqn_random", "ddqn_scatter", "ddqn_naive", "ddqn_forward")
# Methods whose costs are shown as multiples of those of the reference.
COMPARED_METHODS = ("ddqn_forward", "ddqn_naive", "planner")
_COST_NAMES = {"interactions": "interactions", "pushes": "pushes", "cpu_s": "CPU seconds"}
_COST_HEADS = {"interactions": "interactions [1000]", "pushes": "pushes [1000]", "cpu_s": "CPU [s]"}
NOTE = f"""\
Costs up to the first evaluation with a greedy success of {THRESHOLD} or more: interactions of the
learner; pushes and CPU seconds of the whole run, generation included. **fewest**: of all
methods whose every seed gets there (`{RANDOMISED}` aside, whose starts are others; interactions are
compared among those that make any). Other columns: multiples of what `{REFERENCE}` needs, or how
many seeds get there. `planner` searches anew from every start: its costs are the sum over all
held-out starts of the evaluation (`train.eval_episodes`, 100 by default); divide them for one.
Reverse simulation is the source of `{REFERENCE}`, whose backward steps a solver finds; those of
`ddqn_naive` are of kinematics alone. Compared are the sources that were run of
{", ".join(f"`{method}`" for method in SOURCES)}. Reverse simulation is the **better** one if every
seed of `{REFERENCE}` needs less than every seed of the others named, **not** the better one if
every seed of a source named needs less than every seed of `{REFERENCE}`, **level** if seeds of
`{REFERENCE}` and of the sources named overlap, **unable** to get there if no seed of any source
does. A seed that does not counts as more than any that does, a source none of whose seeds does as
more than any seed of `{REFERENCE}`, too."""


def _costs(comparison: Comparison, task: str, method: str, cost: str) -> Floats:
    """Returns the cost of each seed until its greedy success reaches THRESHOLD. [seeds]

    The cost is infinite if a seed never reaches THRESHOLD. The cost "interactions" leaves out runs
    without interactions.
    """
    runs = comparison.done(task, method)
    needed = [
        run.cost_to_reach(THRESHOLD, cost)
        for run in runs
        if run.interacts or cost != "interactions"
    ]
    return np.array([np.inf if value is None else value for value in needed])


def _all_reach_threshold(costs: Floats) -> bool:
    return len(costs) > 0 and bool(np.isfinite(costs).all())


def _mean_cost(costs: Floats, cost: str) -> str:
    known = [float(value) if np.isfinite(value) else None for value in costs]
    shown = known if cost == "cpu_s" else [thousands(value) for value in known]
    return "never" if known and not np.isfinite(costs).any() else spread(shown, "count")


def _fewest(comparison: Comparison, task: str, cost: str) -> str:
    found = {
        method: costs
        for method in METHODS
        if method != RANDOMISED
        and _all_reach_threshold(costs := _costs(comparison, task, method, cost))
    }
    if not found:
        return NO_VALUE
    best = min(found, key=lambda method: float(found[method].mean()))
    return f"`{best}`: {_mean_cost(found[best], cost)}"


def _cost_ratio(reference: Floats, costs: Floats) -> str:
    """Returns mean(`costs`) / mean(`reference`) as text.

    If a seed of either method never reaches THRESHOLD, returns how many of `costs` do.
    """
    if len(costs) == 0:
        return NO_VALUE
    if _all_reach_threshold(costs) and _all_reach_threshold(reference):
        return f"{costs.mean() / reference.mean():.2f} ×"
    return f"{np.isfinite(costs).sum()} of {len(costs)}"


class _Verdict(NamedTuple):
    """The result of comparing REFERENCE with the methods SOURCES on one task, by one cost."""

    kind: str  # key of _VERDICT_TEXTS; empty if there is nothing to compare
    methods: Sequence[str] = ()  # the sources that the verdict names

    def __str__(self) -> str:
        of_methods = _VERDICT_TEXTS.get(self.kind, NO_VALUE).format(
            costs="", methods=_method_list(self.methods)
        )
        return " ".join(of_methods.split())


_VERDICT_TEXTS = {
    "better": "better {costs} than {methods}",
    "not": "not better {costs} than {methods}",
    "level": "level {costs} with {methods}",
    "unable": f"unable to reach {THRESHOLD} in any seed, like {{methods}}",
}


def _verdict(comparison: Comparison, task: str, cost: str) -> _Verdict:
    reference_costs = _costs(comparison, task, REFERENCE, cost)
    found = {source: _costs(comparison, task, source, cost) for source in SOURCES}
    others = {source: costs for source, costs in found.items() if len(costs)}
    if len(reference_costs) == 0 or not others:
        return _Verdict("")
    if not np.isfinite([*reference_costs, *np.concatenate(list(others.values()))]).any():
        return _Verdict("unable", list(others))
    if less := [source for source, costs in others.items() if max(costs) < min(reference_costs)]:
        return _Verdict("not", less)
    level = [
        source
        for source, costs in others.items()
        if np.isfinite(costs).any() and max(reference_costs) >= min(costs)
    ]
    return _Verdict("level", level) if level else _Verdict("better", list(others))


def _method_list(methods: Sequence[str]) -> str:
    return ", ".join(f"`{method}`" for method in methods)


def _cost_list(costs: Sequence[str]) -> str:
    words = [_COST_NAMES[cost] for cost in costs]
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def _sentence(task: str, verdicts: dict[str, _Verdict]) -> str:
    parts = []
    for kind, words in _VERDICT_TEXTS.items():
        costs = [cost for cost, verdict in verdicts.items() if verdict.kind == kind]
        named = {method for cost in costs for method in verdicts[cost].methods}
        methods = _method_list([source for source in SOURCES if source in named])
        if costs:
            parts.append(words.format(costs=f"by {_cost_list(costs)}", methods=methods))
    if not parts:
        return f"- **{task}**: not known, as `{REFERENCE}` or any other source is missing."
    return f"- **{task}**: reverse simulation is {'; '.join(parts)}."


def better_source(comparison: Comparison) -> str:
    """Returns a sentence for each task, and the table of the figures behind the sentences."""
    sentences, rows = [], []
    for task in comparison.tasks:
        verdicts = {cost: _verdict(comparison, task, cost) for cost in COSTS}
        sentences.append(_sentence(task, verdicts))
        for cost, verdict in verdicts.items():
            reference_costs = _costs(comparison, task, REFERENCE, cost)
            ratios = [
                _cost_ratio(reference_costs, _costs(comparison, task, method, cost))
                for method in COMPARED_METHODS
            ]
            least = _fewest(comparison, task, cost)
            rows.append(
                [
                    task,
                    _COST_HEADS[cost],
                    least,
                    _mean_cost(reference_costs, cost),
                    *ratios,
                    str(verdict),
                ]
            )
    head = [
        "task",
        f"to {THRESHOLD}",
        "fewest",
        *(f"`{method}`" for method in (REFERENCE, *COMPARED_METHODS)),
    ]
    shown = table([*head, "reverse simulation"], rows, left=3)
    return "\n".join(sentences) + "\n\n" + shown
