"""Each field of TrainConfig that is about the learner does what it says: measured with one value
of it and with another. test_run_settings.py has those of a run."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import torch as th
from rtg.learn import networks
from rtg.learn.ddqn import DoubleDqn
from test_ddqn import constant, model, play, weights

Measure = Callable[..., Any]


def played(**changes: Any) -> DoubleDqn:
    """A learner that has made 400 interactions, a tenth of them explored, and learned nothing."""
    one = model(**{"epsilon_start": 0.1, "epsilon_end": 0.1, **changes})
    for _ in range(100):
        one._interact()
    assert (one.interactions, one.gradient_steps) == (400, 0)
    return one


def first_step(**changes: Any) -> float:
    """Returns how far the first gradient step moves the weight that it moves most: Adam's first
    step is its rate in each weight that has a gradient."""
    one = played(**changes)
    before = weights(one.online)
    one.train(1)
    return float((weights(one.online) - before).abs().max())


def test_a_restored_learner_has_the_learning_rate_of_its_own_settings() -> None:
    before, after = played(learning_rate=1e-3), played(learning_rate=5e-3)
    before.train(1)
    after.restore(before.state())
    rates = [group["lr"] for group in after.optimizer.param_groups]
    assert rates == [5e-3]


def test_a_checkpoint_without_gradient_steps_of_pytorch_is_continued_by_the_core() -> None:
    before, after = played(cql_weight=0.1), played()
    assert before._core is None and after._core is not None
    after.restore(before.state())
    after.train(1)
    assert after.gradient_steps == 1


def rows_of_a_batch(**changes: Any) -> int:
    one, sizes = model(**changes), []
    sample = one.replay.sample
    one.replay.sample = lambda size: sizes.append(size) or sample(size)
    one.learn()
    return sizes[0]


def steps_of_40_interactions(**changes: Any) -> int:
    one = model(**changes)
    play(one, 40)
    return one.gradient_steps


def target_after(steps: int) -> Measure:
    """Measures how far along from its first weights to the learner's the target network is."""

    def measure(**changes: Any) -> float:
        one = played(network="plain", **changes)
        constant(one.online, 1.0)
        constant(one.target, 0.0)
        for group in one.optimizer.param_groups:
            group["lr"] = 0.0
        one.train(steps)
        return round(one.target.head.bias[0].item(), 4)

    return measure


def acting(**changes: Any) -> int:
    """The action in training where the learner's own network says 0 and the target network 1."""
    one = model(network="plain", epsilon_start=0.0, epsilon_end=0.0, **changes)
    constant(one.online, 1.0, 0.0)
    constant(one.target, 0.0, 1.0)
    return int(one.training_actions(np.zeros((1, 3), np.float32))[0])


def mean_weights_lag(**changes: Any) -> bool:
    one = model(**changes)
    play(one, 400)
    return not th.equal(weights(one.online), weights(one.mean))


def of_rules(name: str) -> Measure:
    return lambda **changes: getattr(model(**changes).replay.rules, name)


def next_value(**changes: Any) -> float:
    """Returns what the next state is taken to be worth, of which the learner says (0.5, 0.2) and
    the target network (0.7, 0.9): the mean target of steps without a reward, before discounting."""
    one = played(network="plain", value_bounds=False, **changes)
    constant(one.online, 0.5, 0.2)
    constant(one.target, 0.7, 0.9)
    batch = one.replay.sample(256)
    kept = batch.rewards[:, 0] == 0
    batch = batch._replace(**{f: getattr(batch, f)[kept] for f in batch._fields[:-1]})
    one.statistics.pop()
    y = []
    one.statistics.add = lambda batch, q, target, bootstrap: y.append(target)
    one._gradient_step(batch)
    return round(float(y[0].mean()) / one.discount, 4)


def least_target(**changes: Any) -> float:
    """Returns the least target, before discounting, where all values are said to be -1."""
    one = played(network="plain", value_bounds=False, **changes)
    constant(one.online, *[-1.0] * 8)
    constant(one.target, *[-1.0] * 8)
    y = []
    one.statistics.add = lambda batch, q, target, bootstrap: y.append(target)
    one._gradient_step(one.replay.sample(256))
    return round(float(y[0].min()) / one.discount, 4)


