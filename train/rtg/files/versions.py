"""Versions of the programs that made a run, as versions.json in its folder stores them."""

from __future__ import annotations

import functools
import hashlib
import importlib.metadata
import os
import platform
import shutil
import subprocess
from pathlib import Path
from typing import Any

from rtg import _core, paths
from rtg.errors import UserError
from rtg.files import run_folder

FILE = "versions.json"
ENGINE_KEY = "forward_engine"
_REVISION_KEYS = ("git_revision", "git_modified")
_PYTHON_PACKAGES = ("torch", "gymnasium", "numpy", "lcm")
_DEBIAN_PACKAGES = (
    "g++",
    "libeigen3-dev",
    "libsuitesparse-dev",
    "libbox2d-dev",
    "libgeos-dev",
    "libsleef-dev",
    "libyaml-cpp-dev",
)


def _command_output(*command: str) -> str | None:
    if shutil.which(command[0]) is None:
        return None
    done = subprocess.run(command, cwd=paths.ROOT, capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else None


def _debian_version(package: str) -> str | None:
    return _command_output("dpkg-query", "-W", "-f=${Version}", package)


def _processor() -> str | None:
    """Returns the model name of the processor from /proc/cpuinfo; None if the file lacks it."""
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else None


def _revision() -> tuple[str | None, bool | None]:
    """Returns the checked-out commit and whether files differ from it; None without git."""
    # docs/results/ is left out: the runs of the committed report are made there.
    changes = _command_output(
        "git", "status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs/results"
    )
    return _command_output("git", "rev-parse", "HEAD"), None if changes is None else bool(changes)


def core_digest() -> str:
    """Returns the SHA-256 of the compiled core. Equal cores generate equal transitions."""
    return digest(Path(_core.__file__))


def digest(path: Path) -> str:
    """Returns the SHA-256 of a file, in hexadecimal digits."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


@functools.cache
def this_commit() -> str | None:
    """Returns the commit of this program as at the first call, in the form of commit()."""
    return commit(dict(zip(_REVISION_KEYS, _revision(), strict=True)))


def seal(path: Path) -> None:
    """Adds the digest of `path`, a finished transition set, to the versions.json beside it.

    From then on dataset.read() refuses the file if it was changed. Raises UserError if
    versions.json is damaged.
    """
    run = path.parent
    made_by = {**generator(run), "sha256": {path.name: digest(path)}}
    run_folder.write_json(run / FILE, {**run_folder.read_json(run / FILE), "generator": made_by})


def sealed_digest(path: Path) -> str | None:
    """Returns the digest of `path` that the versions.json beside it has; None without a seal."""
    found = generator(path.parent).get("sha256")
    return found.get(path.name) if isinstance(found, dict) else None


def check_seal(path: Path) -> None:
    """Raises UserError if `path` differs from the file that was sealed; nothing without a seal."""
    sealed = sealed_digest(path)
    if sealed is not None and path.is_file() and digest(path) != sealed:
        raise UserError(
            f"{path}: was changed since the run wrote it, as its SHA-256 is not that in {FILE}; "
            "legal: the file as the run wrote it, or no file, to generate anew"
        )


def check_engine(run: Path, engine: str) -> None:
    """Raises UserError if another forward simulator than `engine` has worked on the run.

    `engine`: engines.identity(), as in the other functions.
    """
    file = run / FILE
    before = run_folder.read_json(file).get(ENGINE_KEY)
    if before not in (None, engine):
        raise UserError(
            f"{file}: the run was begun with the forward simulator {before}, and this is {engine}; "
            f"legal: {before}, or a new run"
        )


def generator(run: Path) -> dict[str, Any]:
    """Returns the versions of the program that generated the transitions of the run.

    Returns {} if versions.json lacks them. Raises UserError if versions.json is damaged.
    """
    found = run_folder.read_json(run / FILE).get("generator")
    return found if isinstance(found, dict) else {}


def engine_of_data(run: Path) -> str | None:
    """Returns the forward simulator that the transitions of a run are of; None if it is unknown.

    Those of a run with --data are of the run that they were taken from.
    """
    made_by = generator(run)
    data = made_by.get("data")
    found = made_by.get(ENGINE_KEY) or (data.get(ENGINE_KEY) if isinstance(data, dict) else None)
    return found if isinstance(found, str) else None


def versions(engine: str | None) -> dict[str, Any]:
    """Returns the versions of this program and its machine, beside that of the forward simulator.

    None stands where a value is unknown.
    """
    return {
        **dict(zip(_REVISION_KEYS, _revision(), strict=True)),
        "python": platform.python_version(),
        "system": platform.platform(),
        "processors": os.cpu_count(),
        "processor": _processor(),
        "instruction_set": _core.PROCESSOR,
        "memory_gib": round(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 2**30),
        ENGINE_KEY: engine,
        "packages": {name: importlib.metadata.version(name) for name in _PYTHON_PACKAGES},
        "debian": {name: _debian_version(name) for name in _DEBIAN_PACKAGES},
    }


def write(run: Path, engine: str | None, made_by: dict[str, Any] | None = None) -> None:
    """Writes versions.json of a run that this program begins or resumes. The file holds:

    - the versions of this program;
    - the other commits that worked on the run before;
    - the versions of the generator of its transitions: `made_by`, or this program if None.

    Raises UserError if the previous versions.json is damaged.
    """
    found, before = versions(engine), run_folder.read_json(run / FILE)
    if made_by is None:
        made_by = {key: found[key] for key in (*_REVISION_KEYS, ENGINE_KEY)}
        made_by["core_sha256"] = core_digest()
    begun_by, last = before.get("begun_by", []), commit(before)
    if last not in (None, commit(found)):
        begun_by = [*begun_by, last]
    run_folder.write_json(run / FILE, {**found, "begun_by": begun_by, "generator": made_by})


def commit(made_with: dict[str, Any]) -> str | None:
    """Returns the commit in `made_with`, the content of a versions.json; None if unknown.

    It has the suffix -modified if files differed from the commit.
    """
    revision = made_with.get("git_revision")
    return f"{revision}-modified" if made_with.get("git_modified") else revision
