"""Behaviour cloning: the policy learns to imitate the stored actions [Pomerleau 1988]."""

from __future__ import annotations

from torch.nn import functional

from rtg.files.dataset import SOURCES, Transitions
from rtg.learn.ddqn import DoubleDqn
from rtg.learn.replay import Batch

# The source of transitions from which a plan is known to succeed. Those of a "branch" or a "walk"
# need not lead anywhere. Nor need those of a "forward" search, which also keeps dead ends.
IMITATED_SOURCE = "tree"


def imitated(data: Transitions) -> Transitions:
    """Returns the transitions to imitate, those from IMITATED_SOURCE."""
    kept = data.source == SOURCES.index(IMITATED_SOURCE)
    return Transitions(*(column[kept] for column in data))


class Cloning(DoubleDqn):
    """Behaviour cloning with the network of DoubleDqn. Its outputs f(s, ·) are action logits:

        loss = -mean log softmax(f(s, ·))_a,

    where the mean is over a batch of transitions to imitate. The policy takes the most likely
    action of the network with averaged weights.
    """

    def _compute_gradient(self, batch: Batch) -> None:
        logits = self.online(batch.observations)
        self._backward(functional.cross_entropy(logits, batch.actions[:, 0]))
