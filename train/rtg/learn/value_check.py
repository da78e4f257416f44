"""Checks in the simulator how well Q(s, ·) ranks the actions in a state.

The policy chooses actions by Q(s, ·), so a good ranking indicates useful data. The check simulates
every heading in some hundred stored states. The value of a heading is 1 if it succeeds, else
γ max_b Q(s', b). Q(s, ·) should rank the actions as these values do.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.engines import simulator as make_simulator
from rtg.files.dataset import Transitions
from rtg.learn.evaluation import Values

Array = NDArray[Any]
MAX_STATES = 300


class ValueCheck(NamedTuple):
    """The agreement of Q(s, ·) with the simulated values of the actions."""

    rank_correlation: float  # Spearman's, over the actions in a state; mean over the states
    error: float  # root mean square of Q(s, a) - the value of a in s
    spread: float  # standard deviation of the values over the actions; mean over the states

    def summary(self) -> dict[str, float]:
        """Returns the figures by their names in summary.json."""
        return {
            "q_rank_correlation": self.rank_correlation,
            "q_error": self.error,
            "q_spread": self.spread,
        }


def stored_states(data: Transitions, count: int, seed: int) -> Array:
    """Draws `count` distinct states in which stored transitions begin. [states, bodies, 3]

    Returns all such states if there are fewer.
    """
    states = np.unique(data.poses, axis=0)
    chosen = np.random.default_rng(seed).permutation(len(states))[:count]
    return states[np.sort(chosen)]


def _centred_ranks(values: Array) -> Array:
    """Returns twice the centred ranks within each row; ties share a rank. [N, M] -> [N, M]"""
    return np.sign(values[:, :, None] - values[:, None, :]).sum(axis=2)


def _spearman(a: Array, b: Array) -> Array:
    """Returns the rank correlation per row, 0 if all values are equal. [N, M] each -> [N]"""
    x, y = _centred_ranks(a), _centred_ranks(b)
    norm = np.sqrt((x * x).sum(axis=1) * (y * y).sum(axis=1))
    product = (x * y).sum(axis=1)
    return np.divide(product, norm, out=np.zeros_like(norm), where=norm > 0.0)


def check_values(
    config: _core.Config, values: Values, discount: float, states: Array
) -> ValueCheck | None:
    """Compares Q(s, ·), from `values`, with the simulated values of all actions.

    Leaves out states in which the simulator cannot finish a push, or in which all actions have
    equal values. Returns None if no state is left. states [N, bodies, 3]
    """
    task, simulator = config.task, make_simulator(config)
    actions = np.arange(task.actions)
    after, ok = simulator.push(
        np.repeat(states, len(actions), axis=0), np.tile(actions, len(states))
    )
    action_values = discount * values(task.observation(after)).max(axis=1)
    action_values = np.where(task.succeeded(after), 1.0, action_values).reshape(len(states), -1)
    known = ok.reshape(action_values.shape).all(axis=1) & (np.ptp(action_values, axis=1) > 0.0)
    if not known.any():
        return None
    q, action_values = values(task.observation(states[known])), action_values[known]
    return ValueCheck(
        rank_correlation=float(_spearman(q, action_values).mean()),
        error=float(np.sqrt(np.square(q - action_values).mean())),
        spread=float(action_values.std(axis=1).mean()),
    )
