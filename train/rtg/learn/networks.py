"""Value networks Q(s, ·) over the actions, pushes in each heading by each stride.

Both kinds have two methods. Called with observations [B, inputs], they return Q of all actions,
[B, actions]. `at` returns Q of one action per observation, [B, 1].
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import torch as th
from torch import nn

from rtg import _core

PLAIN_LAYERS = (512, 512, 128)  # Table 2
HIDDEN = 256  # units of each of the two layers of HeadingNetwork's trunk
FEATURES = 64  # size of each of u, v, w of HeadingNetwork


def _layers(*widths: int, layer_norm: bool) -> nn.Sequential:
    """Makes fully connected layers with ReLU. [B, widths[0]] -> [B, widths[-1]]"""
    layers: list[nn.Module] = []
    for a, b in pairwise(widths):
        layers += [nn.Linear(a, b), *([nn.LayerNorm(b)] if layer_norm else [])]
        layers.append(nn.ReLU(inplace=True))
    return nn.Sequential(*layers)


class PlainNetwork(nn.Module):
    """The network of Table 2: three hidden layers, then a linear layer with a row per heading."""

    def __init__(self, inputs: int, headings: int, strides: Sequence[float] = (1.0,)) -> None:
        super().__init__()
        self.layers = _layers(inputs, *PLAIN_LAYERS, layer_norm=False)
        self.head = nn.Linear(PLAIN_LAYERS[-1], headings * len(strides))

    def forward(self, x: th.Tensor) -> th.Tensor:
        q: th.Tensor = self.head(self.layers(x))
        return q

    def at(self, x: th.Tensor, actions: th.Tensor) -> th.Tensor:
        """x [B, inputs], actions [B, 1] int64 -> [B, 1]"""
        return self(x).gather(1, actions)


class Core(NamedTuple):
    """A HeadingNetwork in the C++ core."""

    network: _core.HeadingNetwork
    weights: npt.NDArray[np.float32]  # all of them, a view of flatten()'s tensor


class HeadingNetwork(nn.Module):
    """A value network whose actions share their weights. With the heading θ_a and the stride ℓ_a:

        Q(s, a) = V(s) + f(w(s) + ℓ_a cos θ_a u(s) + ℓ_a sin θ_a v(s)).

    A trunk computes V and the features u, v, w of the state. Each pair (u_i, v_i) is a vector in
    the plane, of which f sees the component along the push. So what f learns of one heading holds
    for all: a push that meets an object at some angle does the same from any direction.
    """

    basis: th.Tensor  # (1, ℓ_a cos θ_a, ℓ_a sin θ_a) of each action [actions, 3]
    core: Core | None = None  # computes values if all weights are in one tensor on the CPU

    def __init__(self, inputs: int, headings: int, strides: Sequence[float] = (1.0,)) -> None:
        super().__init__()
        self.sizes = inputs, headings, HIDDEN, FEATURES, list(strides)
        self.trunk = _layers(inputs, HIDDEN, HIDDEN, layer_norm=True)
        self.features = nn.Linear(HIDDEN, 3 * FEATURES)
        self.value = nn.Linear(HIDDEN, 1)
        self.advantage = nn.Sequential(
            nn.LayerNorm(FEATURES),
            nn.ReLU(inplace=True),
            nn.Linear(FEATURES, FEATURES),
            nn.ReLU(inplace=True),
            nn.Linear(FEATURES, 1),
        )
        with th.no_grad():  # |Q| starts below 0.02, while by default it is as large as Q* far away
            for last in (self.value, self.advantage[-1]):
                assert isinstance(last, nn.Linear)
                last.weight.mul_(0.01)
                last.bias.zero_()
        theta = th.arange(headings) * (2.0 * math.pi / headings)
        turns = th.stack((th.ones(headings), theta.cos(), theta.sin()), dim=1)
        basis = th.cat([turns * th.tensor((1.0, stride, stride)) for stride in strides])
        self.register_buffer("basis", basis, persistent=False)

    def forward(self, x: th.Tensor) -> th.Tensor:
        if self.core and not th.is_grad_enabled():
            return th.from_numpy(self.core.network.values(self.core.weights, x.numpy()))
        hidden = self.trunk(x)
        along = th.matmul(self.basis, self._features(hidden))  # [B, actions, FEATURES]
        q: th.Tensor = self.value(hidden) + self.advantage(along).squeeze(2)
        return q

    def at(self, x: th.Tensor, actions: th.Tensor) -> th.Tensor:
        """x [B, inputs], actions [B, 1] int64 -> [B, 1]"""
        hidden = self.trunk(x)
        basis = self.basis[actions[:, 0], :, None]  # [B, 3, 1]
        along = (basis * self._features(hidden)).sum(dim=1)
        q: th.Tensor = self.value(hidden) + self.advantage(along)
        return q

    def _features(self, hidden: th.Tensor) -> th.Tensor:
        """Returns w, u, v. [B, 3, FEATURES]"""
        wuv: th.Tensor = self.features(hidden)
        return wuv.view(-1, 3, FEATURES)


ValueNetwork = PlainNetwork | HeadingNetwork
KINDS: dict[str, type[ValueNetwork]] = {"plain": PlainNetwork, "headings": HeadingNetwork}


def make(kind: str, inputs: int, headings: int, strides: Sequence[float] = (1.0,)) -> ValueNetwork:
    """Makes the network that `train.network` names. `strides`: in units of the longest one."""
    return KINDS[kind](inputs, headings, strides)


def flatten(net: nn.Module) -> nn.Parameter:
    """Moves all weights of `net`, and their gradients, into one tensor, and returns it.

    The weights of `net` become views of it, so that one operation updates them all. On the CPU,
    the C++ core then computes the values of a HeadingNetwork where no gradient is asked for.
    """
    weights = list(net.parameters())
    flat = nn.Parameter(th.cat([w.detach().ravel() for w in weights]))
    flat.grad = th.zeros_like(flat)
    sizes = [w.numel() for w in weights]
    for w, data, grad in zip(weights, flat.data.split(sizes), flat.grad.split(sizes), strict=True):
        w.data, w.grad = data.view_as(w), grad.view_as(w)
    if isinstance(net, HeadingNetwork) and flat.device.type == "cpu":
        net.core = Core(_core.HeadingNetwork(*net.sizes), flat.detach().numpy())
    return flat
