"""The consumer of the transition stream: gets each row once, in order, despite message loss.

A row is a transition. Rows are numbered from 0 in the order of generation.
"""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from rtg import _core
from rtg.errors import RunError
from rtg.files.dataset import SOURCES, Rows

ACK_INTERVAL = 0.5  # [s], between acknowledgements without progress
RETRY_INTERVAL = 0.1  # [s], between two requests for the same rows
MIN_INTERVAL = 0.01  # [s], between any two acknowledgements
MAX_RANGES = 32  # maximum number of ranges in one acknowledgement
# Number of acknowledgements sent at once when the stream is complete. The consumer may then exit,
# so one of them must survive message loss.
FINAL_ACKS = 10
CREDIT = 8192  # number of rows that the sender may send in advance


class Ack(NamedTuple):
    """An acknowledgement: the message of a consumer to the sender of the rows."""

    cursor: int  # number of the next row to consume
    credit: int  # number of rows accepted from the cursor on; 0: the consumer has all rows
    missing: list[tuple[int, int]]  # ranges of rows to send again, first and last row


class StreamCursor:
    """The protocol of a consumer, without I/O.

    It takes received messages, and returns rows in order and Acks to send. It holds at most
    `credit` rows beyond the cursor. `now` is the time of a monotonic clock [s].
    """

    def __init__(self, credit: int) -> None:
        self.credit = credit
        self.cursor = 0  # number of the next row to return
        self.count = 0  # number of rows known to exist
        self.sealed = False
        self._out_of_order: dict[int, tuple[int, Any]] = {}  # first row -> (end, rows), may overlap
        self._acked_at = -1e9
        self._acked_cursor = 0
        self._requested_at = -1e9
        self._requested_end = 0
        self._arrived_at = -1e9
        self._final_acks_left = FINAL_ACKS

    def on_rows(self, first: int, rows: Any, size: int, now: float) -> list[tuple[Any, int]]:
        """Takes the received rows `first` ... `first` + `size` - 1.

        Returns the batches of `rows` that are next in order, each with the number of leading rows
        to skip. Ignores rows beyond the credit.
        """
        self._arrived_at = now
        end = first + size
        self.count = max(self.count, end)
        if end <= self.cursor or end > self.cursor + self.credit:
            return []
        if end > self._out_of_order.get(first, (0, None))[0]:
            self._out_of_order[first] = (end, rows)
        return self._in_order()

    def on_tail(self, count: int, sealed: bool) -> None:
        self.count = max(self.count, count)
        self.sealed = self.sealed or sealed

    def ack_due(self, now: float) -> Ack | None:
        """Returns the next Ack to send, or None. To be called until it returns None."""
        if self.complete:
            return self._final_ack(now)
        missing = self._missing()
        request = bool(missing) and (
            self.cursor >= self._requested_end  # all requested rows have arrived
            or now - self._requested_at >= RETRY_INTERVAL
        )
        # If no later row has arrived, the missing rows are probably still in transit.
        if request and not self._out_of_order and now - self._arrived_at < RETRY_INTERVAL / 2:
            request = False
        moved = self.cursor - self._acked_cursor >= self.credit // 4
        idle = now - self._acked_at >= ACK_INTERVAL
        if not (request or moved or idle) or now - self._acked_at < MIN_INTERVAL:
            return None
        self._acked_at, self._acked_cursor = now, self.cursor
        if not request:
            return Ack(self.cursor, self.credit, [])
        self._requested_at, self._requested_end = now, missing[-1][1] + 1
        return Ack(self.cursor, self.credit, missing)

    def _final_ack(self, now: float) -> Ack | None:
        if self._final_acks_left > 0:
            self._final_acks_left -= 1
        elif now - self._acked_at < ACK_INTERVAL:
            return None
        self._acked_at = now
        return Ack(self.cursor, 0, [])

    @property
    def complete(self) -> bool:
        """True if the number of rows is final and every row has been returned."""
        return self.sealed and self.cursor == self.count

    def _in_order(self) -> list[tuple[Any, int]]:
        pieces = []
        for first in sorted(self._out_of_order):
            if first > self.cursor:
                break
            end, rows = self._out_of_order.pop(first)
            if end > self.cursor:
                pieces.append((rows, self.cursor - first))
                self.cursor = end
        return pieces

    def _missing(self) -> list[tuple[int, int]]:
        """Returns at most MAX_RANGES ranges (first, last) of missing rows within the credit."""
        gaps, at = [], self.cursor
        for first in sorted(self._out_of_order):
            if first > at:
                gaps.append((at, first - 1))
            at = max(at, self._out_of_order[first][0])
        end = min(self.count, self.cursor + self.credit)
        if at < end:
            gaps.append((at, end - 1))
        return gaps[:MAX_RANGES]


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

    stream = TransitionStream(bus, bodies=7, actions=48, sink=buffer.add)
    while not stream.complete:
        stream.poll(0.1)
    """

    def __init__(
        self, bus: _core.Bus, bodies: int, actions: int, sink: Callable[[Rows], object]
    ) -> None:
        self._bus = bus
        self._bodies, self._actions = bodies, actions
        self._sink = sink
        self._cursor = StreamCursor(CREDIT)
        self._consumer = secrets.randbits(62)
        self._stream: int | None = None
        bus.subscribe("RTG_TRANSITION", "transition_batch_t", self._on_batch)
        bus.subscribe("RTG_TAIL", "stream_tail_t", self._on_tail)

    def poll(self, timeout: float) -> int:
        """Waits at most `timeout` s for messages; returns the number of rows passed to the sink.

        Raises RunError if the coordinator, which sends the rows, was restarted.
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
    def lost(self) -> int:
        """Number of rows that exist but have not been received; 0 once the stream is complete."""
        return self._cursor.count - self._cursor.cursor

    @property
    def complete(self) -> bool:
        """True if the number of rows is final and the sink has received every row."""
        return self._cursor.complete

    def _on_batch(self, message: Any) -> None:
        rows = to_rows(message, self._bodies, self._actions)
        if rows is None:
            self._bus.count("stream.illegal")
            return
        self._check_stream(message.stream)
        now = time.monotonic()
        for piece, skip in self._cursor.on_rows(message.first, rows, message.n, now):
            self._sink(piece.slice(skip))
        self._acknowledge()

    def _on_tail(self, message: Any) -> None:
        if message.count < 0:
            self._bus.count("stream.illegal")
            return
        self._check_stream(message.stream)
        self._cursor.on_tail(message.count, bool(message.sealed))

    def _check_stream(self, stream: int) -> None:
        if self._stream is None:
            self._stream = stream
        if stream != self._stream:
            raise RunError("the coordinator was restarted: two streams must not be mixed")

    def _acknowledge(self) -> None:
        if self._stream is None:
            return
        while ack := self._cursor.ack_due(time.monotonic()):
            self._bus.publish(
                "RTG_ACK",
                "stream_ack_t",
                stream=self._stream,
                consumer=self._consumer,
                cursor=ack.cursor,
                credit=ack.credit,
                first=[first for first, _ in ack.missing],
                last=[last for _, last in ack.missing],
            )
