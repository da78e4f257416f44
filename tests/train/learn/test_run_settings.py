"""Each field of TrainConfig that is about a run and its parts does what it says."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rtg import _core
from rtg.files.dataset import Rows
from rtg.learn import device, trainer
from rtg.learn.evaluation import Evaluation
from rtg.learn.symmetry import Symmetry
from rtg.learn.training import Training
from test_learner_settings import OF_THE_LEARNER
from training_runs import TINY, Stream, run_folder, training


def course(one: Training, rows: Rows, success: list[bool]) -> dict[str, Any]:
    """Returns what a run does whose learner learns nothing and whose evaluations end as told."""
    saved, seen, ends = [], [], iter(success)

    def learn() -> None:
        seen.append(one.data.count)
        one.model.interactions += one.settings.train_frequency

    def evaluate() -> Evaluation:
        found = np.full(one.settings.eval_episodes, next(ends))
        return Evaluation(found, np.ones(len(found), int), found * 1.0, [])

    one.model.learn, one.evaluate = learn, evaluate
    one.save = lambda: saved.append(one.scheduled_interactions) or setattr(
        one, "_saved_at", one.scheduled_interactions
    )
    assert one.run(Stream(rows, one.data, piece=100), lambda: False, record=False)
    evaluated = [row["interactions"] for row in one.log.rows]
    return {
        "end": one.scheduled_interactions,
        "first": seen[0],
        "evaluated": evaluated,
        "saved": saved[:-1],
    }


USUAL = {
    "interactions": 240,
    "transitions_before_learning": 0,
    "eval_every": 80,
    "checkpoint_every": 100,
    "stop_at_success": 0.0,
    "stop_evaluations": 2,
}
OF_THE_COURSE: dict[str, tuple[Any, str, Any]] = {
    # field: its value, what it changes of the course, to what
    "interactions": (400, "end", 400),
    # 300 are in when learning may begin; another 100 come first
    "transitions_before_learning": (250, "first", 400),
    "eval_every": (120, "evaluated", [120, 240]),
    "checkpoint_every": (60, "saved", [60, 120, 180, 240]),
    "stop_at_success": (0.5, "end", 160),
}


def test_the_usual_course(tmp_path: Path, rows: Rows) -> None:
    found = of_course(tmp_path, rows, USUAL)
    assert found == {"end": 240, "first": 100, "evaluated": [80, 160, 240], "saved": [100, 200]}


def of_course(folder: Path, rows: Rows, settings: dict[str, Any]) -> dict[str, Any]:
    texts = [f"train.{name}={json.dumps(value)}" for name, value in settings.items()]
    return course(training(run_folder(folder / "run", None, *texts)), rows, [True] * 10)


@pytest.mark.parametrize("field", OF_THE_COURSE)
def test_a_setting_of_the_course(field: str, tmp_path: Path, rows: Rows) -> None:
    value, what, expected = OF_THE_COURSE[field]
    assert of_course(tmp_path, rows, {**USUAL, field: value})[what] == expected


@pytest.mark.parametrize(("count", "end"), [(1, 80), (2, 160), (3, 240)])
def test_so_many_evaluations_in_a_row_end_a_run(
    count: int, end: int, tmp_path: Path, rows: Rows
) -> None:
    settings = {"interactions": 400, "stop_at_success": 0.5, "stop_evaluations": count}
    assert of_course(tmp_path, rows, {**USUAL, **settings})["end"] == end


def spread(one: Training) -> float:
    """Returns how far a start puts an object at most from where the task has it. [m]"""
    starts = []
    for _ in range(50):
        one.env.reset()
        starts.append(one.env.state()["poses"] - one.task.start)
    return round(float(np.abs(np.concatenate(starts)[:, 1:, :2]).max()), 1)


def interactions_of_a_round(one: Training) -> int:
    one.model.interactions += 4
    return one.interactions


def source(one: Training) -> str:
    return type(trainer._source(one, trainer._parse([str(one.folder), "--no-stream"]))).__name__


OF_THE_PARTS: dict[str, tuple[Any, Any, Callable[[Training], Any], Any, Any]] = {
    "interact": (True, False, interactions_of_a_round, 4, 0),
    "offline": (True, False, source, "FileSource", "NoSource"),
    "discount": (0.7, 0.9, lambda t: t.model.discount, 0.7, 0.9),
    "start_jitter": (0.1, 0.2, spread, 0.1, 0.2),
    "randomise": (False, True, spread, 0.1, 0.5),
    "symmetry": (True, False, lambda t: isinstance(t.model.symmetry, Symmetry), True, False),
    "hindsight": (0, 2, lambda t: getattr(t.model.replay, "goals", 0), 0, 2),
    "curriculum": (0.0, 0.5, lambda t: t.env.curriculum is not None, False, True),
    "eval_episodes": (2, 3, lambda t: len(t.evaluate().success), 2, 3),
}


@pytest.mark.parametrize("field", OF_THE_PARTS)
def test_a_setting_of_the_parts(field: str, tmp_path: Path, rows: Rows) -> None:
    one, other, measure, expected, changed = OF_THE_PARTS[field]
    for name, value, wanted in (("one", one, expected), ("other", other, changed)):
        text = f"train.{field}={json.dumps(value)}"
        assert measure(training(run_folder(tmp_path / name, rows, text))) == wanted


@pytest.mark.parametrize("wanted", ["auto", "cpu"])
def test_networks_are_on_the_device_that_is_chosen(
    wanted: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On PyTorch's device without memory, because tests have no GPU."""
    monkeypatch.setattr(device, "chosen", {wanted: "meta"}.get)
    one = training(run_folder(tmp_path / "run", None, f"train.device={wanted}"))
    assert one.model.device == "meta"
    for net in (one.model.online, one.model.target, one.model.mean):
        assert {tensor.device.type for tensor in net.state_dict().values()} == {"meta"}


@pytest.mark.parametrize(("learner", "name"), [("q_learning", "DoubleDqn"), ("cloning", "Cloning")])
def test_the_learner_is_the_one_of_that_name(learner: str, name: str, tmp_path: Path) -> None:
    settings = ["train.interact=false", f"train.learner={learner}"]
    assert type(training(run_folder(tmp_path / "run", None, *settings)).model).__name__ == name


def test_each_setting_has_its_test() -> None:
    fields = set(json.loads(_core.Config.from_file(TINY).json)["train"])
    # presets of all others: test_settings.py; the rest has tests of its own above
    elsewhere = {"preset", "learner", "stop_evaluations", "device"}
    assert {*OF_THE_LEARNER, *OF_THE_COURSE, *OF_THE_PARTS} == fields - elsewhere
