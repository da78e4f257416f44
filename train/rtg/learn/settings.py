"""Settings to which a checkpoint is bound."""

from __future__ import annotations

# Fields of TrainConfig that must not change when a run continues from a checkpoint. They determine
# the shapes of network and buffer, and the returns and counts in the checkpoint.
CHECKPOINT_SETTINGS = (
    "learner",
    "interact",
    "offline",
    "train_frequency",
    "buffer",
    "discount",
    "network",
    "symmetry",
    "hindsight",
    "curriculum",
)
