"""The recorder with a receive buffer of another size: CONFIG.yaml KEY FILE.npz [RECEIVE_BUFFER]."""

import os
import socket
import stat
import sys

from rtg.bus import record

_open_bus = record.open_bus


def shrink(size):
    """Gives the sockets of this process receive buffers of `size` bytes."""
    for number in map(int, os.listdir("/proc/self/fd")):
        try:
            if not stat.S_ISSOCK(os.fstat(number).st_mode):
                continue
        except OSError:  # that of the listing itself, closed again
            continue
        with socket.socket(fileno=os.dup(number)) as found:
            found.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, size)


def open_small(url, key, size):
    bus = _open_bus(url, key)
    shrink(size)
    return bus


if __name__ == "__main__":
    if len(sys.argv) > 4:
        size = int(sys.argv.pop())  # [bytes]
        record.open_bus = lambda url, key: open_small(url, key, size)
    sys.exit(record.main(sys.argv[1:]))
