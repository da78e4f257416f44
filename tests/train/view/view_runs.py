"""Run folders to look at."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from rtg import _core
from rtg.files.dataset import Rows
from rtg.learn.evaluation import Evaluation
from rtg.learn.training_log import TrainingLog
from rtg.view import web_page
from training_runs import TINY, run_folder

GENERATION = 12.0  # [s] that the generation takes
LEARNING = (3.0, 6.0)  # [s] after which the learner has been evaluated
PUSHES = 3  # of the best episode
TASK = _core.Config.from_file(TINY).task


def free_pair() -> int:
    """Returns a port that is free, as is the next one."""
    while True:
        port = web_page.free_port()
        if port < 65_535 and not web_page.is_open(port + 1):
            return port


def episode() -> np.ndarray:
    """Returns states in which the robot goes right and pushes the first box. [T + 1, bodies, 3]"""
    states = np.repeat(np.array(TASK.start)[None], PUSHES + 1, axis=0)
    states[:, 0, 0] += np.arange(PUSHES + 1)
    states[PUSHES, 1, 0] += 0.5
    return states


def generated(folder: Path, rows: Rows, *overrides: str) -> Path:
    """Makes the folder of a run that has generated `rows` in one process."""
    run_folder(folder, rows, "run.in_process=true", *overrides)
    gaps = np.geomspace(0.001, 0.1, 100).tolist()
    report = {"generate_wall_s": GENERATION, "replay_gaps": gaps}
    (folder / "generation.json").write_text(json.dumps(report))
    return folder


def learn(folder: Path, success: bool = True) -> None:
    """Adds what a learner leaves: two evaluations and its best episode."""
    log = TrainingLog(folder)
    for k, wall in enumerate(LEARNING, 1):
        row = {"interactions": 100 * k, "wall_s": wall, "rollout_success": 0.3 * k}
        log.add({**row, "success_rate": 0.4 * k})
    final = Evaluation(np.array([success]), np.array([PUSHES]), np.array([0.5]), [episode()])
    log.write_result(final, {"interactions": 200})


def finished(folder: Path, rows: Rows) -> Path:
    """Makes the folder of a run that has ended."""
    learn(generated(folder, rows))
    (folder / "summary.json").write_text("{}")
    return folder
