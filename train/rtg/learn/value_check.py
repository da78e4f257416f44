"""How well Q ranks the headings of a state, by the simulator: what predicts whether data teach.

Every heading of some hundred stored states is simulated. It is worth 1 where it succeeds, else
γ max_b Q(s', b): what Q itself thinks of where it leads. A policy chooses among the headings by
Q(s, ·), so that should rank them alike.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.files.dataset import Transitions

Array = NDArray[Any]
Values = Callable[[Array], Array]  # [N, observation] -> [N, headings]

STATES = 300


class ValueCheck(NamedTuple):
    """Q(s, ·) against the values of the headings, one simulated push each."""

    rank_correlation: float  # Spearman's, over the headings of a state, mean over the states
    error: float  # root mean square of Q(s, a) - the value of a in s
    spread: float  # standard deviation of the values over the headings, mean over the states

    def summary(self) -> dict[str, float]:
        """Under the names of summary.json."""
        return {
            "q_rank_correlation": self.rank_correlation,
            "q_error": self.error,
            "q_spread": self.spread,
        }


def stored_states(data: Transitions, count: int, seed: int) -> Array:
    """`count` distinct states in which stored transitions begin, or all. [states, bodies, 3]"""
    states = np.unique(data.poses, axis=0)
    chosen = np.random.default_rng(seed).permutation(len(states))[:count]
    return states[np.sort(chosen)]


def _centred_ranks(values: Array) -> Array:
    """Ranks within each row but for their mean and a factor; equal values share one. [N, M]"""
    return np.sign(values[:, :, None] - values[:, None, :]).sum(axis=2)


def _spearman(a: Array, b: Array) -> Array:
    """Row by row; 0 where all values of a row are equal. [N, M] each -> [N]"""
    x, y = _centred_ranks(a), _centred_ranks(b)
    norm = np.sqrt((x * x).sum(axis=1) * (y * y).sum(axis=1))
    product = (x * y).sum(axis=1)
    return np.divide(product, norm, out=np.zeros_like(norm), where=norm > 0.0)


def check_values(
    config: _core.Config, values: Values, discount: float, states: Array
) -> ValueCheck | None:
    """states [N, bodies, 3]; None where the simulator gives up pushes of every state, or no state's
    headings differ in value."""
    task, simulator = config.task, _core.Simulator(config)
    headings = np.arange(task.headings)
    after, ok = simulator.push(
        np.repeat(states, len(headings), axis=0), np.tile(headings, len(states))
    )
    worth = discount * values(task.observation(after)).max(axis=1)
    worth = np.where(task.succeeded(after), 1.0, worth).reshape(len(states), -1)
    known = ok.reshape(worth.shape).all(axis=1) & (np.ptp(worth, axis=1) > 0.0)
    if not known.any():
        return None
    q, worth = values(task.observation(states[known])), worth[known]
    return ValueCheck(
        rank_correlation=float(_spearman(q, worth).mean()),
        error=float(np.sqrt(np.square(q - worth).mean())),
        spread=float(worth.std(axis=1).mean()),
    )
