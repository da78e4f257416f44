"""The learner: networks, replay, gradient steps, evaluation, and the process that does them."""
