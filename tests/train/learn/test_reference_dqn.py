"""Plain Q-learning against Stable-Baselines3's DQN: the same batches lead to the same weights."""

import gymnasium
import numpy as np
import pytest
import torch as th
from gymnasium import spaces
from rtg.learn.ddqn import MAX_GRADIENT_NORM
from rtg.learn.replay import Batch
from stable_baselines3 import DQN
from stable_baselines3.common.buffers import ReplayBufferSamples
from stable_baselines3.common.logger import Logger
from test_ddqn import model, weights

SYNC = 7  # gradient steps from copy to copy
PLAIN = dict(
    network="plain",
    double_q=False,
    clipped_double_q=False,
    value_bounds=False,
    clip_targets=False,
    averaging_rate=1.0,
    target_sync=SYNC,
    target_rate=1.0,
    learning_rate=1e-3,
)


class Nowhere(gymnasium.Env):
    """Has the spaces of the line and is not stepped."""

    observation_space = spaces.Box(-1e4, 1e4, (3,), np.float32)
    action_space = spaces.Discrete(8)


def reference() -> DQN:
    """Returns a DQN with the network, rates and discount of a learner with the settings PLAIN."""
    other = DQN(
        "MlpPolicy",
        Nowhere(),
        learning_rate=1e-3,
        buffer_size=1,
        gamma=0.9,
        tau=1.0,
        target_update_interval=SYNC,
        max_grad_norm=MAX_GRADIENT_NORM,
        policy_kwargs={"net_arch": [512, 512, 128]},
        device="cpu",
    )
    other.set_logger(Logger(None, []))
    return other


def random_batch(rng: np.random.Generator, scale: float) -> Batch:
    """Makes a batch with observations of the size `scale`; a fifth of its rows are final."""
    x, after = th.from_numpy(scale * rng.normal(size=(2, 32, 3)).astype(np.float32))
    return Batch(
        observations=x,
        actions=th.from_numpy(rng.integers(8, size=(32, 1))),
        next_observations=after,
        rewards=th.from_numpy(rng.normal(size=(32, 1)).astype(np.float32)),
        terminated=th.from_numpy((rng.random((32, 1)) < 0.2).astype(np.float32)),
        bounds=th.full((32, 1), -th.inf),
        offline=0,
    )


def copy_weights(source: th.nn.Module, to: th.nn.Module) -> None:
    with th.no_grad():
        for p, other in zip(to.parameters(), source.parameters(), strict=True):
            p.copy_(other)


def test_plain_q_learning_is_that_of_the_reference(monkeypatch: pytest.MonkeyPatch) -> None:
    """Over 30 steps with four copies of the network; some gradients are cut, and some are not."""
    one, other = model(**PLAIN), reference()
    copy_weights(one.online, other.q_net)
    copy_weights(one.online, other.q_net_target)
    start = weights(one.online).clone()
    batches: list[Batch] = []
    monkeypatch.setattr(one.replay, "sample", lambda size: batches[-1])
    monkeypatch.setattr(
        other.replay_buffer,
        "sample",
        lambda size, env=None: ReplayBufferSamples(
            *batches[-1][:3], dones=batches[-1].terminated, rewards=batches[-1].rewards
        ),
    )
    rng, cut, copies = np.random.default_rng(0), [], 0
    for step in range(1, 31):
        batches.append(random_batch(rng, scale=300.0 if step % 3 == 0 else 1.0))
        one.train(1)
        other.train(1, batch_size=32)
        other._on_step()  # copies the network at its steps
        norm = float(th.cat([p.grad.ravel() for p in one.online.parameters()]).norm())
        cut.append(norm > 0.999 * MAX_GRADIENT_NORM)
        copies += th.equal(weights(one.online), weights(one.target))
        for ours, theirs in ((one.online, other.q_net), (one.target, other.q_net_target)):
            th.testing.assert_close(weights(ours), weights(theirs), rtol=0, atol=1e-5)
    assert copies == 4 and 5 < sum(cut) < 25
    assert th.equal(weights(one.mean), weights(one.online))
    moved = (weights(one.online) - start).abs()
    assert moved.mean() > 3e-4 and moved.max() > 5e-3
