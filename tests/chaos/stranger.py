"""A process without the key of a run that sends what might harm it: CONFIG.yaml NAME RATE.

Half of it are forged messages of all types: the run's name, the right channel and type, another
key. The other half are datagrams that are no messages. Prints that it sends, and at SIGTERM how
many of each these were.
"""

from __future__ import annotations

import random
import re
import signal
import socket
import struct
import sys
import threading
import time
from pathlib import Path

from rtg import _core

CHANNELS = Path(__file__).resolve().parents[2] / "msgs" / "CHANNELS.md"
LARGE = {"count": 10**15, "leaving": 1, "capacity": 2**31 - 1, "cursor": 10**15, "sealed": 1}


def types() -> dict[str, str]:
    """Returns the type of each channel."""
    rows = re.findall(r"^\| `(RTG_\w+)` \| `(\w+_t)`", CHANNELS.read_text(), re.MULTILINE)
    return dict(rows)


def malformed(rng: random.Random) -> bytes:
    """Returns the bytes of a datagram that is no message of a run."""
    channel = rng.choice([*types(), "OTHER", "x" * 62, "\x1b[2J"]).encode()
    payload = rng.randbytes(rng.choice([0, 1, 7, 40, 3000]))
    head = b"LC02" + struct.pack(">I", rng.getrandbits(32))
    kinds = (
        rng.randbytes(rng.randrange(60)),
        head + channel,  # no NUL behind the channel, no payload
        head + channel + b"\0" + payload,
        head + b"y" * 200 + b"\0" + payload,
        head + b"\xff\xfe\0" + payload,
        b"LC03" + rng.randbytes(16) + channel + b"\0" + payload,  # a fragment
        b"LC03" + struct.pack(">IIIHH", 7, 2**28, 0, 0, 2**16 - 1) + channel + b"\0" + payload,
        head[: rng.randrange(8)],
    )
    return rng.choice(kinds)


def forge(bus: _core.Bus, rng: random.Random) -> None:
    """Sends a message as a process of the run would, but for its key."""
    channel, kind = rng.choice(list(types().items()))
    try:
        name, value = rng.choice(list(LARGE.items()))
        bus.publish(channel, kind, **{name: value})
    except TypeError:  # no field of this type
        bus.publish(channel, kind)


def main(config: str, name: str, rate: float) -> None:
    url, rng = _core.Config.from_file(Path(config)).run.bus, random.Random(1)
    bus = _core.Bus(url, _core.RunKey.random(name))
    group, port = re.match(r"udpm://([\d.]+):(\d+)", url).groups()
    raw = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    raw.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
    stop = threading.Event()
    signal.signal(signal.SIGTERM, lambda number, frame: stop.set())
    print("sends", flush=True)
    begin, sent = time.monotonic(), 0
    while not stop.wait(0.002):
        while sent < (time.monotonic() - begin) * rate and not stop.is_set():
            if sent % 2:
                forge(bus, rng)
            else:
                raw.sendto(malformed(rng), (group, int(port)))
            sent += 1
    print(sent // 2, sent - sent // 2)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], float(sys.argv[3]))
