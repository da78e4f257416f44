"""Handling of stop signals: the first one requests a stop, the second one ends the process."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any, Self

from rtg.errors import StoppedError

_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Interrupts:
    """A context manager that handles SIGINT, SIGTERM and SIGHUP.

    It stores the number of the first signal in `number`. At a second signal it calls
    `on_second_signal` and ends this process at once, with exit status 128 + signal number. SIGHUP
    is never the second one: of a terminal that closes it comes twice, from the shell and from the
    kernel. It stays ignored if the process ignored it before, as under nohup. Main thread only.
    """

    def __init__(self, on_second_signal: Callable[[], None] = lambda: None) -> None:
        self.number = 0  # number of the first signal; 0: none yet
        self._on_second_signal = on_second_signal
        self._previous_handlers: dict[int, Any] = {}

    def __enter__(self) -> Self:
        ignored = [signal.SIGHUP] * (signal.getsignal(signal.SIGHUP) is signal.SIG_IGN)
        handled = [number for number in _SIGNALS if number not in ignored]
        self._previous_handlers = {
            number: signal.signal(number, self._handle) for number in handled
        }
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for number, handler in self._previous_handlers.items():
            signal.signal(number, handler)

    def requested(self) -> bool:
        """Returns whether a signal has arrived."""
        return self.number != 0

    def raise_if_requested(self) -> None:
        """Raises StoppedError after the first signal."""
        if self.requested():
            raise StoppedError

    def _handle(self, number: int, frame: FrameType | None) -> None:
        if not self.requested():
            self.number = number
        elif number != signal.SIGHUP:
            self._on_second_signal()
            os._exit(128 + number)
