"""Reckons a gradient step by hand: targets, loss, and how far it moves."""

import numpy as np
import pytest
import torch as th
from rtg.learn.replay import Batch
from test_ddqn import column, constant, model, play


@pytest.mark.parametrize("value_bounds", [False, True])
def test_targets_of_a_network_that_says_less_than_0_count_as_clipped(value_bounds: bool) -> None:
    random = {"epsilon_start": 1.0, "epsilon_end": 1.0, "nearby_share": 0.0}
    one = model(network="plain", value_bounds=value_bounds, **random)
    play(one, 400)
    with th.no_grad():
        for net in (one.online, one.target):
            net.head.weight.zero_()
            net.head.bias.fill_(-1.0)
    one.statistics.pop()
    data = one.replay.sample(256)
    one._gradient_step(data)
    shares, goes_on = one.statistics.pop(), data.terminated == 0
    assert shares["clipped_share"] == float(goes_on.float().mean()) > 0.5
    assert shares["bound_share"] == float((goes_on & (data.bounds > 0)).float().mean())
    assert (shares["bound_share"] > 0) == value_bounds


@pytest.mark.parametrize(
    ("changes", "online", "target", "value"),
    [
        ({"double_q": False}, (0.5, 0.2), (0.7, 0.9), 0.9),
        ({"double_q": False, "clipped_double_q": False}, (0.5, 0.2), (0.7, 0.9), 0.9),
        ({"clipped_double_q": False}, (0.5, 0.2), (0.7, 0.9), 0.7),
        ({}, (0.5, 0.2), (0.7, 0.9), 0.5),
        ({}, (-0.5, -0.6), (-0.3, -0.1), 0.0),
        ({"clip_targets": False}, (-0.5, -0.6), (-0.3, -0.1), -0.5),
    ],
)
def test_a_gradient_step_learns_what_the_settings_say_of_the_next_state(
    changes: dict[str, bool],
    online: tuple[float, ...],
    target: tuple[float, ...],
    value: float,
) -> None:
    one = model(network="plain", value_bounds=False, **changes)
    play(one, 400)
    constant(one.online, *online)
    constant(one.target, *target)
    one.statistics.pop()
    data = one.replay.sample(256)
    q = th.full((8,), -9.0)
    q[:2] = th.tensor(online)
    y = data.rewards + 0.9 * (1 - data.terminated) * value
    one._gradient_step(data)
    error = (q[data.actions] - y).square().mean().sqrt()
    assert one.statistics.pop()["td_error"] == pytest.approx(float(error), rel=1e-5)


@pytest.mark.parametrize("scale", [1.0, 1e4])
def test_a_gradient_is_cut_to_the_largest_norm(scale: float) -> None:
    one = model(network="plain")
    constant(one.online, 0.0)

    def norm() -> float:
        return float(th.cat([p.grad.ravel() for p in one.online.parameters()]).norm())

    q = one.online(th.ones(1, 3))[0, 0]
    (scale * q).backward()
    whole = norm()
    one._compute_gradient = lambda batch: one._backward(scale * one.online(th.ones(1, 3))[0, 0])
    one._gradient_step(batch=None)
    assert norm() == pytest.approx(min(whole, 10.0), rel=1e-4)
    assert (whole > 1e3) == (scale > 1.0) and whole > 0.9


@pytest.mark.parametrize("cql_weight", [0.0, 0.5])
@pytest.mark.parametrize("offline", [0, 2, 3])
def test_the_loss_of_a_gradient_step_by_hand(
    cql_weight: float, offline: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Values are held down of offline rows alone. Q is 0.5, 0.2 and six times 0; targets are what
    is given, as all rows are final; smooth L1 is half the square of an error up to 1, and
    goes straight from there on."""
    one = model(network="plain", value_bounds=False, clip_targets=False, cql_weight=cql_weight)
    told = []
    q = th.tensor([0.5, 0.2, *[0.0] * 6])
    constant(one.online, *q.tolist())
    monkeypatch.setattr(one, "_backward", told.append)
    actions, y = th.tensor([[0], [1], [2]]), column(1, 0, 4)
    seen = th.zeros(3, 3)
    one._compute_gradient(Batch(seen, actions, seen, y, column(1, 1, 1), column(0, 0, 0), offline))
    td = (0.5**2 / 2 + 0.2**2 / 2 + 4.0 - 0.5) / 3
    gaps = np.log(np.exp(0.5) + np.exp(0.2) + 6) - np.array([0.5, 0.2, 0.0])[:offline]
    held_down = cql_weight * gaps.mean() if offline else 0.0
    assert told[0].item() == pytest.approx(td + held_down, rel=1e-5)
