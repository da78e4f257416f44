"""Checks whether multicast, which LCM needs, works on this machine."""

from __future__ import annotations

import re
import secrets
import socket
import struct

_FIX = "sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo"
_WAIT = 1.0  # [s], at most, for the datagram to come back


def _echo(group: str) -> str | None:
    token = secrets.token_bytes(16)
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender,
    ):
        receiver.bind(("", 0))
        membership = struct.pack("4sI", socket.inet_aton(group), socket.INADDR_ANY)
        receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
        receiver.settimeout(_WAIT)
        sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        sender.sendto(token, (group, receiver.getsockname()[1]))
        try:
            while receiver.recv(64) != token:
                pass
        except TimeoutError:
            return "what is sent does not come back"
    return None


def defect(url: str) -> str | None:
    """Tests multicast: returns why messages on the bus at `url` do not arrive, and a remedy.

    Returns None if they arrive. The test sends one datagram to the multicast group of `url`, at a
    free port. Like LCM, it uses ttl 0 and the interface from the routing table.
    """
    match = re.match(r"udpm://([\d.]+):\d+", url)
    if match is None:
        return f"{url} is for one process only; run.bus = udpm://… is for several"
    try:
        why = _echo(match.group(1))
    except OSError as error:
        why = (error.strerror or str(error)).lower()
    return f"multicast to {match.group(1)}: {why}. To mend it: {_FIX}" if why else None
