"""Values and gradients of a HeadingNetwork by the C++ core (core/learn)."""

from __future__ import annotations

from typing import Any

import torch as th
from torch.autograd.function import once_differentiable

from rtg import _core


class HeadingCore:
    """Computes a HeadingNetwork on the CPU. Its weights are in one tensor, see networks.flatten().

    Only values of one heading per state have a gradient.
    """

    def __init__(self, network: _core.HeadingNetwork, weights: th.nn.Parameter) -> None:
        self.network, self.weights = network, weights

    def values(self, x: th.Tensor) -> th.Tensor:
        """Returns Q of all headings. [B, inputs] -> [B, headings]"""
        return th.from_numpy(self.network.values(self.weights.detach().numpy(), x.numpy()))

    def values_at(self, x: th.Tensor, headings: th.Tensor) -> th.Tensor:
        """Returns Q of one heading per state. x [B, inputs], headings [B, 1] int64 -> [B, 1]

        The gradient must be computed before the next call of either method, else `backward()`
        raises RuntimeError.
        """
        q: th.Tensor = _ValuesAt.apply(self.weights, self.network, x, headings[:, 0])
        return q[:, None]


class _ValuesAt(th.autograd.Function):
    """Q of one heading per state as an operation of PyTorch, with its gradient for the weights."""

    @staticmethod
    def forward(
        ctx: Any,
        weights: th.Tensor,
        network: _core.HeadingNetwork,
        x: th.Tensor,
        headings: th.Tensor,
    ) -> th.Tensor:
        ctx.save_for_backward(weights)  # PyTorch refuses a gradient if they have changed
        q = network.values_at(weights.detach().numpy(), x.numpy(), headings.numpy())
        ctx.network, ctx.call = network, network.last_call
        return th.from_numpy(q)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, of_q: th.Tensor) -> tuple[th.Tensor, None, None, None]:
        (weights,) = ctx.saved_tensors
        if ctx.network.last_call != ctx.call:
            raise RuntimeError("the network was called again before its gradient was computed")
        gradient = ctx.network.gradient(weights.detach().numpy(), of_q.contiguous().numpy())
        return th.from_numpy(gradient), None, None, None
