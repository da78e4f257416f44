"""A listener to the transition stream that sends nothing, so that no sender waits for it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.bus.transition_stream import to_rows
from rtg.files.dataset import Rows

Ints = NDArray[np.int64]


class StreamListener:
    """Passes the rows that this process hears to `sink(numbers, rows)`, as they arrive.

    `numbers` [n]: the places of the rows in the sequence of generation. Rows may be missing, come
    twice and out of order: a listener acknowledges nothing and asks for nothing. Those that were
    sent before it came are not sent again. A generation that begins anew finds the same rows.

    `most`: rows of the run. Numbers beyond are illegal: whoever keeps rows by number would take as
    much memory as a stranger says.
    """

    def __init__(
        self,
        bus: _core.Bus,
        bodies: int,
        actions: int,
        most: int,
        sink: Callable[[Ints, Rows], object],
    ) -> None:
        self._bus, self._bodies, self._actions, self._most = bus, bodies, actions, most
        self._sink = sink
        bus.subscribe("RTG_TRANSITION", "transition_batch_t", self._on_batch)

    def _on_batch(self, message: Any) -> None:
        rows = to_rows(message, self._bodies, self._actions)
        if rows is None or message.first + message.n > self._most:
            self._bus.count("stream.illegal")
            return
        self._sink(np.arange(message.first, message.first + message.n), rows)
