"""A replay buffer with two stores, for offline and for online transitions.

Offline transitions are never evicted. Online transitions form a ring buffer.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import torch as th

from rtg.envs.training_environments import Step
from rtg.files.dataset import Transitions
from rtg.learn.value_bounds import value_bounds

Array = npt.NDArray[Any]
Part = tuple["Store", Array]  # a store and indices of some of its rows
Field = tuple[str, npt.DTypeLike, tuple[int, ...]]  # name, type and shape

RECENT_COUNT = 10_000  # number of latest online transitions that count as recent


def unchanged(seen: Array) -> Array:
    return seen


class Batch(NamedTuple):
    """The sample of one gradient step; the first `offline` rows are offline transitions."""

    observations: th.Tensor  # [B, observation] float32
    actions: th.Tensor  # [B, 1] int64
    next_observations: th.Tensor  # [B, observation] float32
    rewards: th.Tensor  # [B, 1] float32
    terminated: th.Tensor  # [B, 1] float32, 1: no bootstrap from s'; 0 after a time-out
    bounds: th.Tensor  # [B, 1] float32, lower bounds of Q*(s, a) as in value_bounds.py, or -inf
    offline: int


class Store:
    """Stores transitions, a record each. Grows to `capacity` rows, then overwrites the oldest row.

    Transition number k, counted from 0 in order of writing, is in row k modulo `capacity`.
    """

    def __init__(self, capacity: int, observation_size: int, *more: Field) -> None:
        """`more`: further fields of a record."""
        self.capacity = capacity
        self.written = 0  # transitions so far, including overwritten ones
        fields: list[Field] = [
            ("observation", np.float32, (observation_size,)),
            ("next_observation", np.float32, (observation_size,)),
            ("action", np.int64, ()),
            ("reward", np.float32, ()),
            ("terminated", np.float32, ()),
            ("bound", np.float32, ()),
            *more,
        ]
        # A sample takes whole records: their fields lie side by side in the memory.
        self.rows: Array = np.zeros(0, np.dtype(fields, align=True))

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the fields of a record."""
        return self.rows.dtype.names or ()

    @property
    def count(self) -> int:
        """Number of filled rows."""
        return min(self.written, self.capacity)

    def append(self, **columns: Array) -> Array:
        """Adds transitions and returns their numbers, [added] int64. Missing columns become 0.

        Raises ValueError for more than `capacity` transitions.
        """
        added = len(columns["action"])
        if added > self.capacity:
            raise ValueError(f"{added} transitions do not fit into a buffer of {self.capacity}")
        self._reserve(min(self.written + added, self.capacity))
        numbers = self.written + np.arange(added)
        for name in self.columns:
            self.rows[name][numbers % self.capacity] = columns.get(name, 0.0)
        self.written += added
        return numbers

    def set_bounds(self, numbers: Array, bounds: Array) -> None:
        """Sets the value bounds of transitions by their numbers; skips overwritten ones."""
        kept = numbers >= self.written - self.capacity
        self.rows["bound"][numbers[kept] % self.capacity] = bounds[kept]

    def _reserve(self, rows: int) -> None:
        old = self.rows
        if rows <= len(old):
            return
        self.rows = np.zeros(min(max(rows, 2 * len(old)), self.capacity), old.dtype)
        self.rows[: len(old)] = old

    def state(self) -> dict[str, Any]:
        """Returns the filled rows by column and the count of written transitions."""
        filled = self.rows[: self.count]
        return {"written": self.written, **{name: filled[name].copy() for name in self.columns}}

    def restore(self, state: dict[str, Any]) -> None:
        self.written = state["written"]
        self.rows = np.zeros(self.count, self.rows.dtype)
        for name in self.columns:
            self.rows[name] = state[name]


@dataclass(frozen=True)
class ReplayRules:
    """The settings that determine how a batch is drawn, see MixedReplayBuffer."""

    offline_share: float  # share of a batch from the offline store; negative: uniform
    recent_share: float  # share of the online rows from the RECENT_COUNT latest ones
    discount: float  # γ of the value bounds
    use_bounds: bool
    seed: int


