"""A network of its own, in which messages can be lost, and processes in it."""

from __future__ import annotations

import os
import re
import signal
import subprocess
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

import pytest
from time_limit import PATIENCE, run

_MULTICAST = "ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo"
_PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"
_SOME = "meta l4proto udp numgen random mod 100 lt {percent}"
_LOSS = """
add table ip loss
add chain ip loss incoming {{ type filter hook input priority 0; }}
add rule ip loss incoming {some} counter drop
"""
_TWICE = """
add table ip twice
add chain ip twice incoming {{ type filter hook input priority 0; }}
add rule ip twice incoming {some} counter dup to 127.0.0.1 device lo
"""


def defect() -> str | None:
    """Returns why there can be no such network here; None if there can."""
    command = ["unshare", "-rn", "sh", "-c", _MULTICAST]
    done = run(*command, env={"PATH": _PATH})
    return done.stderr.strip() if done.returncode else None


def require() -> None:
    """Skips the test where there can be no such network; on CI, where no one sees that, fails."""
    if why := defect():
        words = f"no network namespaces here: {why}"
        if os.environ.get("CI") == "true":
            pytest.fail(f"{words}; with CI=true in the environment the system tests must not skip")
        pytest.skip(words)


class Network:
    """A network namespace with nothing but a loopback device; takes its processes with it."""

    def __init__(self) -> None:
        script = f"{_MULTICAST} && echo ready && exec sleep infinity"
        self._holder = subprocess.Popen(
            ["unshare", "-rn", "sh", "-c", script], stdout=subprocess.PIPE, text=True
        )
        assert self._holder.stdout is not None
        assert self._holder.stdout.readline() == "ready\n"
        self._processes = [self._holder]

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for process in self._processes:
            if process.poll() is None:
                process.send_signal(signal.SIGKILL)
            process.wait(PATIENCE)
            if process.stdout:
                process.stdout.close()

    def _inside(self, command: Sequence[str | Path]) -> list[str]:
        enter = ["nsenter", "--preserve-credentials", "-U", "-n", "-t", str(self._holder.pid)]
        return [*enter, *map(str, command)]

    def start(self, command: Sequence[str | Path], **options: str) -> subprocess.Popen[str]:
        """Starts a process whose output can be read; its id is the program's own."""
        process = subprocess.Popen(
            self._inside(command),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, **options},
        )
        self._processes.append(process)
        return process

    def dropped(self) -> int:
        """Datagrams for which the receive buffer of some socket had no room so far."""
        table = run(*self._inside(["cat", "/proc/net/udp"]), check=True)
        return sum(int(line.split()[-1]) for line in table.stdout.splitlines()[1:])

    def _nft(self, *arguments: str, rules: str = "") -> str:
        command = self._inside(["nft", *arguments])
        done = run(*command, input=rules, env={"PATH": _PATH})
        assert done.returncode == 0, done.stderr
        return done.stdout

    def lose(self, percent: int) -> None:
        """From now on every datagram is lost with that probability."""
        self._nft("-f", "-", rules=_LOSS.format(some=_SOME.format(percent=percent)))

    def double(self, percent: int) -> None:
        """From now on every datagram comes twice with that probability."""
        self._nft("-f", "-", rules=_TWICE.format(some=_SOME.format(percent=percent)))

    def lost(self) -> int:
        """Datagrams lost so far."""
        return self._count("loss")

    def doubled(self) -> int:
        """Datagrams doubled so far."""
        return self._count("twice")

    def _count(self, table: str) -> int:
        count = re.search(r"packets (\d+)", self._nft("list", "table", "ip", table))
        assert count is not None
        return int(count.group(1))
