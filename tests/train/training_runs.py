"""Tiny training runs: their folder, their learner, a stream of transitions."""

from collections.abc import Callable
from pathlib import Path

import torch as th
from rtg import _core, paths
from rtg.files.dataset import Rows
from rtg.files.recorder import Recorder
from rtg.learn.offline_data import OfflineData
from rtg.learn.training import Training

TINY = paths.CONFIG / "tests" / "tiny.yaml"
WORK = ("train.interactions=240", "train.eval_every=80", "train.checkpoint_every=100")


def run_folder(path: Path, rows: Rows | None, *overrides: str) -> Path:
    path.mkdir()
    config = _core.Config.from_file(TINY, [*WORK, *overrides])
    (path / "config.yaml").write_text(config.yaml)
    if rows is not None:
        recorder = Recorder(config)
        recorder.add(rows)
        recorder.finish(path / "transitions.npz")
    return path


def training(folder: Path) -> Training:
    return Training(_core.Config.from_file(folder / "config.yaml"), folder)


class Stream:
    """Hands `rows` over in pieces, one per poll, as the stream of a run does."""

    def __init__(self, rows: Rows, data: OfflineData, piece: int) -> None:
        self.rows, self.data, self.piece, self.at = rows, data, piece, 0

    @property
    def complete(self) -> bool:
        return self.at >= len(self.rows.action)

    def poll(self, timeout: float) -> int:
        begin, self.at = self.at, min(self.at + self.piece, len(self.rows.action))
        self.data.add(Rows(*(column[begin : self.at] for column in self.rows)))
        return self.at - begin


def after_polls(count: int) -> Callable[[], bool]:
    """Makes a function that says False `count` times, then True."""
    left = iter(range(count))
    return lambda: next(left, None) is None


def flat(value: object) -> list[object]:
    """Every leaf of a checkpoint, seconds left out."""
    if isinstance(value, dict):
        kept = [key for key in value if key not in ("wall_s", "cpu_s", "evaluation_cpu_s")]
        return [leaf for key in kept for leaf in [key, *flat(value[key])]]
    if isinstance(value, list):
        return [leaf for part in value for leaf in flat(part)]
    return [value.numpy().tobytes() if isinstance(value, th.Tensor) else value]
