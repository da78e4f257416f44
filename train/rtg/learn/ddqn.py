"""Double DQN on offline and online transitions, from Stable-Baselines3's DQN."""

from __future__ import annotations

import copy
from collections import deque
from typing import Any

import numpy as np
import numpy.typing as npt
import torch as th
from stable_baselines3 import DQN
from stable_baselines3.common.logger import Logger
from stable_baselines3.common.utils import polyak_update
from stable_baselines3.common.vec_env import VecEnv
from torch.nn import functional

from rtg import _core
from rtg.learn import device
from rtg.learn.exploration import Exploration
from rtg.learn.hindsight import HindsightReplayBuffer, Layouts
from rtg.learn.networks import ValuePolicy
from rtg.learn.replay import Batch, MixedReplayBuffer, ReplayRules

Array = npt.NDArray[Any]

MAX_GRADIENT_NORM = 10.0
# In early training the averaged weights cover the last 1 / AVERAGING_WARM_UP of the gradient steps.
AVERAGING_WARM_UP = 5.0


def next_values(online: th.Tensor, target: th.Tensor, clipped_double_q: bool) -> th.Tensor:
    """Returns the values of the next states s'. [B, actions] each -> [B, 1]

    `online` and `target` are Q(s', ·) of the two networks. In Double Q-learning the online network
    chooses the action and the target network evaluates it [van Hasselt et al. 2016]. With
    `clipped_double_q`, the value is the smaller one of both networks [cf. Fujimoto et al. 2018].
    Then an error of one network alone cannot raise it. If both arguments are of the target network,
    this is plain Q-learning.
    """
    choice = online.argmax(dim=1, keepdim=True)
    value = target.gather(1, choice)
    return th.minimum(value, online.gather(1, choice)) if clipped_double_q else value


def bootstrap_targets(batch: Batch, next_value: th.Tensor, discount: float) -> th.Tensor:
    """Returns the one-step targets r + γ (1 - terminated) V, V = `next_value`. [B, 1]"""
    return batch.rewards + discount * (1.0 - batch.terminated) * next_value


def td_targets(bootstrap: th.Tensor, bounds: th.Tensor, clip: bool) -> th.Tensor:
    """Returns the TD targets max(`bootstrap`, `bounds`), clipped to [0, 1] if `clip`. [B, 1]"""
    y = th.maximum(bootstrap, bounds)
    return y.clamp(0.0, 1.0) if clip else y


def conservative_gap(q: th.Tensor, actions: th.Tensor) -> th.Tensor:
    """Returns the penalty of CQL(H), log Σ_b exp Q(s, b) - Q(s, a) [Kumar et al. 2020, eq. 4].

    Minimising it lowers Q(s, b) of the other actions b relative to Q(s, a).
    q [B, actions], actions [B, 1] -> [B, 1]
    """
    return q.logsumexp(dim=1, keepdim=True) - q.gather(1, actions)


def _rules(settings: _core.TrainConfig, discount: float, seed: int) -> ReplayRules:
    return ReplayRules(
        offline_share=settings.offline_share,
        recent_share=settings.recent_share,
        discount=discount,
        use_bounds=settings.value_bounds,
        seed=seed,
    )


