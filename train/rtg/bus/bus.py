"""The only Python module that uses the LCM library.

LCM may lose, duplicate and reorder messages, and any program may send. So a message reaches a
handler only if it has the right type and run and finite numbers. Other messages are dropped and
counted.
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
RECEIVE_BUFFER = 4 << 20  # [bytes]; the kernel's default of 208 kB loses messages in every burst
QUEUE_CAPACITY = 1000  # messages; LCM's default of 30 silently drops new messages

Message = TypeVar("Message")


def run_key(run: str) -> int:
    """Returns `header.run` for a run name: its 64-bit FNV-1a hash as a signed number."""
    key = 0xCBF29CE484222325
    for byte in run.encode():
        key = (key ^ byte) * 0x100000001B3 % 2**64
    return key - 2**64 if key >= 2**63 else key


def _is_finite(message: Any) -> bool:
    """Returns whether all floats of a decoded message are finite."""
    for name, kind in zip(message.__slots__, message.__typenames__, strict=True):
        if kind in ("double", "float"):
            value = getattr(message, name)
            values = value if isinstance(value, (tuple, list)) else (value,)
            if not all(map(math.isfinite, values)):
                return False
    return True


def decoded(message_type: Any, data: bytes) -> Any:
    """Decodes a message of any run; returns the name of the error counter if it is invalid."""
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
    """Returns the receive buffer size [bytes] of this process's UDP socket on `port`, 0 if none.

    Searches all open descriptors, because LCM does not expose that of its socket.
    """
    for number in map(int, os.listdir("/proc/self/fd")):
        try:
            if not stat.S_ISSOCK(os.fstat(number).st_mode):
                continue
            with socket.socket(fileno=os.dup(number)) as found:
                if found.family == socket.AF_INET and found.getsockname()[1] == port:
                    size = found.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF)
                    return size // 2  # Linux reports twice the requested size
        except OSError:  # closed meanwhile, as LCM's thread runs concurrently
            continue
    return 0


def _small_buffer(url: str) -> str | None:
    """Returns a warning if the receive buffer of LCM's socket is too small, else None."""
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
    loader checks it. ttl defaults to 0, which restricts messages to this machine. The constructor
    raises RunError if the network cannot be opened; subscribe() and watch() raise it if sent
    messages do not come back. `warning` is set by the first subscription: a text that the owner of
    the bus should show to the user, or None.
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
        """Fills in the header and sends. A datagram that the kernel refuses is lost.

        Raises ValueError if the message is longer than MAX_MESSAGE_BYTES.
        """
        message.header.protocol = PROTOCOL
        message.header.run = self._run
        message.header.sender = os.getpid()
        data = message.encode()
        if len(data) > MAX_MESSAGE_BYTES:
            raise ValueError(f"{type(message).__name__}: longer than one datagram")
        self.send(channel, data)

    def send(self, channel: str, data: bytes) -> None:
        """Sends `data` unchanged; tests use it for messages of unknown senders."""
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
        """Passes the undecoded messages of all channels that match `pattern` to `handler`.

        `pattern` is a regular expression. Raises RunError if sent messages do not come back.
        """

        def receive(channel: str, data: bytes) -> None:
            try:
                handler(channel, data)
            except BaseException as error:  # cannot pass LCM's C frames; spin() raises it
                self._failure = self._failure or error

        subscription = self._lcm.subscribe(pattern, receive)
        if subscription is None:
            raise RunError("bus: messages sent do not come back; is multicast enabled?")
        subscription.set_queue_capacity(QUEUE_CAPACITY)
        if not self._subscriptions:  # LCM opens its socket now
            self.warning = _small_buffer(self._url)
        self._subscriptions.append(subscription)

    def close(self) -> None:
        """Ends all subscriptions and releases the handlers, which LCM would keep until exit."""
        for subscription in self._subscriptions:
            self._lcm.unsubscribe(subscription)
        self._subscriptions.clear()

    def decode(self, message_type: type[Message], data: bytes) -> Message | None:
        """Decodes a message of this run. Returns None for any other and counts the reason."""
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
        """Waits at most `timeout` s for a message, handles all that arrived, returns their number.

        Raises the first exception of a handler. A signal ends the wait early.
        """
        handled, wait_ms = 0, int(timeout * 1000)
        while handled < QUEUE_CAPACITY:
            try:
                if self._lcm.handle_timeout(wait_ms) <= 0:
                    break
            except OSError:  # LCM reports an interrupting signal, and any other error, so
                self.counters["bus.interrupted"] += 1
                break
            handled, wait_ms = handled + 1, 0
            if self._failure is not None:
                failure, self._failure = self._failure, None
                raise failure
        return handled
