"""The consumer of the transition stream: gets each row once, in order, despite message loss.

A row is a transition. Rows are numbered from 0 in the order of generation.
"""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable
from typing import Any, cast

import numpy as np

from rtg import _core
from rtg.errors import RunError
from rtg.files.dataset import SOURCES, Rows


def to_rows(message: Any, bodies: int, actions: int) -> Rows | None:
    """Returns the rows of a transition_batch_t, or None if they are invalid.

    `bodies` and `actions`: the task's numbers of bodies and of actions.
    """
    n = message.n
    if n < 1 or message.first < 0 or message.n_poses != n * bodies * 3:
        return None
    success = np.asarray(message.success, np.int8)
    rows = Rows(
        poses=np.asarray(message.poses, np.float64).reshape(n, bodies, 3),
        action=np.asarray(message.action, np.int32),
        next_poses=np.asarray(message.next_poses, np.float64).reshape(n, bodies, 3),
        reward=success.astype(np.float32),
        terminated=success.astype(np.bool_),
        source=np.asarray(message.source, np.int8),
    )
    legal = (
        ((rows.action >= 0) & (rows.action < actions)).all()
        and ((success == 0) | (success == 1)).all()
        and ((rows.source >= 0) & (rows.source < len(SOURCES))).all()
    )
    return rows if legal else None


class TransitionStream:
    """Passes every transition of the run to `sink`, once and in order.

    stream = TransitionStream(bus, bodies=7, actions=48, most=60_000, sink=buffer.add)
    while not stream.complete:
        stream.poll(0.1)
    """

    def __init__(
        self, bus: _core.Bus, bodies: int, actions: int, most: int, sink: Callable[[Rows], object]
    ) -> None:
        self._bus, self._most = bus, most
        self._bodies, self._actions = bodies, actions
        self._sink = sink
        self._cursor = _core.StreamCursor()
        self._consumer = secrets.randbits(62)
        self._stream: int | None = None
        bus.subscribe("RTG_TRANSITION", "transition_batch_t", self._on_batch)
        bus.subscribe("RTG_TAIL", "stream_tail_t", self._on_tail)

    def poll(self, timeout: float) -> int:
        """Waits at most `timeout` s for messages; returns the number of rows passed to the sink.

        A coordinator that is started again sends the same rows. Raises RunError if it begins
        another generation.
        """
        before = self._cursor.cursor
        self._bus.spin(timeout)
        self._acknowledge()
        return self._cursor.cursor - before

    def close(self) -> None:
        """Ends the reception of rows."""
        self._bus.unsubscribe()

    @property
    def received(self) -> int:
        """Number of rows passed to the sink."""
        return self._cursor.cursor

    @property
    def complete(self) -> bool:
        """True if the number of rows is final and the sink has received every row."""
        return self._cursor.complete

    def _on_batch(self, message: Any) -> None:
        rows = to_rows(message, self._bodies, self._actions)
        if rows is None or message.first + message.n > self._most:
            self._bus.count("stream.illegal")
            return
        self._check_stream(message.stream)
        now = time.monotonic()
        end = message.first + message.n
        for piece, skip in self._cursor.on_rows(message.first, end, rows, now):
            self._sink(cast(Rows, piece).slice(skip))
        self._acknowledge()

    def _on_tail(self, message: Any) -> None:
        if not 0 <= message.count <= self._most:
            self._bus.count("stream.illegal")
            return
        self._check_stream(message.stream)
        self._cursor.on_tail(message.count, bool(message.sealed))

    def _check_stream(self, stream: int) -> None:
        if self._stream is None:
            self._stream = stream
        if stream != self._stream:
            raise RunError("the coordinator began another generation; its rows differ")

    def _acknowledge(self) -> None:
        if self._stream is None:
            return
        while ack := self._cursor.due(time.monotonic()):
            self._bus.publish(
                "RTG_ACK",
                "stream_ack_t",
                stream=self._stream,
                consumer=self._consumer,
                cursor=ack.cursor,
                credit=ack.credit,
                first=[first for first, _ in ack.missing],
                last=[end - 1 for _, end in ack.missing],
            )