def kind(**changes: Any) -> type[th.nn.Module]:
    return type(model(**changes).online)


def pull_on_other_actions(**changes: Any) -> bool:
    """Tells whether a step that sees offline rows of action 1 lowers what is said of action 0."""
    one = model(network="plain", batch=4, **changes)
    x = np.zeros((4, 3), np.float32)
    ones = np.ones(4, np.float32)
    one.replay.offline.append(
        observation=x, next_observation=x, action=ones.astype(int), reward=ones, terminated=ones
    )
    before = one.online.head.bias[0].item()
    one.train(1)
    return one.online.head.bias[0].item() < before


def epsilon_at(interactions: int) -> Measure:
    return lambda **changes: round(model(**changes).exploration.epsilon(interactions), 4)


def headings(**changes: Any) -> set[int]:
    """Returns the headings taken where the greedy one is 0 and that towards an object 4, of 8."""
    always = {"epsilon_start": 1.0, "nearby_share": 1.0, "nearby_headings": 1, "contact_share": 0.0}
    one = model(**{"leave_loops": False, **always, **changes}).exploration
    one.contact = lambda seed: np.full(2000, 4)
    return set(one.actions(np.zeros(2000, int), np.zeros((2000, 3)), 1.0).tolist())


def leaves_loops(**changes: Any) -> bool:
    one = model(nearby_share=1.0, **changes).exploration
    seen = np.zeros((1, 3))
    return any(one.actions(np.array([0]), seen, 0.0) != 0 for _ in range(2))


OF_THE_LEARNER: dict[str, tuple[Any, Any, Measure, Any, Any]] = {
    # field: a value, another, what is measured, what it is with the one, with the other
    "batch": (16, 48, rows_of_a_batch, 16, 48),
    "learning_rate": (1e-3, 5e-3, first_step, pytest.approx(1e-3), pytest.approx(5e-3)),
    "train_frequency": (4, 8, steps_of_40_interactions, 10, 5),
    "gradient_steps": (1, 3, steps_of_40_interactions, 10, 30),
    "target_sync": (10, 4, target_after(4), 0.0, 1.0),
    "target_rate": (1.0, 0.25, target_after(10), 1.0, 0.25),
    "target_acts": (False, True, acting, 0, 1),
    "averaging_rate": (1.0, 0.01, mean_weights_lag, False, True),
    "offline_share": (0.5, 0.25, of_rules("offline_share"), 0.5, 0.25),
    "recent_share": (0.5, 0.25, of_rules("recent_share"), 0.5, 0.25),
    "value_bounds": (True, False, of_rules("use_bounds"), True, False),
    "buffer": (10_000, 8, lambda **changes: model(**changes).replay.capacity, 10_000, 8),
    "double_q": (True, False, next_value, 0.5, 0.9),
    "clipped_double_q": (True, False, next_value, 0.5, 0.7),
    "clip_targets": (True, False, least_target, 0.0, -1.0),
    "network": ("headings", "plain", kind, networks.HeadingNetwork, networks.PlainNetwork),
    "cql_weight": (0.0, 5.0, pull_on_other_actions, False, True),
    "epsilon_start": (0.3, 0.5, epsilon_at(0), 0.3, 0.5),
    "epsilon_end": (0.02, 0.05, epsilon_at(1000), 0.02, 0.05),
    "epsilon_share": (0.2, 0.1, epsilon_at(100), pytest.approx(0.16, abs=1e-3), 0.02),
    "nearby_share": (1.0, 0.0, headings, {1, 7}, set(range(8))),
    "nearby_headings": (1, 2, headings, {1, 7}, {1, 2, 6, 7}),
    "contact_share": (0.0, 1.0, headings, {1, 7}, {4}),
    "leave_loops": (False, True, leaves_loops, False, True),
}


@pytest.mark.parametrize("field", OF_THE_LEARNER)
def test_a_setting_of_the_learner(field: str) -> None:
    one, other, measure, expected, changed = OF_THE_LEARNER[field]
    assert measure(**{field: one}) == expected
    assert measure(**{field: other}) == changed
