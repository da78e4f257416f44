"""The gradient step of the C++ core against that of PyTorch."""

from typing import Any

import numpy as np
import pytest
import torch as th
from rtg import _core
from rtg.learn.ddqn import DoubleDqn
from rtg.learn.replay import Batch
from test_ddqn import model, weights
from test_reference_dqn import random_batch

STEPS = 30
RULES = [
    {},
    {"clip_targets": False},
    {"clipped_double_q": False},
    {"double_q": False},
]


def learned(batches: list[Batch], core: bool, **changes: Any) -> DoubleDqn:
    one = model(learning_rate=1e-3, target_rate=0.1, **changes)
    assert one._core is not None
    if not core:
        one._core = None
    with th.no_grad():  # values that differ between headings, for either network
        for net in (one.online, one.target):
            net.advantage[-1].weight.mul_(100.0)
    steps = iter(batches)
    one.replay.sample = lambda size: next(steps)
    one.train(len(batches))
    return one


@pytest.mark.parametrize("rules", RULES)
def test_the_core_learns_what_pytorch_does(rules: dict[str, bool]) -> None:
    """To rounding, over 30 steps; some targets are raised by bounds.

    Adam divides by the size of the gradient: of small ones the rounding shows, which depends on the
    processor in PyTorch. On one processor a single one of 121,794 weights differs by 2.3e-5.
    """
    rng = np.random.default_rng(0)
    batches = [random_batch(rng, scale=1.0) for _ in range(STEPS)]
    for batch in batches:
        batch.bounds[::4] = 0.9
    ours, theirs = (learned(batches, core, **rules) for core in (True, False))
    for name in ("online", "target", "mean"):
        one, other = (weights(getattr(learner, name)) for learner in (ours, theirs))
        differences = (one - other).abs()
        assert (differences > 2e-5).sum() <= 3 and differences.max() < 4e-5
        assert differences.quantile(0.99) < 1e-6
    moved = (weights(ours.online) - weights(model(**rules).online)).abs()
    assert moved.max() > 5e-3
    our_figures, their_figures = ours.statistics.pop(), theirs.statistics.pop()
    assert our_figures.keys() == their_figures.keys()
    assert our_figures == pytest.approx(their_figures, rel=1e-4, abs=1e-6)
    assert our_figures["bound_share"] > 0.05


def test_pytorch_computes_what_the_core_does_not_know() -> None:
    for changes in ({"network": "plain"}, {"cql_weight": 0.1}):
        assert model(**changes)._core is None


WEIGHTS = 16 * 6 + 16 * 17 + 64 + 25 * 17 + 72 + 16 + 9


def step(count: int = 3, **changes: Any) -> None:
    row, states = np.zeros(count, np.float32), np.zeros((count, 5), np.float32)
    batch = {
        "states": states,
        "actions": np.zeros(count, np.int64),
        "next_states": states,
        "rewards": row,
        "terminated": row,
        "bounds": row,
    }
    names = ("online", "target", "mean", "first_moment", "second_moment")
    weights = {name: np.zeros(WEIGHTS, np.float32) for name in names}
    learner().step(
        _core.WeightArrays(**{name: changes.get(name, x) for name, x in weights.items()}),
        _core.TransitionArrays(**{name: changes.get(name, x) for name, x in batch.items()}),
        _core.StepRates(step=1, learning=1e-3, target=0.1, mean=0.1),
        threads=changes.get("threads", 1),
    )


def learner() -> _core.DoubleDqn:
    rules = {"double_q": True, "clipped_double_q": True, "clip_targets": True}
    return _core.DoubleDqn(5, 8, 16, 8, [1.0], discount=0.9, **rules)


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"online": np.zeros(3, np.float32)}, "3 weights; legal: "),
        ({"target": np.zeros(3, np.float32)}, "3 weights; legal: "),
        ({"mean": np.zeros(3, np.float32)}, "3 weights; legal: "),
        ({"first_moment": np.zeros(3, np.float32)}, "3 weights; legal: "),
        ({"second_moment": np.zeros(3, np.float32)}, "3 weights; legal: "),
        ({"states": np.zeros((3, 4), np.float32)}, "states of 4 numbers; legal: 5"),
        ({"next_states": np.zeros((3, 4), np.float32)}, "states of 4 numbers; legal: 5"),
        ({"next_states": np.zeros((2, 5), np.float32)}, "3 states and 2 next states; legal: as "),
        ({"actions": np.full(3, 8)}, "action 8; legal: 0 to 7"),
        ({"actions": np.full(3, -1)}, "action -1; legal: 0 to 7"),
        ({"actions": np.zeros(2, np.int64)}, "3 states but 2 actions; legal: one action per"),
        ({"rewards": np.zeros(2, np.float32)}, "2 numbers for 3 transitions; legal: one per"),
        ({"terminated": np.zeros(2, np.float32)}, "2 numbers for 3 transitions; legal: one per"),
        ({"bounds": np.zeros(4, np.float32)}, "4 numbers for 3 transitions; legal: one per"),
        ({"threads": 0}, "0 threads; legal: at least 1"),
    ],
)
def test_the_core_refuses_what_does_not_fit(changes: dict[str, Any], expected: str) -> None:
    with pytest.raises(ValueError, match=expected):
        step(**changes)


@pytest.mark.parametrize("name", ["online", "target", "mean", "first_moment", "second_moment"])
def test_weights_of_which_a_copy_would_change_are_refused(name: str) -> None:
    for other in (np.zeros(WEIGHTS), np.zeros(2 * WEIGHTS, np.float32)[::2]):
        with pytest.raises(TypeError):
            step(**{name: other})


def test_a_gradient_step_has_transitions() -> None:
    step(count=1)
    with pytest.raises(ValueError, match="0 states and 0 next states; legal: as many, at least 1"):
        step(count=0)
