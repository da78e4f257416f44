"""Which settings of the learner its checkpoint is bound to. TrainConfig has them all."""

# The shape of its network and buffer, and the returns that it has counted.
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
