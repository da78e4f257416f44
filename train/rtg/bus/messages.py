"""The message types that lcm-gen generates from msgs/*.lcm, imported from the build folder."""

from __future__ import annotations

import importlib
import sys
from types import ModuleType
from typing import Any

from rtg import paths


def _generated() -> ModuleType:
    folder = str(paths.MESSAGES)
    if folder not in sys.path:
        sys.path.append(folder)  # the types import each other by absolute names
    return importlib.import_module("rtg_msgs")


_MODULE = _generated()
NAMES: list[str] = sorted(name for name in dir(_MODULE) if name.endswith("_t"))


def message_type(name: str) -> Any:
    """Returns the message class `name`. Raises AttributeError if there is none."""
    return getattr(_MODULE, name)


def type_of(data: bytes) -> Any | None:
    """Returns the class of the encoded message `data`, or None if it is no message of RTG.

    The first 8 bytes, LCM's fingerprint, identify the class.
    """
    return _BY_FINGERPRINT.get(data[:8])


_BY_FINGERPRINT: dict[bytes, Any] = {
    message_type(name)._get_packed_fingerprint(): message_type(name) for name in NAMES
}
