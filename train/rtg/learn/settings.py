"""Rules on the settings of the learner."""

from __future__ import annotations

from typing import NamedTuple

from rtg import _core

# Fields of TrainConfig that must not change when a run continues from a checkpoint. They determine
# the shapes of network and buffer, and the returns and counts in the checkpoint.
CHECKPOINT_SETTINGS = (
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


def learner_discount(config: _core.Config) -> float:
    """Returns the learner's discount: `train.discount`, or that of the task if it is 0."""
    return config.train.discount or config.task.discount


class Amplitudes(NamedTuple):
    """Largest random displacements of objects in x and y at the start of an episode [m]."""

    evaluation: float
    training: float


def start_amplitudes(config: _core.Config) -> Amplitudes:
    """Returns the amplitudes of the starts, which `train.randomise` changes."""
    task, training = config.task, config.train.start_jitter
    if not config.train.randomise:
        return Amplitudes(task.start_jitter, training)
    return Amplitudes(task.randomisation, max(training, task.randomisation))
