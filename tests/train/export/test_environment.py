"""The environment of a run, made again from the text of its spec."""

import gymnasium
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec
from rtg import _core, paths
from rtg.export.environment import environment_of

GATHERING = paths.CONFIG / "gathering.yaml"


def loaded(*settings):
    return _core.Config.from_file(GATHERING, list(settings))


@pytest.mark.parametrize("setting", ["search.breadth=3", "train.batch=7", "run.seed=5"])
def test_what_no_environment_knows_leaves_it_the_registered_one(setting):
    assert environment_of(loaded(setting)).spec.id == "RTG/Gathering-v0"


@pytest.mark.parametrize(
    "setting", ["physics.inertia=true", "forward.engine=newton", "task.horizon=5"]
)
def test_another_task_or_physics_is_told_by_its_text(setting):
    config = loaded(setting)
    env = environment_of(config)
    again = gymnasium.make(EnvSpec.from_json(env.spec.to_json()))
    assert env.spec.id == "RTG/Task-v0" and again.unwrapped.task.content == config.task.content
    first, second = env.reset(seed=1)[0], again.reset(seed=1)[0]
    assert np.array_equal(first, second)
    for action in (3, 30):
        assert np.array_equal(env.step(action)[0], again.step(action)[0])
