"""The keys of the configuration, and what presets and methods set, read from the loader."""

from __future__ import annotations

import re
from typing import NamedTuple

from rtg import _core, paths
from tables import table

_SECTION = re.compile(r"(\w+):$")
_KEY = re.compile(r"( +)(\w+): ?(.*?)(?: {1,2}# (.*))?$")
_REFERENCE = "ddqn_rtg"
_OF_PROCESSES = {"run.workers": "0"}  # the loader puts the number of cores in its place


class Key(NamedTuple):
    """A key with its value in a configuration."""

    section: str
    name: str  # with dots where it is nested: "push.headings"
    value: str
    legal: str
    meaning: str


def _config(*settings: str) -> _core.Config:
    """Returns the defaults, with the task of Gathering."""
    return _core.Config.from_text(
        "task: gathering.yaml", str(paths.CONFIG / "reference.yaml"), list(settings)
    )


def _parts(value: str, comment: str) -> tuple[str, str]:
    """Returns the meaning and the legal values that a comment of the loader tells of a key."""
    if value in ("true", "false"):
        return comment, "true, false"
    if value.startswith('"'):
        return comment, "text"
    meaning, _, legal = comment.rpartition("; ")
    return (meaning, legal) if meaning else (comment, "")


def keys(text: str) -> list[Key]:
    """Returns the keys with one value that the canonical YAML text of a configuration explains."""
    found, section, above = [], "", ""
    for line in text.splitlines():
        if match := _SECTION.match(line):
            section = match[1]
        elif match := _KEY.match(line):
            indent, name, value, comment = match.groups(default="")
            if len(indent) == 2:
                above = name
            elif len(indent) == 4:
                name = f"{above}.{name}"
            if value and comment:
                meaning, legal = _parts(value, comment)
                value = _OF_PROCESSES.get(f"{section}.{name}", value)
                found.append(Key(section, name, value, legal, meaning))
    return found


def _values(config: _core.Config) -> dict[tuple[str, str], str]:
    return {(key.section, key.name): key.value for key in keys(config.yaml)}


def _code(text: str) -> str:
    return f"`{text}`" if text else ""


def _section(section: str, of_it: list[Key], paper: dict[tuple[str, str], str]) -> str:
    default = "in Gathering" if section == "task" else "default"
    rows = []
    for key in of_it:
        printed = paper[section, key.name]
        row = [_code(key.name), _code(key.value)]
        row.append(_code(printed) if printed != key.value and key.name != "workers" else "")
        rows.append([*row, key.legal, key.meaning])
    head = ["key", default, "paper", "legal", "meaning"]
    if section not in ("reverse", "train"):
        head.remove("paper")
        rows = [[*row[:2], *row[3:]] for row in rows]
    return f"## `{section}`\n\n{table(head, rows)}"


def reference() -> str:
    """Returns a table of keys for each section."""
    found = keys(_config().yaml)
    paper = _values(_config("reverse.preset=paper", "train.preset=paper"))
    sections = dict.fromkeys(key.section for key in found)
    return "\n".join(
        _section(name, [key for key in found if key.section == name], paper) for name in sections
    )


def methods() -> str:
    """Returns a table of the settings of each method that differ from those of the default one."""
    reference = _values(_config(f"run.method={_REFERENCE}"))
    rows = []
    for method in _core.METHODS:
        values = _values(_config(f"run.method={method}"))
        settings = [
            f"`{section}.{name}={value}`"
            for (section, name), value in values.items()
            if value != reference[section, name] and (section, name) != ("run", "method")
        ]
        rows.append([f"`{method}`", ", ".join(settings)])
    return table(["method", "settings"], rows)
