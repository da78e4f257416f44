"""The learner: networks, replay, gradient steps, evaluation, and the process that runs them."""