class DoubleDqn(DQN):
    """Double DQN: the DQN of Stable-Baselines3 (SB3) with batches of MixedReplayBuffer.

    Departs from SB3 (names in backquotes are settings):
    - It uses Double Q-learning.
    - It counts target updates in gradient steps (`target_sync`).
    - Class Exploration decides on exploration. Its schedule depends on the total number of
      interactions, so learning in rounds and resuming do not change it.
    - The target network acts in training episodes (`target_acts`). The online network would vary
      from step to step, and a single wrong action breaks a long plan. The target network averages
      over few steps, so it is steadier, but its mistakes are still visited and corrected soon.
    - A third network is evaluated and saved. Its weights are averages over many steps [Polyak and
      Juditsky 1992].

    After gradient step t the averaged weights move by max(`averaging_rate`, 5 / (5 + t)) towards
    those of the online network. So they average about the last fifth of the steps, at most the last
    1 / `averaging_rate`. With `averaging_rate` 1 they equal the online weights.
    """

    replay_buffer: MixedReplayBuffer  # type: ignore[assignment]

    def __init__(
        self, env: VecEnv, settings: _core.TrainConfig, discount: float, seed: int
    ) -> None:
        self.settings = settings
        self.statistics = Statistics()
        buffer: dict[str, Any] = {"rules": _rules(settings, discount, seed)}
        self.layouts = Layouts(env.get_attr("task")[0]) if settings.hindsight else None
        if self.layouts:
            buffer.update(layouts=self.layouts, goals=settings.hindsight)
        super().__init__(
            ValuePolicy,
            env,
            learning_rate=settings.learning_rate,
            buffer_size=settings.buffer,
            learning_starts=0,  # of SB3, in interactions; Training decides when learning starts
            batch_size=settings.batch,
            gamma=discount,
            train_freq=max(1, settings.train_frequency // env.num_envs),
            gradient_steps=settings.gradient_steps,
            replay_buffer_class=HindsightReplayBuffer if self.layouts else MixedReplayBuffer,  # type: ignore[arg-type]
            replay_buffer_kwargs=buffer,
            policy_kwargs={
                "network": {
                    "dueling": settings.dueling,
                    "layer_norm": settings.layer_norm,
                    "small_head": settings.small_head,
                    "reduced_precision": settings.reduced_precision,
                    "goal_size": self.layouts.size if self.layouts else 0,
                }
            },
            seed=seed,
            device=device.chosen(settings.device),
        )
        self.mean_net = copy.deepcopy(self.q_net).requires_grad_(False)
        self.set_logger(Logger(folder=None, output_formats=[]))
        headings = int(self.action_space.n)  # type: ignore[attr-defined]
        contact = getattr(env, "contact_headings", None)  # None if the environment has none
        self.exploration = Exploration(settings, headings, seed, contact)
        self.update_exploration()

    def learn_offline(self) -> None:
        """Performs one round of learning: the gradient steps without the interactions.

        It counts the interactions all the same, so that schedules advance.
        """
        self.num_timesteps += self.settings.train_frequency
        self.train(self.settings.gradient_steps, self.settings.batch)

    def train(self, gradient_steps: int, batch_size: int = 100) -> None:
        self.policy.train(True)  # online and target network
        self._update_learning_rate(self.policy.optimizer)
        for _ in range(gradient_steps):
            self._gradient_step(self.replay_buffer.sample(batch_size))
            self._n_updates += 1
            if self._n_updates % self.settings.target_sync == 0:
                online, target = self.q_net.parameters(), self.q_net_target.parameters()
                polyak_update(online, target, self.settings.target_rate)
            self._average()

    def _average(self) -> None:
        early_rate = AVERAGING_WARM_UP / (AVERAGING_WARM_UP + self._n_updates)
        rate = max(self.settings.averaging_rate, early_rate)
        polyak_update(self.q_net.parameters(), self.mean_net.parameters(), rate)

    def _gradient_step(self, batch: Batch) -> None:
        with th.no_grad():
            target = self.q_net_target(batch.next_observations)
            online = self.q_net(batch.next_observations) if self.settings.double_q else target
            value = next_values(online, target, self.settings.clipped_double_q)
            bootstrap = bootstrap_targets(batch, value, self.gamma)
            y = td_targets(bootstrap, batch.bounds, self.settings.clip_targets)
        all_q = self.q_net(batch.observations)
        q = all_q.gather(1, batch.actions)
        loss = functional.smooth_l1_loss(q, y)
        if self.settings.cql_weight and batch.offline:
            gap = conservative_gap(all_q[: batch.offline], batch.actions[: batch.offline])
            loss = loss + self.settings.cql_weight * gap.mean()
        self._descend(loss)
        self.statistics.add(batch, q.detach(), y, bootstrap)

    def _descend(self, loss: th.Tensor) -> None:
        self.policy.optimizer.zero_grad()
        loss.backward()
        th.nn.utils.clip_grad_norm_(self.q_net.parameters(), MAX_GRADIENT_NORM)
        self.policy.optimizer.step()

    def _on_step(self) -> None:
        self.update_exploration()

    def update_exploration(self) -> None:
        self.exploration_rate = self.exploration.epsilon(self.num_timesteps)

    def predict(
        self,
        observation: Any,
        state: Any = None,
        episode_start: Any = None,
        deterministic: bool = False,
    ) -> tuple[Array, Any]:
        """Returns greedy() actions if `deterministic`, else actions for training episodes.

        SB3 calls it in training episodes. Returns `state` unchanged.
        """
        if deterministic:
            return self.greedy(observation), state
        net = self.q_net_target if self.settings.target_acts else self.q_net
        seen, buffer = observation, self.replay_buffer
        if isinstance(buffer, HindsightReplayBuffer):
            seen = buffer.layouts.network_input(observation, buffer.desired_layouts(observation))
        action = self._values_of(net, seen).argmax(axis=1)
        return self.exploration.actions(action, observation, self.exploration_rate), state

    def greedy(self, observation: Array) -> Array:
        """Returns the greedy actions of values(). [N, observation] float32 -> [N] int"""
        return self.values(observation).argmax(axis=1)

    def values(self, observation: Array) -> Array:
        """Returns Q of all actions by the network with averaged weights.

        [N, observation] float32 -> [N, actions] float32
        """
        seen = self.layouts.network_input_nearest(observation) if self.layouts else observation
        return self._values_of(self.mean_net, seen)

    def _values_of(self, net: th.nn.Module, observation: Array) -> Array:
        net.train(False)
        with th.no_grad():
            seen = th.from_numpy(np.ascontiguousarray(observation)).to(self.device)
            q: Array = net(seen).cpu().numpy()
        return q

    def state(self) -> dict[str, Any]:
        """Returns the state for a checkpoint, without replay buffer and environments."""
        return {
            "q_net": self.q_net.state_dict(),
            "q_net_target": self.q_net_target.state_dict(),
            "mean_net": self.mean_net.state_dict(),
            "optimizer": self.policy.optimizer.state_dict(),
            "exploration": self.exploration.state(),
            "statistics": self.statistics.state(),
            "interactions": self.num_timesteps,
            "gradient_steps": self._n_updates,
            "episodes": self._episode_num,
            "observation": self._last_obs,  # None before the first interaction
            "recent_success": list(self.ep_success_buffer or ()),
            "recent_episodes": list(self.ep_info_buffer or ()),
        }

    def restore(self, state: dict[str, Any]) -> None:
        self.q_net.load_state_dict(state["q_net"])
        self.q_net_target.load_state_dict(state["q_net_target"])
        self.mean_net.load_state_dict(state["mean_net"])
        self.policy.optimizer.load_state_dict(state["optimizer"])
        self.exploration.restore(state["exploration"])
        self.statistics.restore(state["statistics"])
        self.num_timesteps = state["interactions"]
        self._n_updates = state["gradient_steps"]
        self._episode_num = state["episodes"]
        if state["observation"] is not None:
            self._last_obs = np.asarray(state["observation"]).copy()
        self.ep_success_buffer = deque(state["recent_success"], maxlen=self._stats_window_size)
        self.ep_info_buffer = deque(state["recent_episodes"], maxlen=self._stats_window_size)
        self.update_exploration()

    def recent_episodes(self) -> dict[str, float]:
        """Returns success rate and mean length of the last 100 training episodes; {} if none."""
        if not self.ep_success_buffer or not self.ep_info_buffer:
            return {}
        return {
            "rollout_success": float(np.mean(self.ep_success_buffer)),
            "rollout_length_mean": float(np.mean([one["l"] for one in self.ep_info_buffer])),
        }

    @property
    def gradient_steps_done(self) -> int:
        return self._n_updates


class Statistics:
    """Collects means and maxima over the gradient steps since the last row of the log."""

    def __init__(self) -> None:
        self._sums: dict[str, float] = {}
        self._counts: dict[str, float] = {}
        self._peaks: dict[str, float] = {}

    def add(self, batch: Batch, q: th.Tensor, y: th.Tensor, bootstrap: th.Tensor) -> None:
        """Adds a gradient step on `batch`. [B, 1] each

        `q` = Q(s, a), `bootstrap` its bootstrap_targets(), and `y` its td_targets().
        """
        error, bounds = q - y, batch.bounds
        beyond = (bootstrap < 0.0) | (bootstrap > 1.0)
        raised = (bootstrap < bounds) & (bounds > 0.0)  # a bound of 0 says nothing: Q* ≥ 0
        self._accumulate("td_error", float(error.square().mean().sqrt()))
        self._accumulate("clipped_share", float(beyond.float().mean()))
        self._accumulate("bound_share", float(raised.float().mean()))
        for name, part in (("offline", q[: batch.offline]), ("online", q[batch.offline :])):
            if len(part):
                self._accumulate(f"q_{name}_mean", float(part.mean()))
                peak = f"q_{name}_max"
                self._peaks[peak] = max(self._peaks.get(peak, -np.inf), float(part.max()))

    def _accumulate(self, name: str, value: float) -> None:
        self._sums[name] = self._sums.get(name, 0.0) + value
        self._counts[name] = self._counts.get(name, 0.0) + 1.0

    def state(self) -> dict[str, dict[str, float]]:
        return {"sums": self._sums, "counts": self._counts, "peaks": self._peaks}

    def restore(self, state: dict[str, dict[str, float]]) -> None:
        self._sums, self._counts = dict(state["sums"]), dict(state["counts"])
        self._peaks = dict(state["peaks"])

    def pop(self) -> dict[str, float]:
        """Returns the means and maxima so far and resets them."""
        means = {name: total / self._counts[name] for name, total in self._sums.items()}
        means.update(self._peaks)
        self.__init__()  # type: ignore[misc]
        return means
