"""The rows of progress.csv in TensorBoard and Weights & Biases."""

import sys
from types import ModuleType, SimpleNamespace

import pytest
from rtg import _core, cli, extras
from rtg.errors import UserError
from rtg.learn import log_sinks
from rtg.learn.log_sinks import LazySinks
from rtg.learn.offline_data import FileSource
from rtg.learn.training_log import TrainingLog
from rtg.run.results import learning_curve
from training_runs import TINY, run_folder, training

CONFIG = _core.Config.from_file(TINY, [])


def log(folder, names, *rows, restored=()):
    """Logs rows as one process of a run does, which has restored others from a checkpoint."""
    training_log = TrainingLog(folder)
    training_log.rows = [{"interactions": i, "success_rate": s} for i, s in restored]
    training_log.sinks = LazySinks(names, folder, CONFIG)
    for interactions, success in rows:
        training_log.add({"interactions": interactions, "success_rate": success})
    training_log.sinks.close()


def scalars(folder, name="success_rate"):
    """Reads steps and values back, as TensorBoard shows them."""
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

    events = EventAccumulator(str(folder / "tensorboard")).Reload()
    return [(event.step, event.value) for event in events.Scalars(name)]


@pytest.fixture
def tensorboard():
    pytest.importorskip("tensorboard", reason="extra tensorboard")
    return ["tensorboard"]


def test_what_a_run_logged_after_its_checkpoint_is_replaced(tmp_path, tensorboard):
    log(tmp_path, tensorboard, (80, 0.0), (160, 0.25))
    log(tmp_path, tensorboard, (160, 0.5), (240, 1.0), restored=[(80, 0.0)])
    assert scalars(tmp_path) == [(80, 0.0), (160, 0.5), (240, 1.0)]


def test_rows_of_a_part_that_was_not_logged_there_are_logged_later(tmp_path, tensorboard):
    first, second, third = (80, 0.0), (160, 0.5), (240, 1.0)
    log(tmp_path, tensorboard, first)
    log(tmp_path, [], second, restored=[first])
    log(tmp_path, tensorboard, third, restored=[first, second])
    assert scalars(tmp_path) == [first, second, third]


@pytest.mark.parametrize("logged", [[True, True], [False, True]])
def test_a_learner_that_was_killed_and_goes_on_logs_each_of_its_rows_once(
    tmp_path, rows, tensorboard, logged
):
    folder = run_folder(tmp_path / "run", rows)
    for is_last, is_logged in zip([False, True], logged, strict=True):
        one = training(folder)
        if one.has_checkpoint():
            one.restore()
        one.log.sinks = LazySinks(tensorboard if is_logged else [], folder, one.config)
        source = FileSource(folder / "transitions.npz", one.task, one.data)
        if is_last:
            assert one.run(source, lambda: False, record=False)
        else:
            kill_after(one, rows=2)
            with pytest.raises(KeyboardInterrupt):
                one.run(source, lambda: False, record=False)
        one.log.sinks.close()
    curve = learning_curve(folder / "progress.csv")
    assert len(curve["interactions"]) == 3
    for name in ("success_rate", "gradient_steps", "td_error"):
        steps, values = zip(*scalars(folder, name), strict=True)
        assert steps == tuple(curve["interactions"])
        assert values == pytest.approx(curve[name], rel=1e-5)


def kill_after(one, rows):
    """Ends a learner right after it has logged so many rows, without a further checkpoint."""
    add = one.log.add

    def add_and_die(row):
        add(row)
        if len(one.log.rows) == rows:
            raise KeyboardInterrupt

    one.log.add = add_and_die


def test_wandb_gets_earlier_rows_only_if_it_has_none(tmp_path, monkeypatch):
    taken = []
    run = SimpleNamespace(log=lambda row, step: taken.append(step), finish=lambda: None)
    fake = ModuleType("wandb")
    fake.init, fake.Settings, fake.errors = lambda **_: run, dict, SimpleNamespace(Error=OSError)
    monkeypatch.setitem(sys.modules, "wandb", fake)
    monkeypatch.setenv("WANDB_MODE", "offline")
    log(tmp_path, ["wandb"], (160, 0.5), restored=[(80, 0.0)])
    log(tmp_path, ["wandb"], (240, 1.0), restored=[(80, 0.0), (160, 0.5)])
    assert taken == [80, 160, 240]


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


def test_a_run_logs_to_tensorboard(tmp_path, tensorboard):
    run = tmp_path / "run"
    steps = carry_out(run, "tensorboard", *RUN)
    assert [step for step, _ in scalars(run)] == steps and len(steps) == 2
    steps = carry_out(run, "tensorboard", "--resume", "--interactions", "300")
    assert [step for step, _ in scalars(run)] == steps and len(steps) == 3


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
