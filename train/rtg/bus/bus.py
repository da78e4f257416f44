"""Opens the bus of a run: the C++ class that checks all messages, of which `_core.Bus` is the door.

Messages are objects whose attributes are the fields of their .lcm file; see `_core.Bus`.
"""

from __future__ import annotations

from pathlib import Path

from rtg import _core
from rtg.errors import RunError, UserError


def open_bus(url: str, key: _core.RunKey) -> _core.Bus:
    """Returns the bus of the run of that key.

    `url`: udpm://GROUP:PORT[?ttl=N][&peers=ADDRESS,...], or memq:// within one object, for tests.
    Raises RunError if the network cannot be opened.
    """
    try:
        return _core.Bus(url, key)
    except RuntimeError as error:
        raise RunError(str(error)) from error


def listen(url: str, run: str) -> _core.Bus:
    """Returns a bus that hears what claims to be of the run named `run`, and sends nothing.

    Raises RunError if the network cannot be opened.
    """
    try:
        return _core.Bus.listener(url, run)
    except RuntimeError as error:
        raise RunError(str(error)) from error


def read_key(file: Path) -> _core.RunKey:
    """Reads the key file of a run. Raises UserError if it is none, or open to other users."""
    try:
        return _core.RunKey.read(file)
    except ValueError as error:
        raise UserError(str(error)) from error


def new_key(file: Path, name: str) -> _core.RunKey:
    """Draws a key for the run of that name and writes it to `file`, which its owner alone can read.

    Raises RunError if the file cannot be written.
    """
    key = _core.RunKey.random(name)
    try:
        key.write(file)
    except RuntimeError as error:
        raise RunError(str(error)) from error
    return key


def defect(url: str) -> str | None:
    """Returns why the programs of a run cannot speak over the bus at `url`, and a remedy.

    Returns None if they can. It sends a datagram that no program listens to.
    """
    if not url.startswith("udpm:"):
        return f"{url} is for one process only; run.bus = udpm://… is for several"
    try:
        _core.BusMonitor(url)
    except RuntimeError as error:
        return str(error).removeprefix("bus: ")
    return None
