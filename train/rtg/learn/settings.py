"""The settings of the learner that must not change after a checkpoint; see TrainConfig."""

# They determine the shapes of network and buffer, and the returns and counts in the checkpoint.
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
