"""What an export says of its episodes."""

import numpy as np
from rtg import _core, paths
from rtg.export import run_data
from rtg.export.run_data import RunData
from rtg.files import dataset
from rtg.files.episodes import Episode
from rtg.files.recorder import Recorder

CONFIG = _core.Config.from_file(paths.CONFIG / "gathering.yaml")
DATA = RunData(CONFIG, Recorder(CONFIG).transitions(), dataset.origin_of(CONFIG), "", "rrbs")


def episode(first, steps, success):
    return Episode(np.stack([first] * (steps + 1)), np.zeros(steps, np.int64), success)


def test_episodes_from_a_start_are_counted_and_that_there_are_none_is_said():
    start, goal = CONFIG.task.start, CONFIG.task.goal_state(1)
    found = [episode(goal, 1000, True), episode(goal, 30, False), episode(start, 1, True)]
    assert run_data.words(DATA, found) == (
        "3 episodes, 2 of them succeed, 1 of them begin at a start of the task, 1,031 steps"
    )
    assert run_data.words(DATA, found[:2]) == (
        "2 episodes, 1 of them succeed, none of them begins at a start of the task, 1,030 steps"
    )
