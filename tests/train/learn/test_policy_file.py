"""Files from outside that shall be policies."""

from pathlib import Path

import numpy as np
import pytest
from gymnasium import spaces
from rtg import _core, paths
from rtg.envs.push_env import observation_space
from rtg.errors import UserError
from rtg.files import checkpoint
from rtg.learn import policy_file
from rtg.learn.networks import ValuePolicy
from samples import train_settings

TASK = _core.Config.from_file(paths.CONFIG / "tests" / "tiny.yaml").task
FITTING = {"observation_size": 20, "headings": 48, "dueling": True, "layer_norm": True}


@pytest.mark.parametrize(
    ("state", "message"),
    [
        ({}, "does not say with which settings it was made"),
        ({"identity": {}}, "made with observation_size = None, but this run has 20"),
        ({"identity": FITTING, "model": {}}, "holds no policy"),
        ({"identity": FITTING, "weights": {}}, "its weights do not fit the network"),
    ],
)
def test_files_of_another_kind_are_no_policies(
    tmp_path: Path, state: dict[str, object], message: str
) -> None:
    file = tmp_path / "model.pt"
    checkpoint.write(file, state)
    with pytest.raises(UserError, match=message):
        policy_file.read(file, TASK)


def test_observations_of_a_wrong_shape_are_named(tmp_path: Path) -> None:
    file, settings = tmp_path / "model.pt", train_settings()
    flags = {"dueling": settings.dueling, "layer_norm": settings.layer_norm}
    actions = spaces.Discrete(TASK.headings)
    network = ValuePolicy(observation_space(TASK), actions, lambda _: 1.0, network=flags)
    policy_file.write(file, TASK, settings, network.q_net.state_dict())
    policy = policy_file.read(file, TASK)
    assert policy(np.zeros((3, 20), np.float32)).shape == (3,)
    with pytest.raises(ValueError, match=r"observations \[20\]; legal: \[N, 20\]"):
        policy(np.zeros(20, np.float32))


@pytest.mark.parametrize(
    ("field", "value", "expected"),
    [
        ("dueling", False, False),
        ("layer_norm", False, False),
        ("hindsight", 0, False),
        ("hindsight", 1, True),
        ("hindsight", 4, True),
    ],
)
def test_the_identity_says_what_shapes_the_weights(field: str, value: int, expected: bool) -> None:
    found = policy_file.identity(TASK, train_settings(**{field: value}))
    assert found == {
        "observation_size": 20,
        "headings": 48,
        "dueling": True,
        "layer_norm": True,
        "hindsight": False,
        field: expected,
    }
