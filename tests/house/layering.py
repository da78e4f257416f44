"""Tells who may include whom: the architecture's arrows, read from the include and import lines."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).resolve().parents[2]

_OF_PROGRAMS = {"core", "nodes/files", "nodes/bus", "nodes/config", "nodes/jobs", "nodes/program"}
MAY_INCLUDE = {
    "core/math": {"core/math"},
    "core/world": {"core/math", "core/world"},
    "core/energy": {"core/math", "core/world", "core/energy"},
    "core/forward": {"core/math", "core/world", "core/energy", "core/forward"},
    "core/reverse/problem": {"core/math", "core/world", "core/energy", "core/reverse/problem"},
    "core/reverse/sqp": {
        "core/math",
        "core/world",
        "core/energy",
        "core/reverse/problem",
        "core/reverse/sqp",
    },
    "core/reverse": {"core/math", "core/world", "core/energy", "core/reverse"},
    "core/learn": {"core/learn", "core/threads"},
    "core/tasks": {"core/math", "core/world", "core/tasks"},
    "core/search": {"core"},
    "core/threads": {"core/threads"},
    "nodes/files": {"nodes/files"},
    "nodes/journal": {"nodes/files", "nodes/journal"},
    "nodes/bus": {"core/threads", "nodes/files", "nodes/bus", "rtg_msgs"},
    "nodes/config": {"core", "nodes/files", "nodes/bus", "nodes/config"},
    "nodes/jobs": {"core", "nodes/bus", "nodes/journal", "nodes/jobs", "rtg_msgs"},
    "nodes/stream": {"core/search", "nodes/bus", "nodes/stream"},
    "nodes/program": {"core", "nodes/bus", "nodes/config", "nodes/jobs", "nodes/program"},
    "nodes/beam_coordinator": {
        *_OF_PROGRAMS,
        "rtg_msgs",
        "nodes/stream",
        "nodes/beam_coordinator",
    },
    "nodes/forward_sim_server": _OF_PROGRAMS,
    "nodes/reverse_worker": _OF_PROGRAMS,
    "msgs": {"rtg_msgs"},
    # The bindings take the resolved config, so that C++ and Python never read YAML apart.
    "train": {
        "core",
        "nodes/bus",
        "nodes/config",
        "nodes/jobs",
        "nodes/program",
        "nodes/stream",
        "train/bindings",
        "rtg_msgs",
    },
    "tests": {"core", "nodes", "tests", "rtg_msgs"},
}

# Third-party headers by their first path component or name -> the files that may include them.
ONLY_IN = {
    r"(umfpack|cholmod|klu|SuiteSparse|amd|colamd)\w*\.h|suitesparse/.*": (
        r"core/math/\w+\.cpp|tests/bench/kkt_peers\.cpp"
    ),
    r"(hpipm|blasfeo)\w*\.h": r"tests/bench/hpipm_peer\.cpp",
    r"box2d/.*": r"(tests/)?core/forward/box2d_\w+\.cpp|tests/consumer/main\.cpp",
    r"sleef\.h": r"core/math/elementary\.cpp",
    r"geos_c\.h": r"core/world/outline\.cpp",
    r"(yaml-cpp|utf8cpp)/.*": r"nodes/config/\w+\.cpp",
    r"lcm/.*": r"nodes/bus/network\.cpp",
    r"sodium\.h": r"nodes/(bus/(network|run_key)\.cpp|files/sha256\.(cpp|hpp))",
    r"nlohmann/.*": r"(core/search|nodes|train|tests/bench)/.*\.cpp",
    r"nanobind/.*": r"train/.*\.(cpp|hpp)",
    r"gtest/.*|gmock/.*": r"tests/.*\.(cpp|hpp)",
    r"benchmark/.*": r"tests/bench/.*\.(cpp|hpp)",
    r"Eigen/.*|unsupported/Eigen/.*": r"(core|nodes|train|tests)/.*",
    # POSIX belongs to the processes.
    r"(sys|netinet|arpa|net)/.*|fcntl\.h|unistd\.h|pthread\.h": r"(nodes|tests|train)/.*",
}

# Rooms of the Python package -> the rooms below, from which they may import; all may import `ROOF`.
ROOMS = {
    "engines": set(),
    "files": {"engines"},
    "processes": set(),
    "bus": {"files"},
    "pictures": {"files"},
    "envs": {"engines", "pictures"},
    "learn": {"engines", "files", "processes", "bus", "envs"},
    "run": {"engines", "files", "processes", "bus", "pictures", "learn"},
    "compare": {"files", "processes", "pictures", "learn", "run"},
    "view": {"files", "processes", "bus", "pictures", "run"},
    "export": {"files", "processes", "pictures", "envs", "run"},
}
ROOF = {"arguments", "errors", "extras", "paths", "task_config", "_core"}  # modules of rtg itself

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
IMPORT_LCM = re.compile(r"^\s*(?:import\s+lcm\b|from\s+lcm\b)", re.MULTILINE)


def is_ours(header: str) -> bool:
    return header.split("/")[0] in {"core", "nodes", "msgs", "rtg_msgs", "tests", "train"}


def is_standard(header: str) -> bool:
    """Tells headers of the C++ standard library and C headers without a folder from all others."""
    return "/" not in header and not any(re.fullmatch(third, header) for third in ONLY_IN)


def layer(path: str) -> str:
    """The longest prefix of `path` that has a rule."""
    fits = [name for name in MAY_INCLUDE if path.startswith(name + "/")]
    return max(fits, key=len, default="")


def fault(path: str, header: str) -> str:
    """Returns what is wrong with `path` including `header`; empty when nothing is."""
    if is_ours(header):
        allowed = MAY_INCLUDE.get(layer(path), set())
        folder = str(PurePosixPath(header).parent)
        if any(folder == name or folder.startswith(name + "/") for name in allowed):
            return ""
        return f"{path}: may not include {header}"
    if is_standard(header) or header.startswith("experimental/"):
        return ""
    for third_party, places in ONLY_IN.items():
        if re.fullmatch(third_party, header):
            ok = re.fullmatch(places, path)
            return "" if ok else f"{path}: {header} belongs in {places} alone"
    return f"{path}: {header} is of no library that this project uses"


def imports(text: str) -> Iterator[str]:
    """Modules of ours that a Python source imports, dotted."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
            yield from ("rtg.all" if name == "rtg" else name for name in names if "rtg" in name)
        elif isinstance(node, ast.ImportFrom) and node.level > 0:
            yield "rtg.relative"
        elif isinstance(node, ast.ImportFrom) and node.module == "rtg":
            yield from (f"rtg.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("rtg."):
            yield node.module


def python_faults(path: str, text: str) -> list[str]:
    """Lists what is wrong with what the module at `path` imports."""
    found = []
    if IMPORT_LCM.search(text) and path != "train/rtg/bus/bus.py":
        found.append(f"{path}: import lcm belongs in train/rtg/bus/bus.py alone")
    parts = PurePosixPath(path).parts
    if parts[:2] != ("train", "rtg"):
        return found
    room = parts[2].removesuffix(".py")
    if len(parts) == 3 and room not in ROOF:  # above all rooms
        return found
    if room == "examples":  # programs as a user writes them
        wrong = [module for module in imports(text) if module != "rtg.all"]
        return [*found, *(f"{path}: may not import {module}" for module in wrong)]
    if len(parts) > 3 and room not in ROOMS:
        return [*found, f"{path}: {room} is no room of the package"]
    allowed = {room, *ROOMS.get(room, set()), *ROOF}
    wrong = [module for module in imports(text) if module.split(".", 2)[1] not in allowed]
    return found + [f"{path}: may not import {module}" for module in wrong]


def violations(files: dict[str, str]) -> list[str]:
    """All faults of `files`, a map of repository path to text."""
    found = []
    for path, text in sorted(files.items()):
        if path.endswith(".py"):
            found += python_faults(path, text)
            continue
        found += [message for header in INCLUDE.findall(text) if (message := fault(path, header))]
    return found


def sources(*suffixes: str) -> Iterator[Path]:
    """Our own sources with one of the suffixes."""
    for folder in ("core", "nodes", "msgs", "train", "tests"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in suffixes and "build" not in path.relative_to(ROOT).parts:
                yield path
