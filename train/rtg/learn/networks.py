"""Value networks as Stable-Baselines3 policy classes."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from typing import Any

import torch as th
from gymnasium import spaces
from stable_baselines3.common.torch_layers import FlattenExtractor
from stable_baselines3.common.type_aliases import PyTorchObs
from stable_baselines3.dqn.policies import DQNPolicy, QNetwork
from torch import nn

LAYER_SIZES = (512, 512, 128)  # Table 2


@cache
def has_fast_bfloat16(device: str = "cpu") -> bool:
    """Returns whether the device, "cpu" or "cuda", multiplies bfloat16 matrices in hardware."""
    if device == "cuda":
        return bool(th.cuda.is_bf16_supported())
    return bool(getattr(th.cpu, "_is_avx512_bf16_supported", lambda: False)())


def precision(reduced: bool, device: str) -> str:
    """Returns "bfloat16" or "float32": the precision in which the inner layers are trained.

    `reduced`: bfloat16 is wanted. It is used if `device` has fast hardware for it.
    """
    return "bfloat16" if reduced and has_fast_bfloat16(device) else "float32"


class ValueNetwork(QNetwork):
    """The value network Q(s, ·) with three hidden layers.

    `dueling` adds the dueling head [Wang et al. 2016]:

        Q(s, a) = V(s) + A(s, a) - mean_b A(s, b).

    `layer_norm` adds LayerNorm after each hidden layer. `small_head` makes the initial Q small.
    `goal_size` is the number of inputs after the observation that describe the desired goal, see
    rtg.learn.hindsight.

    `reduced_precision` computes the two inner layers in bfloat16 during training, which is 2.4
    times faster. It has no effect without hardware support or when actions are chosen. Weights and
    sums stay in float32, and so do the first and the last layer. The inputs of the first layer are
    positions, which bfloat16 resolves only to 2 cm.
    """

    def __init__(
        self,
        *args: Any,
        dueling: bool = True,
        layer_norm: bool = True,
        small_head: bool = True,
        reduced_precision: bool = False,
        goal_size: int = 0,
        **kwargs: Any,
    ) -> None:
        super().__init__(*args, **kwargs)
        actions = int(self.action_space.n)
        widths = list(self.net_arch)
        self.dueling = dueling
        self.reduced_precision = reduced_precision
        self.first = _layer(self.features_dim + goal_size, widths[0], layer_norm)
        self.inner = nn.Sequential(*(_layer(a, b, layer_norm) for a, b in pairwise(widths)))
        self.head = nn.Linear(widths[-1], actions + 1 if dueling else actions)
        if small_head:  # |Q| starts below 0.01; by default it is as large as Q* far from the goal
            with th.no_grad():
                self.head.weight.mul_(0.01)
                self.head.bias.zero_()
        del self.q_net  # the plain network of the base class

    def forward(self, obs: PyTorchObs) -> th.Tensor:
        """Returns Q of all actions. [B, observation + goal_size] -> [B, actions]"""
        hidden = self.first(self.extract_features(obs, self.features_extractor))
        device = hidden.device.type
        reduced = precision(self.reduced_precision, device) == "bfloat16"
        with th.autocast(device, th.bfloat16, enabled=reduced and self.training):
            hidden = self.inner(hidden)
        out: th.Tensor = self.head(hidden.float())
        if not self.dueling:
            return out
        value, advantage = out[:, :1], out[:, 1:]
        return value + advantage - advantage.mean(dim=1, keepdim=True)


def _layer(inputs: int, outputs: int, layer_norm: bool) -> nn.Sequential:
    norm = [nn.LayerNorm(outputs)] if layer_norm else []
    return nn.Sequential(nn.Linear(inputs, outputs), *norm, nn.ReLU())


class ValuePolicy(DQNPolicy):
    """SB3's DQN policy with ValueNetwork; `network` holds the keyword arguments of ValueNetwork."""

    def __init__(
        self,
        observation_space: spaces.Space[Any],
        action_space: spaces.Discrete,
        lr_schedule: Any,
        network: dict[str, Any] | None = None,
        **kwargs: Any,
    ) -> None:
        self.network = network or {}
        kwargs.setdefault("net_arch", list(LAYER_SIZES))
        kwargs.setdefault("optimizer_kwargs", {"fused": True})
        kwargs.setdefault("features_extractor_class", FlattenExtractor)
        super().__init__(observation_space, action_space, lr_schedule, **kwargs)

    def make_q_net(self) -> QNetwork:
        arguments = self._update_features_extractor(self.net_args, features_extractor=None)
        return ValueNetwork(**arguments, **self.network).to(self.device)

    def _get_constructor_parameters(self) -> dict[str, Any]:
        return {**super()._get_constructor_parameters(), "network": self.network}
