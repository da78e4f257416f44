"""Packages that only some commands need: extras of pyproject.toml."""

from __future__ import annotations

import importlib
from typing import Any

from rtg.errors import UserError


def package(name: str, extra: str, what: str) -> Any:
    """Imports the package `name`. Raises UserError if it, or what it needs, is not installed.

    `extra`: that of pyproject.toml that has it; `what`: the feature that asks for it, in words.
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise UserError(
            f"{what} needs the package {error.name or name}, which is not installed; legal: after "
            f"pip install '.[{extra}]' in the folder of RTG"
        ) from None
