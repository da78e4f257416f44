"""Ids, sizes and observations of the environments, read from the package."""

from __future__ import annotations

import rtg
from tables import table


def ids() -> str:
    """Returns a table of the ids."""
    rows = []
    for id, (name, horizon) in rtg.ENVIRONMENTS.items():
        task = rtg.load_task(name)
        size = len(task.observation_names)
        rows.append([f"`{id}`", f"`{name}`", str(horizon), str(task.actions), str(size)])
    return table(["id", "task", "horizon", "actions", "entries of an observation"], rows)


def _unit(entry: str) -> str:
    if entry.split()[-1] in ("sin", "cos", "theta"):
        return "1"
    return "half a stride" if entry.endswith(("to robot", "slide")) else "half of `push.arena`"


def observations() -> str:
    """Returns a table of the entries of each task's observations, folded."""
    parts = []
    for name, _ in rtg.ENVIRONMENTS.values():
        entries = rtg.load_task(name).observation_names
        rows = [[str(k), entry, _unit(entry)] for k, entry in enumerate(entries)]
        lines = [f"    {line}" for line in table(["index", "entry", "unit"], rows).splitlines()]
        parts.append("\n".join([f'??? note "{name}: {len(entries)} entries"', "", *lines]))
    return "\n\n".join(parts) + "\n"
