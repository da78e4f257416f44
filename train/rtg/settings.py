"""How to learn: the section `train` of the configuration as the C++ loader resolved it."""

from __future__ import annotations

import dataclasses
from typing import Any

# What a checkpoint is bound to: the shape of its network and buffer, the returns it has counted.
OF_CHECKPOINT = (
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
    """Mirror of rtg::TrainConfig, which documents the fields and holds their legal ranges."""

    preset: str = "default"
    interactions: int = 350_000
    offline: bool = True
    start_at: int = 40_000
    buffer: int = 1_500_000
    batch: int = 256
    learning_rate: float = 3.0e-4
    train_frequency: int = 4
    gradient_steps: int = 1
    target_sync: int = 1
    target_rate: float = 0.005
    target_acts: bool = True
    policy_rate: float = 1.5e-4
    discount: float = 0.95
    offline_share: float = 0.5
    recent_share: float = 0.5
    double_q: bool = True
    cautious: bool = True
    dueling: bool = True
    layer_norm: bool = True
    small_head: bool = True
    clip_targets: bool = True
    value_bounds: bool = True
    epsilon_start: float = 0.3
    epsilon_end: float = 0.02
    epsilon_share: float = 0.2
    nearby_share: float = 0.5
    nearby_headings: int = 2
    leave_loops: bool = True
    start_jitter: float = 0.1
    randomise: bool = False
    hindsight: int = 0
    curriculum: float = 0.0
    eval_every: int = 5_000
    eval_episodes: int = 100
    checkpoint_every: int = 20_000
    stop_at_success: float = 0.95
    stop_evaluations: int = 3
    reduced_precision: bool = True
    device: str = "auto"

    @classmethod
    def from_config(cls, section: dict[str, Any]) -> TrainSettings:
        """From the `train` section of the configuration as JSON; KeyError if a field is absent."""
        return cls(**{field.name: section[field.name] for field in dataclasses.fields(cls)})
