"""Double DQN on offline and online transitions."""

from __future__ import annotations

import copy
from collections import deque
from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
import torch as th
from torch.nn import functional

from rtg import _core
from rtg.envs.layouts import Layouts
from rtg.envs.training_environments import Step
from rtg.learn import device, networks
from rtg.learn.exploration import Exploration, revisit_tolerance
from rtg.learn.hindsight import HindsightReplayBuffer
from rtg.learn.replay import Batch, MixedReplayBuffer, ReplayRules, unchanged
from rtg.learn.stages import Stages
from rtg.learn.symmetry import Symmetry

Array = npt.NDArray[Any]

MAX_GRADIENT_NORM = _core.MAX_GRADIENT_NORM
RECENT_EPISODES = 100  # number of training episodes of which the log tells success and length
# In early training the averaged weights cover the last 1 / AVERAGING_WARM_UP of the gradient steps.
AVERAGING_WARM_UP = 5.0


class Environments(Protocol):
    """The interface of the learner's environments; see TrainingEnvironments."""

    count: int
    observation_size: int
    headings: int
    strides: Sequence[float]  # lengths of a push, the longest one being 1
    task: _core.Task

    def reset(self) -> npt.NDArray[np.float32]: ...
    def step(self, actions: Array) -> Step: ...
    def contact_headings(self, seed: int, /) -> Array: ...


def bootstrap_targets(batch: Batch, next_value: th.Tensor, discount: float) -> th.Tensor:
    """Returns the one-step targets r + γ (1 - terminated) V, V = `next_value`. [B, 1]"""
    return batch.rewards + discount * (1.0 - batch.terminated) * next_value


def td_targets(bootstrap: th.Tensor, bounds: th.Tensor, clip: bool) -> th.Tensor:
    """Returns the TD targets max(`bootstrap`, `bounds`), clipped to [0, 1] if `clip`. [B, 1]"""
    y = th.maximum(bootstrap, bounds)
    return y.clamp(0.0, 1.0) if clip else y


def core_batch(batch: Batch) -> _core.TransitionArrays:
    """Returns `batch` as the C++ core takes it."""
    return _core.TransitionArrays(
        batch.observations.numpy(),
        batch.actions[:, 0].numpy(),
        batch.next_observations.numpy(),
        batch.rewards[:, 0].numpy(),
        batch.terminated[:, 0].numpy(),
        batch.bounds[:, 0].numpy(),
    )


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


