"""A policy under variants of its task."""

import json
from pathlib import Path

import numpy as np
import pytest
from rtg import _core, paths
from rtg.learn import robustness
from rtg.learn.robustness import Variant, evaluate_variant

FILE = paths.CONFIG / "gathering.yaml"
CONFIG = _core.Config.from_file(FILE)


def groups(task: str) -> list[str]:
    config = _core.Config.from_file(paths.CONFIG / f"{task}.yaml")
    return list(dict.fromkeys(v.group for v in robustness.variants(config)))


def test_the_variants_are_of_starts_noise_and_physics() -> None:
    physics = ["noise of poses", "friction", "mass of objects", "stride", "coasting"]
    fixed = ["as trained", "robot", "objects moved", "objects turned"]
    assert groups("gathering") == [*fixed, *physics]
    assert groups("art_manip") == [*fixed[:3], *physics], "a chain does not turn alone"
    assert groups("push_t") == ["as trained", *physics], "its starts are everywhere"


@pytest.mark.parametrize("task", ["gathering", "sorting", "art_manip", "gate", "pack", "push_t"])
def test_settings_of_variants_are_legal_or_leave_no_start(task: str) -> None:
    file = paths.CONFIG / f"{task}.yaml"
    refused = []
    for variant in robustness.variants(_core.Config.from_file(file)):
        try:
            _core.Config.from_file(file, list(variant.settings))
        except _core.ConfigError as error:
            refused.append(variant.label)
            assert "legal" in str(error)
    assert len(refused) <= 2, refused


def values_of(seen: list[np.ndarray]):
    def values(observation: np.ndarray) -> np.ndarray:
        seen.append(observation)
        return np.zeros((len(observation), CONFIG.task.actions))

    return values


def test_the_policy_sees_the_units_of_its_own_task_and_noise_where_it_is_asked_for() -> None:
    plain, noisy, longer = [], [], []
    for seen, variant in (
        (plain, Variant("", "")),
        (noisy, Variant("", "", noise=0.1)),
        (longer, Variant("", "", ("task.push.strides=[2.5]",))),
    ):
        row = evaluate_variant(FILE, CONFIG, values_of(seen), variant, 4)
        assert row.success == 0.0 and row.length == CONFIG.task.horizon
    np.testing.assert_array_equal(plain[0], longer[0])
    off = (noisy[0] - plain[0])[:, :2] * CONFIG.task.position_unit
    assert 0.02 < np.abs(off).mean() < 0.3


def test_without_legal_starts_a_row_says_so() -> None:
    variant = Variant("objects moved", "onto the robot", ("task.bodies.1.start=[0, -5, 0]",))
    assert evaluate_variant(FILE, CONFIG, values_of([]), variant, 4).success is None


def test_the_command_writes_table_picture_and_json(tmp_path: Path) -> None:
    from rtg.compare.evaluate import evaluate
    from rtg.errors import UserError
    from rtg.learn import networks, policy_file

    with pytest.raises(UserError, match=r"has no config\.yaml"):
        evaluate(tmp_path, 2)
    (tmp_path / "config.yaml").write_text(CONFIG.yaml)
    with pytest.raises(UserError, match=r"has no model\.pt"):
        evaluate(tmp_path, 2)
    task = CONFIG.task
    network = networks.make("headings", task.observation_size, task.headings)
    policy_file.write(tmp_path / "model.pt", task, CONFIG.train, network.state_dict())
    text = evaluate(tmp_path, 2)
    rows = json.loads((tmp_path / "evaluation.json").read_text())["rows"]
    assert len(rows) == len(robustness.variants(CONFIG)) == text.count("\n| ") - 1
    assert (tmp_path / "evaluation.md").read_text() == text
    assert (tmp_path / "evaluation.png").stat().st_size > 5_000
