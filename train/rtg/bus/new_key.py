"""Makes the key of a run that is started by hand.

`python -m rtg.bus.new_key FILE NAME` writes a new key for the run of that name to FILE, which its
owner alone can read. All programs of the run are given FILE.
"""

from __future__ import annotations

import sys
from pathlib import Path

from rtg.bus.bus import new_key
from rtg.errors import UserError, exit_status


def _main(argv: list[str]) -> int:
    if len(argv) != 2 or not argv[1]:
        raise UserError("legal words: FILE NAME")
    new_key(Path(argv[0]), argv[1])
    return 0


def main(argv: list[str]) -> int:
    return exit_status("rtg.bus.new_key", lambda: _main(argv))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
