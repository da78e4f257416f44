"""The settings of the learner that must not change when a run continues from a checkpoint."""

# Fields of TrainConfig. They determine the shapes of network and buffer, and the returns and counts
# in the checkpoint.
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