class DoubleDqn:
    """Double DQN with batches of MixedReplayBuffer. Names in backquotes are settings.

    Three networks share one form:
    - The online network learns.
    - The target network follows it every `target_sync` gradient steps. It evaluates the next
      actions and, with `target_acts`, acts in training episodes. The online network would vary
      from step to step, and a single wrong action breaks a long plan. The target network averages
      over few steps, so it is steadier, but its mistakes are still visited and corrected soon.
    - The mean network is evaluated and saved. Its weights are averages over many steps [Polyak and
      Juditsky 1992].

    After gradient step t the averaged weights move by max(`averaging_rate`, 5 / (5 + t)) towards
    those of the online network. So they average about the last fifth of the steps, at most the last
    1 / `averaging_rate`. With `averaging_rate` 1 they equal the online weights.
    """

    def __init__(
        self, env: Environments, settings: _core.TrainConfig, discount: float, seed: int
    ) -> None:
        self.env, self.settings, self.discount = env, settings, discount
        self.device = device.chosen(settings.device)
        self.layouts = Layouts(env.task) if settings.hindsight else None
        self.symmetry = Symmetry(env.task, self.layouts) if settings.symmetry else unchanged
        self.replay = self._make_replay(seed)
        inputs = env.observation_size + (self.layouts.size if self.layouts else 0)
        th.manual_seed(seed)
        self.online = networks.make(settings.network, inputs, env.headings, env.strides).to(
            self.device
        )
        self.target, self.mean = copy.deepcopy(self.online), copy.deepcopy(self.online)
        self._online_weights = networks.flatten(self.online)
        self._target_weights = networks.flatten(self.target).detach()
        self._mean_weights = networks.flatten(self.mean).detach()
        self.optimizer = th.optim.Adam(
            [self._online_weights], lr=settings.learning_rate, fused=True
        )
        self._begin_optimizer()
        self._core = self._make_core()
        self.exploration = Exploration(
            settings,
            env.headings,
            seed,
            env.contact_headings,
            len(env.strides),
            revisit_tolerance(env.task),
        )
        self.statistics = Statistics()
        self.stages = Stages()
        self.threads = 1  # of the core's gradients
        self.interactions = self.gradient_steps = 0
        # Success and length of the latest training episodes.
        self.episodes: deque[tuple[bool, int]] = deque(maxlen=RECENT_EPISODES)
        self._observation: Array | None = None  # None before the first interaction

    def _make_replay(self, seed: int) -> MixedReplayBuffer:
        s, env = self.settings, self.env
        rules = _rules(s, self.discount, seed)
        shape = (s.buffer, env.observation_size, env.count, rules, self.device, self.symmetry)
        if self.layouts:
            return HindsightReplayBuffer(*shape, layouts=self.layouts, goals=s.hindsight)
        return MixedReplayBuffer(*shape)

    def _make_core(self) -> _core.DoubleDqn | None:
        """Returns what computes loss and gradient in C++; None if PyTorch must do so."""
        s, net = self.settings, self.online
        plain = s.learner == "q_learning" and s.cql_weight == 0.0
        if not plain or not isinstance(net, networks.HeadingNetwork) or not net.core:
            return None
        return _core.DoubleDqn(
            *net.sizes,
            discount=self.discount,
            double_q=s.double_q,
            clipped_double_q=s.clipped_double_q,
            clip_targets=s.clip_targets,
        )

    def _begin_optimizer(self) -> None:
        """Makes the optimiser's state, as PyTorch would do at its first step.

        A checkpoint from before that step has it, too.
        """
        zeros = th.zeros_like(self._online_weights).detach()
        step = th.zeros((), device=self.device)
        state = {"step": step, "exp_avg": zeros, "exp_avg_sq": zeros.clone()}
        self.optimizer.state[self._online_weights] = state

    def share_process(self) -> None:
        """Prepares for other learners that learn beside this one, on threads of the process."""
        self.threads = 1
        self.stages.share_process()

    def learn(self) -> None:
        """Performs one round of learning: `train_frequency` interactions, then gradient steps."""
        for _ in range(self.settings.train_frequency // self.env.count):
            self._interact()
        self.train(self.settings.gradient_steps)

    def learn_offline(self) -> None:
        """Performs one round of learning without the interactions.

        It counts the interactions all the same, so that schedules advance.
        """
        self.interactions += self.settings.train_frequency
        self.train(self.settings.gradient_steps)

    def _interact(self) -> None:
        """Performs one action in each environment and stores the transitions."""
        observation = self.env.reset() if self._observation is None else self._observation
        with self.stages["acting"]:
            action = self.training_actions(observation)
        with self.stages["environment"]:
            step = self.env.step(action)
        with self.stages["replay"]:
            self.replay.add(observation, action, step)
        self.episodes.extend(step.episodes)
        self.interactions += self.env.count
        self._observation = step.observation

    def train(self, gradient_steps: int) -> None:
        """Performs gradient steps, each on a new batch."""
        for _ in range(gradient_steps):
            with self.stages["replay"]:
                batch = self.replay.sample(self.settings.batch)
            with self.stages["gradient_steps"]:
                self.gradient_steps += 1
                self._gradient_step(batch)

    def _following_rates(self) -> tuple[float, float]:
        """Returns how far the target and the mean network move towards the online network now."""
        s = self.settings
        target_rate = s.target_rate if self.gradient_steps % s.target_sync == 0 else 0.0
        early_rate = AVERAGING_WARM_UP / (AVERAGING_WARM_UP + self.gradient_steps)
        return target_rate, max(s.averaging_rate, early_rate)

    def _gradient_step(self, batch: Batch) -> None:
        """Performs a gradient step and moves the other networks."""
        if self._core:
            self._core_step(self._core, batch)
            return
        self._compute_gradient(batch)
        th.nn.utils.clip_grad_norm_([self._online_weights], MAX_GRADIENT_NORM)
        self.optimizer.step()
        target_rate, mean_rate = self._following_rates()
        if target_rate:
            self._target_weights.lerp_(self._online_weights.data, target_rate)
        self._mean_weights.lerp_(self._online_weights.data, mean_rate)

    def _core_step(self, core: _core.DoubleDqn, batch: Batch) -> None:
        state = self.optimizer.state[self._online_weights]
        state["step"] += 1
        target_rate, mean_rate = self._following_rates()
        rates = _core.StepRates(
            step=int(state["step"]),
            learning=self.settings.learning_rate,
            target=target_rate,
            mean=mean_rate,
        )
        figures = core.step(self._core_weights(), core_batch(batch), rates, threads=self.threads)
        self.statistics.add(batch, *figures)

    def _core_weights(self) -> _core.WeightArrays:
        state = self.optimizer.state[self._online_weights]
        weights = self._online_weights.detach(), self._target_weights, self._mean_weights
        moments = state["exp_avg"], state["exp_avg_sq"]
        return _core.WeightArrays(*(each.numpy() for each in (*weights, *moments)))

    def _compute_gradient(self, batch: Batch) -> None:
        """Writes the gradient of the loss to the online weights."""
        figures = self._torch_gradient(batch)
        self.statistics.add(batch, *(each[:, 0].cpu().numpy() for each in figures))

    def _torch_gradient(self, batch: Batch) -> tuple[th.Tensor, th.Tensor, th.Tensor]:
        """Computes the gradient of the loss. Returns Q(s, a), td_targets(), bootstrap_targets()."""
        with th.no_grad():
            bootstrap = bootstrap_targets(batch, self._next_values(batch), self.discount)
            y = td_targets(bootstrap, batch.bounds, self.settings.clip_targets)
        q = self.online.at(batch.observations, batch.actions)
        loss = functional.smooth_l1_loss(q, y)
        if self.settings.cql_weight and batch.offline:
            offline = slice(0, batch.offline)
            all_q = self.online(batch.observations[offline])
            gap = conservative_gap(all_q, batch.actions[offline])
            loss = loss + self.settings.cql_weight * gap.mean()
        self._backward(loss)
        return q.detach(), y, bootstrap

    def _next_values(self, batch: Batch) -> th.Tensor:
        """Returns the values of the next states s'. [B, 1]

        In Double Q-learning the online network chooses the action and the target network evaluates
        it [van Hasselt et al. 2016]; in Q-learning the target network does both. With
        `clipped_double_q`, the value is the smaller one of both networks [cf. Fujimoto et al.
        2018]. Then an error of one network alone cannot raise it.
        """
        after = batch.next_observations
        if not self.settings.double_q:
            return self.target(after).amax(dim=1, keepdim=True)
        online = self.online(after)
        choice = online.argmax(dim=1, keepdim=True)
        value = self.target.at(after, choice)
        clipped = self.settings.clipped_double_q
        return th.minimum(value, online.gather(1, choice)) if clipped else value

    def _backward(self, loss: th.Tensor) -> None:
        assert self._online_weights.grad is not None
        self._online_weights.grad.zero_()  # in place, as the networks' gradients are views of it
        loss.backward()

    @property
    def exploration_rate(self) -> float:
        return self.exploration.epsilon(self.interactions)

    def training_actions(self, observation: Array) -> Array:
        """Returns the actions of training episodes, some of them exploring ones.

        [environments, observation] float32 -> [environments] int
        """
        net = self.target if self.settings.target_acts else self.online
        seen = observation
        if isinstance(self.replay, HindsightReplayBuffer):
            layouts = self.replay.desired_layouts(observation)
            seen = self.replay.layouts.network_input(observation, layouts)
        greedy = self._values_of(net, seen).argmax(axis=1)
        return self.exploration.actions(greedy, observation, self.exploration_rate)

    def values(self, observation: Array) -> Array:
        """Returns Q of all actions by the mean network. Its greedy policy is evaluated.

        [N, observation] float32 -> [N, actions] float32
        """
        seen = self.layouts.network_input_nearest(observation) if self.layouts else observation
        return self._values_of(self.mean, seen)

    def _values_of(self, net: th.nn.Module, seen: Array) -> Array:
        with th.no_grad():
            given = np.ascontiguousarray(self.symmetry(seen))
            q: Array = net(th.from_numpy(given).to(self.device)).cpu().numpy()
        return q

    def state(self) -> dict[str, Any]:
        """Returns the state for a checkpoint, without replay buffer and environments."""
        return {
            "online": self.online.state_dict(),
            "target": self.target.state_dict(),
            "mean": self.mean.state_dict(),
            "optimizer": self.optimizer.state_dict(),
            "exploration": self.exploration.state(),
            "statistics": self.statistics.state(),
            "stages": self.stages.seconds(),
            "interactions": self.interactions,
            "gradient_steps": self.gradient_steps,
            "observation": self._observation,
            "episodes": list(self.episodes),
        }

    def restore(self, state: dict[str, Any]) -> None:
        self.online.load_state_dict(state["online"])
        self.target.load_state_dict(state["target"])
        self.mean.load_state_dict(state["mean"])
        self.optimizer.load_state_dict(state["optimizer"])
        for group in self.optimizer.param_groups:  # which hold the rate of the checkpoint
            group["lr"] = self.settings.learning_rate
        self.exploration.restore(state["exploration"])
        self.statistics.restore(state["statistics"])
        self.stages.restore(state["stages"])
        self.interactions, self.gradient_steps = state["interactions"], state["gradient_steps"]
        seen = state["observation"]
        self._observation = None if seen is None else np.asarray(seen).copy()
        self.episodes = deque(state["episodes"], RECENT_EPISODES)

    def recent_episodes(self) -> dict[str, float]:
        """Returns success rate and mean length of the latest training episodes; {} if none."""
        if not self.episodes:
            return {}
        success, length = zip(*self.episodes, strict=True)
        return {
            "rollout_success": float(np.mean(success)),
            "rollout_length_mean": float(np.mean(length)),
        }


class Statistics:
    """Collects means and maxima over the gradient steps since the last row of the log."""

    def __init__(self) -> None:
        self._sums: dict[str, float] = {}
        self._counts: dict[str, float] = {}
        self._peaks: dict[str, float] = {}

    def add(self, batch: Batch, q: Array, y: Array, bootstrap: Array) -> None:
        """Adds a gradient step on `batch`. [B] float32 each

        `q` = Q(s, a), `bootstrap` its bootstrap_targets(), and `y` its td_targets().
        """
        bounds = batch.bounds[:, 0].cpu().numpy()
        error = q - y
        beyond = (bootstrap < 0.0) | (bootstrap > 1.0)
        raised = (bootstrap < bounds) & (bounds > 0.0)  # a bound of 0 says nothing: Q* ≥ 0
        self._accumulate("td_error", float(np.sqrt(error @ error / len(error))))
        self._accumulate("clipped_share", np.count_nonzero(beyond) / len(error))
        self._accumulate("bound_share", np.count_nonzero(raised) / len(error))
        parts = ("offline", q[: batch.offline]), ("online", q[batch.offline :])
        for name, part in parts:
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
