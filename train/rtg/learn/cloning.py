"""Behaviour cloning: the policy learns to imitate the stored actions [Pomerleau 1988]."""

from __future__ import annotations

import numpy as np
from torch.nn import functional

from rtg.files.dataset import SOURCES, Transitions
from rtg.learn.ddqn import DoubleDqn
from rtg.learn.replay import Batch

# Sources of transitions that lead towards the goal. Those of a "branch" or a "walk" need not.
IMITATED_SOURCES = ("tree", "forward")


def imitated(data: Transitions) -> Transitions:
    """Returns the transitions to imitate, those with a source in IMITATED_SOURCES."""
    kept = np.isin(data.source, [SOURCES.index(name) for name in IMITATED_SOURCES])
    return Transitions(*(column[kept] for column in data))


class Cloning(DoubleDqn):
    """Behaviour cloning with the network of DoubleDqn. Its outputs f(s, ·) are action logits:

        loss = -mean log softmax(f(s, ·))_a,

    where the mean is over a batch of transitions to imitate. The policy takes the most likely
    action of the network with averaged weights.
    """

    def _gradient_step(self, batch: Batch) -> None:
        logits = self.q_net(batch.observations)
        self._descend(functional.cross_entropy(logits, batch.actions[:, 0]))
