"""Records the transitions of a run, if there is no trainer: the recorder of graph.sh.

`python -m rtg.bus.record CONFIG.yaml KEY FILE.npz` receives all transitions of the run whose key
file is KEY and writes them to FILE.npz, and its digest to the versions.json beside it. Prints how
many it has when some have arrived.
"""

from __future__ import annotations

import sys
from pathlib import Path

from rtg import _core
from rtg.bus.bus import open_bus, read_key
from rtg.bus.transition_stream import TransitionStream
from rtg.errors import UserError, exit_status
from rtg.files.recorder import Recorder

_POLL = 0.1  # [s]


def _say(words: str) -> None:
    print(f"recorder: {words}", flush=True)


def record(config: _core.Config, key: _core.RunKey, file: Path) -> None:
    """Waits for the end of the run's transitions and writes them to `file`.

    Raises RunError if the coordinator begins another generation, UserError if there is no folder
    for the file or `file` is a folder.
    """
    if file.is_dir():
        raise UserError(f"{file}: is a folder; legal: a file in a folder that exists")
    if not file.parent.is_dir():
        raise UserError(f"{file.parent}: no such folder; legal: a file in a folder that exists")
    bus = open_bus(config.run.bus, key)
    if bus.warning:
        _say(bus.warning)
    _say(f"waits for the transitions of run {key.name}")
    recorder = Recorder(config)
    task, most = config.task, config.search.transitions
    stream = TransitionStream(bus, task.bodies, task.actions, most, recorder.add)
    while not stream.complete:
        if stream.poll(_POLL):
            _say(f"has {stream.received} transitions")
    recorder.finish(file)
    stream.close()
    _say(f"ends with {stream.received} transitions")


def _main(argv: list[str]) -> int:
    if len(argv) != 3:
        raise UserError("legal words: CONFIG.yaml KEY FILE.npz")
    record(_core.Config.from_file(Path(argv[0])), read_key(Path(argv[1])), Path(argv[2]))
    return 0


def main(argv: list[str]) -> int:
    return exit_status("rtg.bus.record", lambda: _main(argv))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
