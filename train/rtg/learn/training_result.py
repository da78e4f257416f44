"""The figures of a finished training run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rtg.learn.evaluation import Evaluation
from rtg.learn.value_check import MAX_STATES, check_values, stored_states

if TYPE_CHECKING:
    from rtg.learn.training import Training

_VALUE_CHECK_COLUMNS = ("q_rank_correlation", "q_error", "q_spread")  # of ValueCheck.summary()


def figures(run: Training, final: Evaluation) -> dict[str, Any]:
    """Returns the content of training.json."""
    return {
        "interactions": run.interactions,
        "gradient_steps": run.model.gradient_steps,
        "online_successes": run.env.successes,
        **final.summary(),
        "final_episodes": len(final.success),
        **run.model.recent_episodes(),
        **{f"train_{name}": round(spent, 3) for name, spent in run.clock.seconds().items()},
        "learning_stages": run.model.stages.seconds(),
        "offline_transitions": run.data.count,
        "learning_pushes": run.pushes,
        **run.device_info,
        **_counts(run),
        **_value_check(run),
    }


def _counts(run: Training) -> dict[str, int]:
    """Returns the counts that only some methods have."""
    found = {}
    if run.env.curriculum:
        found["curriculum_pushes"] = run.env.curriculum.pushes
    if run.settings.learner == "cloning":
        found["imitated_transitions"] = run.model.replay.size()
    return found


def _value_check(run: Training) -> dict[str, float | None]:
    """Returns the figures of check_values(); {} without Q-learning or without stored states."""
    if run.settings.learner != "q_learning" or not run.data.count:
        return {}
    states = stored_states(run.data.record.transitions(), MAX_STATES, run.seed)
    found = check_values(run.config, run.model.values, run.discount, states)
    return {**dict.fromkeys(_VALUE_CHECK_COLUMNS), **(found.summary() if found else {})}
