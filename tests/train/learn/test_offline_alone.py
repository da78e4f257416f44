"""Learning from generated transitions alone: no environment, all of the data, the same bits."""

import json
from pathlib import Path
from typing import Any

import pytest
from rtg.envs.training_environments import TrainingEnvironments
from rtg.files import checkpoint
from rtg.files.dataset import Rows
from rtg.learn.offline_data import FileSource
from rtg.learn.training import Training
from training_runs import Stream, after_polls, flat, run_folder, training

METHODS = ("cql_rtg", "bc_rtg")


def never(*_: Any) -> None:
    raise AssertionError("the environment was used")


def state(one: Training) -> list[object]:
    return flat(checkpoint.read(one.folder / "checkpoint" / "state.pt"))


@pytest.mark.parametrize("method", METHODS)
def test_no_environment_is_stepped_and_rounds_follow_the_schedule(
    method: str, tmp_path: Path, rows: Rows, monkeypatch: pytest.MonkeyPatch
) -> None:
    """There are two gradient steps per four interactions that are left out."""
    for name in ("reset", "step"):
        monkeypatch.setattr(TrainingEnvironments, name, never)
    wanted = (f"run.method={method}", "train.gradient_steps=2")
    folder = run_folder(tmp_path / "run", rows, *wanted)
    one = training(folder)
    source = FileSource(folder / "transitions.npz", one.task, one.data)
    assert one.run(source, lambda: False, record=False)
    one.finish()
    columns = [(r["interactions"], r["gradient_steps"], r["pushes"]) for r in one.log.rows]
    assert columns == [(80, 40, 0), (160, 80, 0), (240, 120, 0)]
    assert "epsilon" not in one.log.rows[0]
    found = json.loads((folder / "training.json").read_text())
    of_learning = ("interactions", "gradient_steps", "learning_pushes", "online_successes")
    assert [found[name] for name in of_learning] == [0, 120, 0, 0]
    shown = json.loads((folder / "training_state.json").read_text())
    assert (shown["interactions"], shown["budget"], shown["done"]) == (240, 240, True)


@pytest.mark.parametrize("method", METHODS)
def test_learning_waits_for_all_transitions(
    method: str, tmp_path: Path, rows: Rows, monkeypatch: pytest.MonkeyPatch
) -> None:
    """So a stream teaches the same bits as a file."""
    ends = []
    for name in ("stream", "file"):
        there = run_folder(
            tmp_path / name, rows, f"run.method={method}", "train.transitions_before_learning=0"
        )
        one, seen = training(there), set[int]()
        learn = one.model.learn_offline

        def noted(one: Training = one, learn: Any = learn, seen: set[int] = seen) -> None:
            seen.add(one.data.count)
            learn()

        monkeypatch.setattr(one.model, "learn_offline", noted)
        file = FileSource(there / "transitions.npz", one.task, one.data)
        source = Stream(rows, one.data, piece=60) if name == "stream" else file
        assert one.run(source, lambda: False, record=False)
        assert seen == {2000}
        ends.append(state(one))
    # Bounds are proven anew as a stream grows: at the end they are those of all.
    assert ends[0] == ends[1]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("cut", [5, 50])
def test_a_resumed_run_ends_with_the_same_bits(
    method: str, cut: int, tmp_path: Path, rows: Rows
) -> None:
    """It is cut off while waiting and while learning."""
    ends = []
    for name, cuts in (("whole", []), ("cut", [cut, 41])):
        folder = run_folder(tmp_path / name, None, f"run.method={method}")
        for stop in [*map(after_polls, cuts), lambda: False]:
            one = training(folder)
            if one.has_checkpoint():
                one.restore()
            finished = one.run(Stream(rows, one.data, piece=60), stop, record=True)
        assert finished and one.scheduled_interactions == 240
        ends.append(state(one))
    assert len(ends[0]) > 50 and ends[0] == ends[1]
