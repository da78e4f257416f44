"""A consumer of the transition stream: CONFIG.yaml RUN FILE.npz [RECEIVE_BUFFER].

Says how many rows it has whenever some have come, and how many it lacks at the end.
"""

import sys
from pathlib import Path

from rtg import _core
from rtg.bus import bus
from rtg.bus.transition_stream import TransitionStream
from rtg.files.recorder import Recorder


def main(config_file: str, run: str, target: str, *receive_buffer: str) -> None:
    for size in receive_buffer:
        bus.RECEIVE_BUFFER = int(size)  # [bytes]
    config = _core.Config.from_file(config_file)
    task = config.task
    recorder = Recorder(task)
    url = config.run.bus
    stream = TransitionStream(bus.Bus(url, run), task.bodies, task.headings, recorder.add)
    while not stream.complete:
        if stream.poll(0.1):
            print(stream.received, flush=True)
    recorder.write(Path(target))
    print(f"lost {stream.lost}", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
