"""Programs that tests run: one that hangs fails its test."""

import os
import subprocess
from pathlib import Path
from typing import Any

PATIENCE = 600.0  # [s] until a program counts as hanging
_TRAIN = Path(__file__).resolve().parents[2] / "train"


def run(*command: str | bytes | Path, **options: Any) -> subprocess.CompletedProcess[str]:
    """Runs a program to its end and returns its status and output.

    Python finds the package of this checkout first. `options`: of subprocess.run(), also other than
    usual.
    """
    usual: dict[str, Any] = {
        "env": {**os.environ, "PYTHONPATH": str(_TRAIN)},
        "stdout": subprocess.PIPE,
        "stderr": subprocess.PIPE,
        "text": True,
        "timeout": PATIENCE,
    }
    return subprocess.run(command, **{**usual, **options})
