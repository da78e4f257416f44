"""The value networks: their form, where they begin, their symmetry, and one tensor of weights."""

import copy
import math

import pytest
import torch as th
from rtg.learn import networks
from rtg.learn.networks import FEATURES, HeadingNetwork

KINDS = list(networks.KINDS)


def net_of(kind: str, inputs: int = 3, headings: int = 8) -> th.nn.Module:
    th.manual_seed(0)
    return networks.make(kind, inputs, headings)


def telling(inputs: int = 3, headings: int = 8) -> HeadingNetwork:
    """A network whose values differ much between headings: by about 1."""
    net = net_of("headings", inputs, headings)
    with th.no_grad():
        net.advantage[-1].weight.mul_(1000.0)
    return net


def seen(count: int, inputs: int = 3) -> th.Tensor:
    return th.randn(count, inputs, generator=th.Generator().manual_seed(1))


@pytest.mark.parametrize("kind", KINDS)
def test_the_value_of_a_heading_is_that_among_all(kind: str) -> None:
    net, x = telling() if kind == "headings" else net_of(kind), seen(64)
    headings = (th.arange(64) % 8)[:, None]
    with th.no_grad():
        q, one = net(x), net.at(x, headings)
    assert q.shape == (64, 8) and one.shape == (64, 1) and q.std(dim=1).min() > 1e-3
    th.testing.assert_close(one, q.gather(1, headings), rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("kind", KINDS)
def test_the_gradient_of_a_heading_s_value_is_that_of_it_among_all(kind: str) -> None:
    net, x = telling() if kind == "headings" else net_of(kind), seen(64)
    headings = (th.arange(64) % 8)[:, None]
    found = []
    for q in (net.at(x, headings), net(x).gather(1, headings)):
        found.append(th.autograd.grad(q.square().sum(), list(net.parameters())))
    for one, other in zip(*found, strict=True):
        largest = other.abs().max()
        assert largest > 0
        th.testing.assert_close(one, other, rtol=1e-4, atol=1e-4 * float(largest))


@pytest.mark.parametrize("headings", [8, 48])
@pytest.mark.parametrize("turn", [1, 5])
def test_values_turn_with_the_vectors_of_the_state(headings: int, turn: int) -> None:
    """The layer makes w, u, v, in this order; each (u, v) is turned by so many headings."""
    net = telling(headings=headings)
    turned = copy.deepcopy(net)
    c, s = (f(2.0 * math.pi * turn / headings) for f in (math.cos, math.sin))
    with th.no_grad():
        for of_net in (turned.features.weight, turned.features.bias):
            u, v = of_net[FEATURES : 2 * FEATURES].clone(), of_net[2 * FEATURES :].clone()
            of_net[FEATURES : 2 * FEATURES] = c * u - s * v
            of_net[2 * FEATURES :] = s * u + c * v
        x = seen(50)
        q, after = net(x), turned(x)
    th.testing.assert_close(after, q.roll(turn, dims=1), rtol=1e-4, atol=1e-4)
    assert (after - q).abs().max() > 0.1


def test_heading_a_points_at_so_many_of_all_headings_from_the_x_axis() -> None:
    """Alone of u, heading 0 sees all, a quarter on nothing; v is a quarter further."""
    along = net_of("headings").basis
    w, u, v = along.T
    th.testing.assert_close(w, th.ones(8))
    th.testing.assert_close(u[[0, 2, 4, 6]], th.tensor([1.0, 0.0, -1.0, 0.0]))
    th.testing.assert_close(v[[0, 2, 4, 6]], th.tensor([0.0, 1.0, 0.0, -1.0]))
    th.testing.assert_close(u[1], v[1])


def test_the_headings_of_each_stride_are_those_of_the_longest_made_shorter() -> None:
    net = networks.make("headings", 3, 8, [0.25, 1.0])
    short, long = net.basis[:8], net.basis[8:]
    th.testing.assert_close(short[:, 1:], 0.25 * long[:, 1:])
    th.testing.assert_close(long, net_of("headings").basis)
    for kind in networks.KINDS:
        assert networks.make(kind, 3, 8, [0.25, 1.0])(seen(5)).shape == (5, 16)


@pytest.mark.parametrize("inputs", [3, 20, 44])
def test_a_network_of_headings_starts_near_zero(inputs: int) -> None:
    for seed in range(5):
        th.manual_seed(seed)
        with th.no_grad():
            q = networks.make("headings", inputs, 48)(seen(200, inputs))
        assert q.abs().max() < 0.02
        assert q.std(dim=0).min() > 0 and q.std(dim=1).min() > 0, "of states and of headings"


def test_plain_network_has_the_layers_of_table_2() -> None:
    net = net_of("plain", inputs=20, headings=48)
    shapes = [tuple(p.shape) for name, p in net.named_parameters() if name.endswith("weight")]
    assert shapes == [(512, 20), (512, 512), (128, 512), (48, 128)]
    x, by_hand = seen(10, 20), seen(10, 20)
    *hidden, (weight, bias) = zip(*[iter(net.parameters())] * 2, strict=True)
    for a, b in hidden:
        by_hand = (by_hand @ a.T + b).clamp(min=0.0)
    th.testing.assert_close(net(x), by_hand @ weight.T + bias, rtol=1e-4, atol=1e-6)


@pytest.mark.parametrize("kind", KINDS)
def test_flattened_weights_are_views_of_one_tensor(kind: str) -> None:
    net, x = net_of(kind), seen(10)
    before, q = {k: v.clone() for k, v in net.state_dict().items()}, net(x).detach()
    flat = networks.flatten(net)
    parts = list(net.parameters())
    assert flat.shape == (sum(p.numel() for p in parts),)
    th.testing.assert_close(net.state_dict(), before, rtol=0, atol=0)
    assert th.equal(net(x), q)

    with th.no_grad():
        flat.mul_(2.0)
    th.testing.assert_close(net.state_dict(), {k: 2 * v for k, v in before.items()})

    net.load_state_dict(before)
    assert th.equal(flat, th.cat([p.ravel() for p in before.values()]))
    assert th.equal(net(x), q)


@pytest.mark.parametrize("kind", KINDS)
def test_gradients_of_flattened_weights_are_in_one_tensor(kind: str) -> None:
    net, other, x = net_of(kind), net_of(kind), seen(10)
    flat = networks.flatten(net)
    for times in (1, 2):  # they add up
        net(x).square().sum().backward()
        other(x).square().sum().backward()
        wanted = th.cat([p.grad.ravel() for p in other.parameters()])
        th.testing.assert_close(flat.grad, wanted, rtol=1e-5, atol=1e-7)
        assert float(wanted.abs().max()) > 0, times
    optimizer = th.optim.SGD([flat], lr=0.5)
    optimizer.step()
    optimizer.zero_grad(set_to_none=False)
    for p, was in zip(net.parameters(), other.parameters(), strict=True):
        th.testing.assert_close(p, was - 0.5 * was.grad, rtol=1e-5, atol=1e-6)
        assert not p.grad.any()


def unlike_its_start(inputs: int = 5) -> HeadingNetwork:
    """A network all of whose weights matter."""
    net = net_of("headings", inputs)
    with th.no_grad():
        for weight in net.parameters():
            weight.add_(0.1 * th.randn_like(weight))
    return net


@pytest.mark.parametrize("count", [1, 4, 50])
def test_the_core_computes_the_values_that_pytorch_does(count: int) -> None:
    theirs = unlike_its_start()
    ours = copy.deepcopy(theirs)
    networks.flatten(ours)
    assert ours.core and theirs.core is None
    x = seen(count, 5)
    with th.no_grad():
        assert theirs(x).std() > 0.1
        th.testing.assert_close(ours(x), theirs(x), rtol=1e-5, atol=1e-5)


def test_the_core_refuses_what_does_not_fit() -> None:
    net = unlike_its_start()
    networks.flatten(net)
    assert net.core
    network, weights = net.core
    size = len(weights)
    for states, of, expected in (
        (seen(3, 4), weights, "states of 4 numbers; legal: 5"),
        (seen(3, 5), weights[1:], f"{size - 1} weights; legal: {size}"),
    ):
        with pytest.raises(ValueError, match=expected):
            network.values(of, states.numpy())
