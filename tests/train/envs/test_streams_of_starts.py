"""No start that one part of a run draws is one of another part, whatever their seeds."""

import itertools

import numpy as np
from rtg import _core
from rtg.envs.training_environments import TrainingEnvironments
from rtg.learn.evaluation import final_starts, held_out_starts
from training_runs import TINY

COUNT = 300


def of_search(seed: int) -> np.ndarray:
    """Returns where the walks of a generation begin. [walks, bodies, 3]"""
    overrides = ["search.generator=random", f"run.seed={seed}", "search.branches=0"]
    config = _core.Config.from_file(TINY, [*overrides, "task.horizon=1", "search.transitions=300"])
    starts: list[np.ndarray] = []
    _core.generate(config, lambda poses, *_: starts.append(poses), lambda line: None)
    return np.concatenate(starts)


def of_training(seed: int) -> np.ndarray:
    config = _core.Config.from_file(TINY)
    env, starts = TrainingEnvironments(config, 4, config.task.start_jitter, seed), []
    for _ in range(COUNT // 4):
        env.reset()
        starts.append(env.state()["poses"])
    return np.concatenate(starts)


def test_starts_of_search_training_and_evaluations_are_all_different() -> None:
    config = _core.Config.from_file(TINY, [f"train.eval_episodes={COUNT}"])
    of = {f"search {seed}": of_search(seed) for seed in (1, 2)}
    of |= {f"training {seed}": of_training(seed) for seed in (1, 2)}
    of |= {f"evaluation {k}": held_out_starts(config, number=k) for k in (0, 1)}
    of["the final one"] = final_starts(config, COUNT)
    places = {name: {start[1:, :2].tobytes() for start in starts} for name, starts in of.items()}
    for name, found in places.items():
        assert len(found) == COUNT, name
    for one, other in itertools.combinations(places, 2):
        assert not places[one] & places[other], f"{one}, {other}"
