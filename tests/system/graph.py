"""The process graph on a network of its own."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

from network import Network
from rtg import _core, paths
from rtg.bus.bus import new_key
from rtg.files.dataset import Rows
from rtg.files.recorder import Recorder
from rtg.files.run_folder import JOURNAL_FILE, KEY_FILE
from rtg.run import effective_config
from rtg.run.run_args import Override

_TINY = paths.CONFIG / "tests" / "tiny.yaml"
RUN = "system-test"
_CONSUMER = Path(__file__).with_name("consumer.py")
_DEADLY_UNIT = Path(__file__).with_name("deadly_unit.py")
PATIENCE = 120.0  # [s] until a test that hangs fails

Process = subprocess.Popen[str]


class Graph:
    """The programs of one run; `overrides` as in --set."""

    def __init__(self, network: Network, folder: Path, *overrides: str, task: Path = _TINY) -> None:
        self.network, self.folder = network, folder
        self.config = folder / "config.yaml"
        given = [Override("", setting) for setting in overrides]
        self.config.write_text(effective_config.load(task, given).yaml)
        self.key = folder / KEY_FILE
        new_key(self.key, RUN)
        self.journal = folder / JOURNAL_FILE

    def _program(self, name: str, *words: str | Path) -> Process:
        return self.network.start([paths.BUILD / "nodes" / name, self.config, self.key, *words])

    def server(self) -> Process:
        return self._program("rtg_forward_sim_server")

    def worker(self, number: int) -> Process:
        return self._program("rtg_reverse_worker", str(number))

    def coordinator(self, consumers: int = 1) -> Process:
        return self._program("rtg_beam_coordinator", self.folder, str(consumers))

    def consumer(self, name: str = "transitions", *words: str) -> Process:
        file = self.folder / f"{name}.npz"
        return self._python(_CONSUMER, file, *words)

    def deadly_unit(self) -> Process:
        """Lets three workers in a row fall silent at the same unit, then ends."""
        return self._python(_DEADLY_UNIT)

    def _python(self, script: Path, *words: str | Path) -> Process:
        command = [sys.executable, script, self.config, self.key, *words]
        return self.network.start(command, PYTHONPATH=str(paths.ROOT / "train"))

    def transitions(self, name: str = "transitions") -> bytes:
        """Returns what the consumer of that name has written."""
        return (self.folder / f"{name}.npz").read_bytes()

    def is_generating(self) -> bool:
        return not (self.folder / "generation.json").exists()


def first_rows(consumer: Process) -> int:
    """Waits until the consumer has some rows; returns how many."""
    assert consumer.stdout is not None
    for line in consumer.stdout:
        if found := re.fullmatch(r"recorder: has (\d+) transitions\n", line):
            return int(found[1])
    raise AssertionError("the consumer ended without a row")


def finish(consumer: Process) -> None:
    """Waits for the recorder's end, which it says in its last line."""
    assert consumer.stdout is not None
    words = consumer.stdout.read().splitlines()
    assert consumer.wait(PATIENCE) == 0
    assert re.fullmatch(r"recorder: ends with \d+ transitions", words[-1])


def generated_in_process(file: Path, *overrides: str) -> bytes:
    """transitions.npz of the same run in this process, without LCM; written to `file`."""
    config = _core.Config.from_file(_TINY, overrides)
    recorder = Recorder(config)

    def store(poses, action, next_poses, success, source) -> None:  # type: ignore[no-untyped-def]
        recorder.add(Rows(poses, action, next_poses, success.astype("f4"), success, source))

    _core.generate(config, store, lambda progress: None)
    recorder.write(file)
    return file.read_bytes()
