"""Files from outside that shall be policies."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch as th
from rtg import _core, paths
from rtg.errors import UserError
from rtg.files import checkpoint
from rtg.learn import networks, policy_file
from samples import train_settings

TASK = _core.Config.from_file(paths.CONFIG / "tests" / "tiny.yaml").task
UNITS = {"position_unit": 4.0, "relative_unit": 1.0}
FITTING = {
    **UNITS,
    "observation_size": 20,
    "headings": 48,
    "strides": [1.0],
    "task": TASK.content,
    "network": "headings",
}


@pytest.mark.parametrize(
    ("state", "message"),
    [
        ({}, "does not say with which settings it was made"),
        ({"identity": {}}, "made with position_unit = None, but this run has 4.0"),
        (
            {"identity": {**UNITS, "relative_unit": 0.5}},
            "made with relative_unit = 0.5, but this run has 1.0",
        ),
        ({"identity": UNITS}, "made with observation_size = None, but this run has 20"),
        ({"identity": {**FITTING, "network": "huge"}}, "an unknown network; legal: plain, head"),
        ({"identity": {**FITTING, "network": []}}, "an unknown network; legal: plain, head"),
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
    network = networks.make(settings.network, TASK.observation_size, TASK.headings)
    policy_file.write(file, TASK, settings, network.state_dict())
    values = policy_file.read(file, TASK)
    assert values(np.zeros((3, 20), np.float32)).shape == (3, TASK.actions)
    with pytest.raises(ValueError, match=r"observations \[20\]; legal: \[N, 20\]"):
        values(np.zeros(20, np.float32))


@pytest.mark.parametrize("network", networks.KINDS)
def test_a_policy_has_the_values_of_the_network_that_was_written(
    tmp_path: Path, network: str
) -> None:
    """It was flattened, as those of learners are."""
    file, settings = tmp_path / "model.pt", train_settings(network=network, symmetry=False)
    written = networks.make(network, TASK.observation_size, TASK.headings)
    networks.flatten(written)
    policy_file.write(file, TASK, settings, written.state_dict())
    seen = np.random.default_rng(0).normal(size=(100, 20)).astype(np.float32)
    with th.no_grad():
        values = written(th.from_numpy(seen)).numpy()
    np.testing.assert_array_equal(policy_file.read(file, TASK)(seen), values)
    assert len(set(values.argmax(axis=1).tolist())) > 1


def test_threads_that_share_a_policy_get_what_one_alone_gets(tmp_path: Path) -> None:
    file, settings = tmp_path / "model.pt", train_settings()
    network = networks.make(settings.network, TASK.observation_size, TASK.headings)
    policy_file.write(file, TASK, settings, network.state_dict())
    values = policy_file.read(file, TASK)
    rng = np.random.default_rng(0)
    seen = [rng.normal(size=(50, 20)).astype(np.float32) for _ in range(40)]
    alone = [values(one) for one in seen]
    with ThreadPoolExecutor(8) as pool:
        np.testing.assert_array_equal(list(pool.map(values, seen)), alone)


@pytest.mark.parametrize(
    ("field", "value", "expected"),
    [
        ("network", "plain", "plain"),
        ("hindsight", 0, False),
        ("hindsight", 1, True),
        ("hindsight", 4, True),
        ("symmetry", False, False),
    ],
)
def test_the_identity_says_what_shapes_the_weights(field: str, value: Any, expected: Any) -> None:
    found = policy_file.identity(TASK, train_settings(**{field: value}))
    assert found == {
        **UNITS,
        "observation_size": 20,
        "headings": 48,
        "strides": [1.0],
        "task": TASK.content,
        "network": "headings",
        "hindsight": False,
        "symmetry": True,
        field: expected,
    }


@pytest.mark.parametrize(
    ("setting", "same"),
    [
        ("task.name=other", True),
        ("task.horizon=7", True),
        ("task.bodies.1.start=[-3, 2, 0]", True),
        ("task.bodies.1.friction=0.4", False),
        ("task.bodies.1.shape={box: [1.2, 1.1]}", False),
        ("task.goal.0.disc.radius=2.1", False),
        ("task.push.stride=1.9", False),
    ],
)
def test_a_policy_fits_tasks_of_the_same_content(tmp_path: Path, setting: str, same: bool) -> None:
    file = tmp_path / "model.pt"
    network = networks.make("headings", TASK.observation_size, TASK.headings)
    policy_file.write(file, TASK, train_settings(), network.state_dict())
    other = _core.Config.from_file(paths.CONFIG / "tests" / "tiny.yaml", [setting]).task
    if same:
        policy_file.read(file, other)
    else:
        with pytest.raises(UserError):
            policy_file.read(file, other)