class MixedReplayBuffer:
    """The replay buffer of the learner.

    - A share `offline_share` of each batch comes from the offline store. Before the online store
      holds enough transitions for a batch, the whole batch is offline.
    - A negative `offline_share` means uniform sampling from all stored transitions.
    - A share `recent_share` of the online rows comes from the RECENT_COUNT latest ones. They
      contain the mistakes of the current policy. Uniform sampling would draw these too rarely.
    """

    def __init__(
        self,
        capacity: int,
        observation_size: int,
        environments: int,
        rules: ReplayRules,
        device: str = "cpu",
        as_input: Callable[[Array], Array] = unchanged,
    ) -> None:
        """`capacity`: of each store; `device`: where batches are.

        `as_input`: makes what a network sees of the observations of a batch, see Symmetry.
        """
        # Both s and s' are stored, because offline transitions are not consecutive.
        self.offline = Store(capacity, observation_size)
        self.online = Store(capacity, observation_size)
        self.capacity, self.observation_size = capacity, observation_size
        self.environments, self.device = environments, device
        self._as_input = as_input
        self.rules = rules
        self.rng = np.random.default_rng(rules.seed)
        # Per environment, the numbers in `online` of the transitions of its current episode.
        self._episodes: list[list[int]] = [[] for _ in range(environments)]

    def size(self) -> int:
        return self.offline.count + self.online.count

    def add_offline(self, batch: Transitions) -> None:
        """Adds offline transitions, before or during training.

        Raises ValueError if they do not fit.
        """
        if self.offline.count + len(batch.action) > self.offline.capacity:
            raise ValueError(f"more offline transitions than train.buffer = {self.capacity}")
        self.offline.append(
            observation=batch.observation,
            next_observation=batch.next_observation,
            action=batch.action,
            reward=batch.reward,
            terminated=batch.terminated,
            **self._extra_offline_columns(batch.observation),
        )

    def refresh_bounds(self) -> None:
        """Recomputes the value bounds of all offline transitions. To be called after new data."""
        rows = self.offline.rows[: self.offline.count]
        if self.rules.use_bounds and len(rows):
            rows["bound"] = value_bounds(
                rows["observation"], rows["next_observation"], rows["reward"], self.rules.discount
            )

    def add(self, observation: Array, action: Array, step: Step) -> None:
        """Adds one online transition per environment: `action` in `observation` led to `step`.

        A truncated episode does not count as terminated, so its target still bootstraps. A rejected
        push is no transition and is left out.
        """
        kept = np.flatnonzero(~step.rejected)
        more = self._extra_online_columns(observation)
        numbers = self.online.append(
            observation=observation[kept],
            next_observation=step.next_observation[kept],
            action=action[kept],
            reward=step.reward[kept],
            terminated=step.terminated[kept],
            bound=step.reward[kept],
            **{name: column[kept] for name, column in more.items()},
        )
        for env, number in zip(kept, numbers, strict=True):
            self._episodes[env].append(int(number))
        for env in np.flatnonzero(step.terminated | step.truncated):
            self._close_episode(int(env), success=bool(step.terminated[env]))

    def _extra_online_columns(self, observation: Array) -> dict[str, Array]:
        """Returns further columns for the online store. observation [environments, observation]"""
        del observation
        return {}

    def _extra_offline_columns(self, observation: Array) -> dict[str, Array]:
        """Returns further columns for the offline store. observation [N, observation]"""
        del observation
        return {}

    def _close_episode(self, env: int, success: bool) -> None:
        numbers = np.array(self._episodes[env])
        self._episodes[env] = []
        if success and self.rules.use_bounds:
            self.online.set_bounds(
                numbers, self.rules.discount ** np.arange(len(numbers) - 1, -1, -1)
            )

    def sample(self, batch_size: int) -> Batch:
        offline = self._offline_count(batch_size)
        parts: list[Part] = []
        if offline:
            parts.append((self.offline, self.rng.integers(self.offline.count, size=offline)))
        if offline < batch_size:
            parts.append((self.online, self._online_rows(batch_size - offline)))
        columns = self._columns(parts)
        for name in ("observation", "next_observation"):
            columns[name] = self._as_input(columns[name])

        def column(name: str) -> th.Tensor:
            tensor = th.from_numpy(columns[name]).to(self.device)
            return tensor if tensor.ndim == 2 else tensor[:, None]

        return Batch(
            observations=column("observation"),
            actions=column("action"),
            next_observations=column("next_observation"),
            rewards=column("reward"),
            terminated=column("terminated"),
            bounds=column("bound"),
            offline=offline,
        )

    def _columns(self, parts: list[Part]) -> dict[str, Array]:
        """Returns the columns of a batch, which joins the rows in `parts`."""
        batch = np.empty(sum(len(numbers) for _, numbers in parts), self.offline.rows.dtype)
        begin = 0
        for store, numbers in parts:
            end = begin + len(numbers)
            # The mode spares np.take a copy of `out`.
            np.take(store.rows, numbers, out=batch[begin:end], mode="clip")
            begin = end
        columns = {name: np.ascontiguousarray(batch[name]) for name in self.offline.columns}
        if not self.rules.use_bounds:
            columns["bound"].fill(-np.inf)
        return columns

    def _online_rows(self, count: int) -> Array:
        """Draws `count` rows of the online store; the first of them are recent (recent_share)."""
        store = self.online
        rows = self.rng.integers(store.count, size=count)
        recent = min(store.count, RECENT_COUNT)
        back = self.rng.integers(recent, size=round(self.rules.recent_share * count))
        rows[: len(back)] = (store.written - 1 - back) % store.capacity
        return rows

    def _offline_count(self, batch_size: int) -> int:
        offline, online = self.offline.count, self.online.count
        if offline + online == 0:
            raise ValueError("nothing to sample from: the replay buffer is empty")
        if self.rules.offline_share < 0.0:
            return int(self.rng.binomial(batch_size, offline / (offline + online)))
        if offline == 0:
            return 0
        return batch_size if online < batch_size else round(self.rules.offline_share * batch_size)

    def state(self) -> dict[str, Any]:
        """Returns the state for a checkpoint, without offline transitions.

        These have their own file. To continue bit for bit, the caller adds them again, and
        refreshes their bounds at the same numbers of transitions as before.
        """
        return {
            "online": self.online.state(),
            "rng": self.rng.bit_generator.state,
            "episodes": [list(numbers) for numbers in self._episodes],
        }

    def restore(self, state: dict[str, Any]) -> None:
        self.online.restore(state["online"])
        self.rng.bit_generator.state = state["rng"]
        self._episodes = [list(numbers) for numbers in state["episodes"]]
