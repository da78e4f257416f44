"""How to learn: the section `train` of the configuration as the C++ loader resolved it."""

from __future__ import annotations

import dataclasses
from typing import Any

# What a checkpoint is bound to: the shape of its network and buffer, the returns it has counted.
OF_CHECKPOINT = (
    "learner",
    "interact",
    "offline",
    "train_frequency",
    "buffer",
    "discount",
    "dueling",
    "layer_norm",
    "hindsight",
    "curriculum",
)


@dataclasses.dataclass(frozen=True)
class TrainSettings:
    """Mirror of rtg::TrainConfig, which documents the fields and has their defaults and ranges."""

    preset: str
    learner: str
    interactions: int
    interact: bool
    offline: bool
    start_at: int
    buffer: int
    batch: int
    learning_rate: float
    train_frequency: int
    gradient_steps: int
    target_sync: int
    target_rate: float
    target_acts: bool
    policy_rate: float
    discount: float
    offline_share: float
    recent_share: float
    conservatism: float
    double_q: bool
    cautious: bool
    dueling: bool
    layer_norm: bool
    small_head: bool
    clip_targets: bool
    value_bounds: bool
    epsilon_start: float
    epsilon_end: float
    epsilon_share: float
    nearby_share: float
    nearby_headings: int
    contact_share: float
    leave_loops: bool
    start_jitter: float
    randomise: bool
    hindsight: int
    curriculum: float
    eval_every: int
    eval_episodes: int
    checkpoint_every: int
    stop_at_success: float
    stop_evaluations: int
    reduced_precision: bool
    device: str

    @classmethod
    def from_config(cls, section: dict[str, Any]) -> TrainSettings:
        """From the `train` section of the configuration as JSON; KeyError if a field is absent."""
        return cls(**{field.name: section[field.name] for field in dataclasses.fields(cls)})
