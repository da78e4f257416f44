"""Behaviour cloning: the policy does what the stored steps do [Pomerleau 1988]."""

from __future__ import annotations

import numpy as np
from torch.nn import functional

from rtg.files.dataset import SOURCES, Transitions
from rtg.learn.ddqn import DoubleDqn
from rtg.learn.replay import Batch

IMITATED = ("tree", "plan")  # steps that were found to lead on; a branch may lead anywhere


def imitated(data: Transitions) -> Transitions:
    """The rows whose actions are worth imitating."""
    kept = np.isin(data.source, [SOURCES.index(name) for name in IMITATED])
    return Transitions(*(column[kept] for column in data))


class Cloning(DoubleDqn):
    """The network of DoubleDqn, its outputs f(s, ·) taken for logits of the actions:

        loss = -mean log softmax(f(s, ·))_a

    over batches of steps to imitate. The policy is the likeliest action by the mean weights.
    """

    def _gradient_step(self, batch: Batch) -> None:
        logits = self.q_net(batch.observations)
        self._descend(functional.cross_entropy(logits, batch.actions[:, 0]))
