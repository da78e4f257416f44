"""Packages that only some commands need: the extras of pyproject.toml."""

from __future__ import annotations

import importlib
import sys
import tomllib
from importlib.util import find_spec
from typing import Any

from rtg import paths
from rtg.errors import UserError


def require(module: str, extra: str, what: str) -> None:
    """Raises UserError if a module of an extra is missing. Does not import it.

    `what`: that which asks for it, in words.
    """
    if find_spec(module) is None:
        raise _missing(module, extra, what)


def imported(module: str, extra: str, what: str) -> Any:
    """Imports a module of an extra. Raises UserError if it, or what it imports, is missing."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        raise _missing(error.name or module, extra, what) from None


def _missing(module: str, extra: str, what: str) -> UserError:
    wanted = " ".join(f"'{requirement}'" for requirement in _requirements(extra))
    return UserError(
        f"{what} needs the Python package {module.partition('.')[0]}, which is not installed; "
        f"legal: after {sys.executable} -m pip install {wanted}"
    )


def _requirements(extra: str) -> list[str]:
    """Returns what pip is to install: a checkout is not in its environment as a distribution."""
    if not paths.IN_CHECKOUT:
        return [f"{paths.DISTRIBUTION}[{extra}]"]
    project = tomllib.loads((paths.ROOT / "pyproject.toml").read_text())["project"]
    return list(project["optional-dependencies"][extra])
