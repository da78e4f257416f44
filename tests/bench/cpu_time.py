"""Tells how much processor time the programs take that a benchmark starts."""

from __future__ import annotations

import os


def of_children() -> float:
    """Returns the CPU time of this process's children that have ended, and of theirs [s]."""
    times = os.times()
    return times.children_user + times.children_system
