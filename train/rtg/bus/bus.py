"""The only Python module that touches LCM.

LCM loses, doubles and reorders messages, and anyone may send: what arrives is checked against its
type, the run and finite numbers before a handler sees it; what is dropped is counted.
"""

from __future__ import annotations

import math
import os
import re
import socket
import stat
import struct
from collections import Counter
from collections.abc import Callable
from typing import Any, TypeVar

import lcm

from rtg.errors import RunError

PROTOCOL = 1  # version of the rules in msgs/CHANNELS.md
MAX_MESSAGE_BYTES = 60_000
RECEIVE_BUFFER = 4 << 20  # [bytes]; the kernel's default of 208 kB loses every burst
QUEUE_CAPACITY = 1000  # messages; LCM's default of 30 drops new ones silently

Message = TypeVar("Message")


def run_key(run: str) -> int:
    """`header.run` of the run of this name: FNV-1a, 64 bit, as a signed number."""
    key = 0xCBF29CE484222325
    for byte in run.encode():
        key = (key ^ byte) * 0x100000001B3 % 2**64
    return key - 2**64 if key >= 2**63 else key


def _is_finite(message: Any) -> bool:
    """Says whether every float of a decoded message is a number."""
    for name, kind in zip(message.__slots__, message.__typenames__, strict=True):
        if kind in ("double", "float"):
            value = getattr(message, name)
            values = value if isinstance(value, (tuple, list)) else (value,)
            if not all(map(math.isfinite, values)):
                return False
    return True


def decoded(message_type: Any, data: bytes) -> Any:
    """The message of whatever run, or the name of the counter of its defect."""
    if len(data) > MAX_MESSAGE_BYTES:
        return "bus.too_long"
    try:
        message = message_type.decode(data)
        well_formed = len(message.encode()) == len(data)
    except (ValueError, struct.error, IndexError):
        well_formed = False
    if not well_formed:
        return "bus.malformed"
    return message if _is_finite(message) else "bus.not_finite"


def _receive_buffer(port: int) -> int:
    """The size of the buffer of the UDP socket bound to `port` [bytes]; LCM does not tell its
    descriptor. 0 if none is."""
    for number in map(int, os.listdir("/proc/self/fd")):
        try:
            if not stat.S_ISSOCK(os.fstat(number).st_mode):
                continue
            with socket.socket(fileno=os.dup(number)) as found:
                if found.family == socket.AF_INET and found.getsockname()[1] == port:
                    size = found.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF)
                    return size // 2  # Linux reports twice what it was asked for
        except OSError:  # closed meanwhile: LCM's thread runs
            continue
    return 0


def _small_buffer(url: str) -> str | None:
    """The words to say if the kernel gave LCM's socket less than it was asked for; else None."""
    match = re.match(r"udpm://[\d.]+:(\d+)", url)
    size = RECEIVE_BUFFER if match is None else _receive_buffer(int(match.group(1)))
    if size >= RECEIVE_BUFFER:
        return None
    return (
        f"bus: receive buffer is {size >> 10} kB instead of {RECEIVE_BUFFER >> 10} kB; bursts will "
        f"be lost and sent again. To raise it: sysctl -w net.core.rmem_max={RECEIVE_BUFFER}"
    )


class Bus:
    """Publishes and receives the messages of one run.

    `url`: "udpm://GROUP:PORT[?ttl=N]" or "memq://" (one process, for tests); the C++ configuration
    loader checks it. ttl is 0, this machine only, unless named. Raises RunError if the network
    cannot be opened or swallows what is sent. `warning`, known from the first subscription on: what
    whoever opened the bus should say where people read it.
    """

    def __init__(self, url: str, run: str) -> None:
        if url.startswith("udpm:"):
            url += ("&" if "?" in url else "?ttl=0&") + f"recv_buf_size={RECEIVE_BUFFER}"
        self.counters: Counter[str] = Counter()
        self.warning: str | None = None
        self._url = url
        try:
            self._lcm = lcm.LCM(url)
        except RuntimeError as error:
            raise RunError(f"bus '{url}' cannot be opened: {error}") from error
        self._run = run_key(run)
        self._subscriptions: list[Any] = []
        self._failure: BaseException | None = None

    def publish(self, channel: str, message: Any) -> None:
        """Fills the header and sends. A datagram the kernel refuses is as lost as any other."""
        message.header.protocol = PROTOCOL
        message.header.run = self._run
        message.header.sender = os.getpid()
        data = message.encode()
        if len(data) > MAX_MESSAGE_BYTES:
            raise ValueError(f"{type(message).__name__}: longer than one datagram")
        self.send(channel, data)

    def send(self, channel: str, data: bytes) -> None:
        """Sends bytes as they are; for tests of what a stranger may send."""
        try:
            self._lcm.publish(channel, data)
        except OSError:
            self.counters["bus.unsent"] += 1

    def subscribe(
        self, channel: str, message_type: type[Message], handler: Callable[[Message], None]
    ) -> None:
        def receive(_: str, data: bytes) -> None:
            message = self.decode(message_type, data)
            if message is not None:
                handler(message)

        self.watch(channel, receive)

    def watch(self, pattern: str, handler: Callable[[str, bytes], None]) -> None:
        """Undecoded messages of all channels that match the regular expression, for monitors."""

        def receive(channel: str, data: bytes) -> None:
            try:
                handler(channel, data)
            except BaseException as error:  # carried past LCM's C frames, raised by spin()
                self._failure = self._failure or error

        subscription = self._lcm.subscribe(pattern, receive)
        if subscription is None:
            raise RunError("bus: messages sent do not come back; is multicast enabled?")
        subscription.set_queue_capacity(QUEUE_CAPACITY)
        if not self._subscriptions:  # LCM opens its socket now
            self.warning = _small_buffer(self._url)
        self._subscriptions.append(subscription)

    def close(self) -> None:
        """Hears nothing more. The handlers are let go; LCM's would be kept until the very end."""
        for subscription in self._subscriptions:
            self._lcm.unsubscribe(subscription)
        self._subscriptions.clear()

    def decode(self, message_type: type[Message], data: bytes) -> Message | None:
        """The message, or None and a count of why not."""
        message = decoded(message_type, data)
        if isinstance(message, str):
            self.counters[message] += 1
        elif message.header.run != self._run:
            self.counters["bus.foreign_run"] += 1
        elif message.header.protocol != PROTOCOL:
            self.counters["bus.foreign_protocol"] += 1
        else:
            checked: Message = message
            return checked
        return None

    def spin(self, timeout: float) -> int:
        """Waits `timeout` s at most for a message, then handles all that came; returns how many.

        Raises the first exception of a handler. A signal ends the wait early.
        """
        handled, wait_ms = 0, int(timeout * 1000)
        while handled < QUEUE_CAPACITY:
            try:
                if self._lcm.handle_timeout(wait_ms) <= 0:
                    break
            except OSError:  # how LCM reports an interrupting signal, and all else that goes wrong
                self.counters["bus.interrupted"] += 1
                break
            handled, wait_ms = handled + 1, 0
            if self._failure is not None:
                failure, self._failure = self._failure, None
                raise failure
        return handled
