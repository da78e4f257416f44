"""Behaviour cloning: the policy learns to imitate the stored actions [Pomerleau 1988]."""

from __future__ import annotations

import numpy as np
from torch.nn import functional

from rtg.files.dataset import SOURCES, Transitions
from rtg.learn.ddqn import DoubleDqn
from rtg.learn.replay import Batch

# Sources of steps that lead towards the goal; those of a "branch" need not.
IMITATED_SOURCES = ("tree", "forward")


def imitated(data: Transitions) -> Transitions:
    """Returns the rows whose source is in IMITATED_SOURCES."""
    kept = np.isin(data.source, [SOURCES.index(name) for name in IMITATED_SOURCES])
    return Transitions(*(column[kept] for column in data))


class Cloning(DoubleDqn):
    """Trains the network of DoubleDqn with its outputs f(s, ·) as the logits of the actions:

        loss = -mean log softmax(f(s, ·))_a

    over batches of steps to imitate. The policy chooses the most likely action according to the
    network with the averaged weights.
    """

    def _gradient_step(self, batch: Batch) -> None:
        logits = self.q_net(batch.observations)
        self._descend(functional.cross_entropy(logits, batch.actions[:, 0]))
