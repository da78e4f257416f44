"""The whole command on a tiny task, in a network of its own, which may be killed and go on."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

from graph import generated_in_process
from living import processes_of, wait_until_all_are_gone
from network import Network
from rtg import paths

TINY = paths.CONFIG / "tests" / "tiny.yaml"
PATIENCE = 300.0  # [s]; longer is a hang
_GRACE = 30.0  # [s] in which all programs end with their command
TRAINER = "rtg.learn.trainer"
COMMAND = "rtg.cli"


class Command:
    """One run folder, on which the command works."""

    def __init__(self, network: Network, folder: Path) -> None:
        self._network, self.folder = network, folder
        self._process: subprocess.Popen[str] | None = None

    def start(self) -> None:
        """Begins the run, or goes on with it where it has begun."""
        begun = (self.folder / "config.yaml").exists()
        words = ["--resume"] if begun else [TINY]
        self._process = self._network.start(
            [sys.executable, "-m", COMMAND, *words, "--out", self.folder],
            PYTHONPATH=str(paths.ROOT / "train"),
        )

    def is_running(self) -> bool:
        return self._process is not None and self._process.poll() is None

    def kill(self, program: str) -> bool:
        """Kills TRAINER or COMMAND and waits until all programs of the run have ended.

        Returns whether there was such a program.
        """
        victims = [pid for pid, words in processes_of(self.folder).items() if program in words]
        for pid in victims:
            os.kill(pid, signal.SIGKILL)
        if victims:
            self._wait()
        return bool(victims)

    def end(self) -> None:
        """Waits for the end. Raises SystemExit if the command failed."""
        status, words = self._wait()
        if status != 0:
            raise SystemExit(f"the command ended with status {status}: {words}")

    def transitions(self) -> bytes:
        return (self.folder / "transitions.npz").read_bytes()

    def _wait(self) -> tuple[int, str]:
        assert self._process is not None
        words, _ = self._process.communicate(timeout=PATIENCE)
        wait_until_all_are_gone(self.folder, _GRACE)
        return self._process.returncode, words


def undisturbed(folder: Path) -> bytes:
    """Returns the transitions of the same run without LCM."""
    return generated_in_process(folder / "direct.npz")
