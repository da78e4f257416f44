"""The program that answers replay jobs by an engine of Python, as rtg_forward_sim_server does.

python -m rtg.engines.server CONFIG.yaml KEY
"""

from __future__ import annotations

import sys
from pathlib import Path

from rtg import _core
from rtg.engines.engine import EngineError, simulator
from rtg.errors import exit_status

ENGINE_FAILED = 4  # exit status: to start the server again would not help


def _serve() -> int:
    config, key = map(Path, sys.argv[1:])
    try:
        return _core.serve_replays(config, key, simulator(_core.Config.from_file(config)).push)
    except EngineError as error:
        print(error, file=sys.stderr)
        return ENGINE_FAILED


if __name__ == "__main__":
    sys.exit(exit_status("forward_sim_server", _serve))
