"""The only Python module that uses the LCM library.

LCM may lose, duplicate and reorder messages. Any program may send messages on the same channels. So
a Bus checks type, run and finite numbers of each message. It drops and counts all others.
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
QUEUE_CAPACITY = 1000  # waiting messages; LCM silently drops further ones, by default from 30 on

Message = TypeVar("Message")


def run_key(run: str) -> int:
    """Returns the value of `header.run` for the run named `run`.

    It is the 64-bit FNV-1a hash of the name, as a signed number.
    """
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
    """Decodes `data` as a message of any run.

    Returns the name of the error counter to increase if the message is invalid.
    """
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
    """Returns the receive buffer size [bytes] of LCM's socket on UDP port `port`; 0 if none.

    Searches all open file descriptors of this process, because LCM does not expose its socket.
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

    `url`: "udpm://GROUP:PORT[?ttl=N]", or "memq://" (one process, for tests). The C++ configuration
    loader checks it. The default ttl of 0 keeps messages on this machine.

    `warning`: a text that the owner should show to the user, or None. The first subscription sets
    it.

    The constructor raises RunError if the network cannot be opened. subscribe() and watch() raise
    RunError if this process does not receive its own messages.
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
        """Fills in the header of `message` and sends it on `channel`.

        A message that the kernel refuses to send is lost and counted. Raises ValueError if the
        message is longer than MAX_MESSAGE_BYTES.
        """
        message.header.protocol = PROTOCOL
        message.header.run = self._run
        message.header.sender = os.getpid()
        data = message.encode()
        if len(data) > MAX_MESSAGE_BYTES:
            raise ValueError(f"{type(message).__name__}: the message is longer than one datagram")
        self.send(channel, data)

    def send(self, channel: str, data: bytes) -> None:
        """Sends `data` without filling in a header. Tests use it to imitate other programs."""
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

        `pattern` is a regular expression. Raises RunError if this process does not receive its own
        messages.
        """

        def receive(channel: str, data: bytes) -> None:
            try:
                handler(channel, data)
            except BaseException as error:  # cannot pass through LCM's C code; spin() raises it
                self._failure = self._failure or error

        subscription = self._lcm.subscribe(pattern, receive)
        if subscription is None:
            raise RunError("bus: messages sent do not come back; is multicast enabled?")
        subscription.set_queue_capacity(QUEUE_CAPACITY)
        if not self._subscriptions:  # LCM opens its socket now
            self.warning = _small_buffer(self._url)
        self._subscriptions.append(subscription)

    def close(self) -> None:
        """Ends all subscriptions. LCM would otherwise keep the handlers until the process ends."""
        for subscription in self._subscriptions:
            self._lcm.unsubscribe(subscription)
        self._subscriptions.clear()

    def decode(self, message_type: type[Message], data: bytes) -> Message | None:
        """Decodes a message. If it is not a valid one of this run, counts why and returns None."""
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
        """Handles the messages that have arrived, at most QUEUE_CAPACITY; returns their number.

        Waits at most `timeout` s for the first one; a signal ends the wait early. Raises the first
        exception of a handler.
        """
        handled, wait_ms = 0, int(timeout * 1000)
        while handled < QUEUE_CAPACITY:
            try:
                if self._lcm.handle_timeout(wait_ms) <= 0:
                    break
            except OSError:  # LCM's report of an interrupting signal or any other error
                self.counters["bus.interrupted"] += 1
                break
            handled, wait_ms = handled + 1, 0
            if self._failure is not None:
                failure, self._failure = self._failure, None
                raise failure
        return handled
