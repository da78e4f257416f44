"""A run with few transitions, in which the search has found plans."""

from pathlib import Path

import numpy as np
from rtg import _core, paths
from rtg.files.dataset import Rows
from rtg.files.recorder import Recorder

SETTINGS = (
    "search.generator=naive",
    "search.transitions=600",
    "search.breadth=8",
    "search.branches=1",
    "run.seed=3",
)


def run_folder(folder: Path, *settings: str) -> Path:
    """Makes the folder of a run on Gathering that has only generated."""
    config = _core.Config.from_file(paths.CONFIG / "gathering.yaml", [*SETTINGS, *settings])
    folder.mkdir()
    (folder / "config.yaml").write_text(config.yaml)
    recorder = Recorder(config)

    def store(poses, action, next_poses, success, source):  # type: ignore[no-untyped-def]
        recorder.add(Rows(poses, action, next_poses, success.astype(np.float32), success, source))

    _core.generate(config, store, lambda progress: None)
    recorder.finish(folder / "transitions.npz")
    return folder
