"""The rows of progress.csv in TensorBoard and Weights & Biases."""

import sys

import pytest
from rtg import _core, cli, extras
from rtg.errors import UserError
from rtg.learn import log_sinks
from rtg.learn.log_sinks import LazySinks
from rtg.learn.training_log import TrainingLog
from training_runs import TINY

CONFIG = _core.Config.from_file(TINY, [])


def log(folder, name, *rows):
    """Logs rows as one process of a run does."""
    training_log = TrainingLog(folder)
    training_log.sinks = LazySinks([name], folder, CONFIG)
    for interactions, success in rows:
        training_log.add({"interactions": interactions, "success_rate": success})
    training_log.sinks.close()


def test_a_run_that_goes_on_appends_to_its_events(tmp_path):
    """What it logged after its checkpoint is replaced."""
    pytest.importorskip("tensorboard", reason="extra tensorboard")
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

    log(tmp_path, "tensorboard", (80, 0.0), (160, 0.25))
    log(tmp_path, "tensorboard", (160, 0.5), (240, 1.0))
    events = EventAccumulator(str(tmp_path / "tensorboard")).Reload()
    assert events.Tags()["scalars"] == ["success_rate"]
    found = [(event.step, event.value) for event in events.Scalars("success_rate")]
    assert found == [(80, 0.0), (160, 0.5), (240, 1.0)]


def test_a_run_that_goes_on_keeps_its_id(tmp_path):
    name = log_sinks._stored_id(tmp_path / "wandb_id")
    assert log_sinks._stored_id(tmp_path / "wandb_id") == name
    assert log_sinks._stored_id(tmp_path / "other") != name


def test_without_rows_nothing_is_opened(tmp_path):
    LazySinks(log_sinks.SINKS, tmp_path, CONFIG).close()
    assert list(tmp_path.iterdir()) == []


def test_a_missing_package_is_named_with_its_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "tensorboard", None)
    with pytest.raises(UserError, match=r"^--log tensorboard needs the Python package"):
        log_sinks.parse("tensorboard")


@pytest.mark.parametrize("words", [["--log", "paper"], ["reproduce", "--log", "paper"]])
def test_an_unknown_log_is_named(words, capsys):
    assert cli.main(words) == 2
    assert capsys.readouterr().err == ("rtg: --log paper: no such log; legal: tensorboard,wandb\n")


def test_flags_are_what_was_parsed(monkeypatch):
    monkeypatch.setattr(extras, "require", lambda *_: None)
    assert log_sinks.flags(log_sinks.parse("wandb,tensorboard,wandb")) == [
        "--log",
        "wandb,tensorboard",
    ]
    assert log_sinks.flags(log_sinks.parse(None)) == []


def carry_out(run, name, *words):
    """Carries out a tiny run, which evaluates twice, and returns the steps in progress.csv."""
    assert cli.main([*words, "--log", name, "--out", str(run)]) == 0
    lines = (run / "progress.csv").read_text().splitlines()[1:]
    return [int(line.split(",")[0]) for line in lines]


RUN = (str(TINY), "--in-process", "--method", "ddqn", "--interactions", "200")
RUN += ("--set", "train.eval_every=100", "--set", "train.eval_episodes=2")


def test_a_run_logs_to_tensorboard(tmp_path):
    pytest.importorskip("tensorboard", reason="extra tensorboard")
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

    steps = carry_out(tmp_path / "run", "tensorboard", *RUN)
    events = EventAccumulator(str(tmp_path / "run/tensorboard")).Reload()
    assert [event.step for event in events.Scalars("success_rate")] == steps and len(steps) == 2


def test_a_run_logs_to_wandb_and_goes_on_under_the_same_id(tmp_path, monkeypatch):
    """Unasked, nothing leaves the machine."""
    pytest.importorskip("wandb", reason="extra wandb")
    monkeypatch.delenv("WANDB_MODE", raising=False)
    run = tmp_path / "run"
    carry_out(run, "wandb", *RUN)
    assert len(carry_out(run, "wandb", "--resume", "--interactions", "300")) == 3
    files = list(run.glob("wandb/offline-run-*/*.wandb"))
    assert {file.name for file in files} == {f"run-{(run / 'wandb_id').read_text()}.wandb"}
    assert len(files) == 2 and all(b"success_rate" in file.read_bytes() for file in files)
