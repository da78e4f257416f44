"""The trainer on a small set of true transitions: what it leaves; resuming changes nothing."""

import csv
import functools
import json
import os
import signal
from pathlib import Path

import numpy as np
import pytest
from rtg import _core
from rtg.errors import RunError, UserError
from rtg.files import checked_table, checkpoint, dataset
from rtg.files.dataset import Rows
from rtg.files.recorder import Recorder
from rtg.learn import policy_file, trainer
from rtg.learn.evaluation import HELD_OUT_SEED, evaluate, final_starts, held_out_starts
from rtg.learn.offline_data import FileSource
from rtg.learn.training_log import COLUMNS, TrainingLog
from training_runs import TINY, Stream, after_polls, flat, run_folder, training


def test_a_run_leaves_its_files(tmp_path: Path, rows: Rows) -> None:
    folder = run_folder(tmp_path / "run", rows)
    assert trainer.main([str(folder), "--no-stream"]) == 0
    with (folder / "progress.csv").open() as file:
        table = list(csv.DictReader(file))
    assert [row["interactions"] for row in table] == ["80", "160", "240"]
    assert set(table[0]) == {*COLUMNS, checked_table.COLUMN}
    assert all(table[-1][name] != "" for name in COLUMNS)
    result = json.loads((folder / "training.json").read_text())
    assert result["interactions"] == 240 and result["final_episodes"] == 20
    assert {"success_rate", "episode_length_mean", "episode_return_mean"} <= set(result)
    assert result["train_wall_s"] > 0 and result["train_cpu_s"] > 0
    assert [row["pushes"] for row in table] == ["80", "160", "240"]
    assert result["learning_pushes"] == 240
    spent = [float(row["cpu_s"]) for row in table]
    assert 0 < spent[0] < spent[1] < spent[2] <= result["train_cpu_s"] + 1e-3  # it is rounded
    of_evaluations = [float(row["evaluation_cpu_s"]) for row in table]
    assert 0 < of_evaluations[0] < of_evaluations[1] < of_evaluations[2] < spent[2]
    state = json.loads((folder / "training_state.json").read_text())
    assert state["done"] and (state["interactions"], state["budget"]) == (240, 240)
    with np.load(folder / "best_episode.npz") as best:
        assert best["poses"].shape[1:] == (4, 3)


def test_the_model_file_holds_the_policy(tmp_path: Path, rows: Rows) -> None:
    folder = run_folder(tmp_path / "run", rows)
    one = training(folder)
    source = FileSource(folder / "transitions.npz", one.task, one.data)
    assert one.run(source, lambda: False, record=False)
    one.finish()
    values = policy_file.read(folder / "model.pt", one.task)
    seen = one.data.record.transitions().observation
    np.testing.assert_array_equal(values(seen), one.model.values(seen))


@pytest.mark.parametrize("cut", [1, 17, 41, 55])
def test_a_resumed_run_ends_with_the_same_bits(tmp_path: Path, rows: Rows, cut: int) -> None:
    """It is cut off while waiting, between events and after an evaluation; rows still come in."""
    ends = []
    for name, cuts in (("whole", []), ("cut", [cut, 7])):
        folder = run_folder(tmp_path / name, None)
        for stop in [*map(after_polls, cuts), lambda: False]:
            one = training(folder)
            if one.has_checkpoint():
                one.restore()
            # As the coordinator's stream, from the first row; what is known already comes at once.
            source = Stream(rows, one.data, piece=60)
            while source.at < one.data.count:
                source.poll(0.0)
            finished = one.run(source, stop, record=True)
        assert finished
        ends.append(flat(checkpoint.read(folder / "checkpoint" / "state.pt")))
        assert not (folder / "checkpoint" / "transitions.npz").exists()
    assert len(ends[0]) > 50 and ends[0] == ends[1]
    files = [(tmp_path / name / "transitions.npz").read_bytes() for name in ("whole", "cut")]
    assert files[0] == files[1]


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("model.stages.acting.cpu_s", "x"),
        ("seconds.wall_s", None),
        ("env.steps", "x"),
        ("env.steps", [0]),
        ("env.poses", [[0.0]]),
        ("env.starts", "x"),
        ("env.origins", [0, "x"]),
        ("env.curriculum", "x"),
        ("env.curriculum.pool", "x"),
        ("env.curriculum.tries", [1]),
        ("env.curriculum.first", None),
        ("env.curriculum.drawn", "x"),
    ],
)
def test_a_checkpoint_with_wrong_fields_is_named(
    path: str, value: object, tmp_path: Path, rows: Rows
) -> None:
    folder = run_folder(tmp_path / "run", None, "train.curriculum=0.5")
    one = training(folder)
    one.run(Stream(rows, one.data, piece=60), after_polls(5), record=True)
    file = folder / "checkpoint" / "state.pt"
    state = checkpoint.read(file)
    *above, last = path.split(".")
    functools.reduce(dict.__getitem__, above, state)[last] = value
    checkpoint.write(file, state)
    with pytest.raises(UserError, match=f"^{file}: has other fields than it should"):
        training(folder).restore()


def test_transitions_file_holds_the_stream_in_order(tmp_path: Path, rows: Rows) -> None:
    folder = run_folder(tmp_path / "run", None, "train.interactions=4")
    one = training(folder)
    assert one.run(Stream(rows, one.data, piece=333), lambda: False, record=True)
    written = dataset.read(folder / "transitions.npz")
    for name in Rows._fields:
        np.testing.assert_array_equal(getattr(written, name), getattr(rows, name))
    np.testing.assert_array_equal(written.observation, one.task.observation(rows.poses))
    np.testing.assert_array_equal(written.next_observation, one.task.observation(rows.next_poses))


def test_learning_begins_before_all_transitions_are_in(tmp_path: Path, rows: Rows) -> None:
    folder = run_folder(tmp_path / "run", None, "train.transitions_before_learning=500")
    one = training(folder)
    seen = []
    stream = Stream(rows, one.data, piece=50)
    learn = one.model.learn
    one.model.learn = lambda *a, **k: seen.append(one.data.count) or learn(*a, **k)
    assert one.run(stream, lambda: False, record=True)
    assert seen[0] == 550 and seen[-1] == 2000 and len(set(seen)) > 20


def test_people_are_told_how_well_the_learner_does(tmp_path: Path, rows: Rows) -> None:
    one, told = training(run_folder(tmp_path / "run", None)), set[str]()
    one.publish_status = lambda state, done: told.add(state)
    assert one.run(Stream(rows, one.data, piece=333), lambda: False, record=False)
    evaluated = {f"learning, success {row['success_rate']:.2f}" for row in one.log.rows[:-1]}
    assert told == {"waiting", "learning", *evaluated}


def test_learning_stops_early_at_lasting_success(tmp_path: Path, rows: Rows) -> None:
    wanted = ("train.stop_at_success=0.5", "train.stop_evaluations=2", "train.eval_every=20")
    folder = run_folder(tmp_path / "run", rows, *wanted)
    one = training(folder)
    successes = iter([True, False, True, True, False])
    found = one.evaluate()
    one.evaluate = lambda: found._replace(success=np.full(2, next(successes)))
    source = FileSource(folder / "transitions.npz", one.task, one.data)
    assert one.run(source, lambda: False, record=False)
    assert one.interactions == 80


def test_another_stream_is_not_mixed_with_the_checkpoint(tmp_path: Path, rows: Rows) -> None:
    folder = run_folder(tmp_path / "run", None)
    one = training(folder)
    one.run(Stream(rows, one.data, piece=60), after_polls(5), record=True)
    other = training(folder)
    other.restore()
    changed = rows._replace(action=(rows.action + 1) % 48)
    with pytest.raises(RunError, match="differ from those that the checkpoint was made with"):
        other.run(Stream(changed, other.data, piece=60), lambda: False, record=True)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_leaves_a_checkpoint_to_go_on_from(
    tmp_path: Path, rows: Rows, number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = run_folder(tmp_path / "run", rows)
    add = TrainingLog.add

    def interrupted(log: TrainingLog, row: dict) -> None:
        add(log, row)
        os.kill(os.getpid(), number)

    monkeypatch.setattr(TrainingLog, "add", interrupted)
    handlers = signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)
    assert trainer.main([str(folder), "--no-stream"]) == 128 + number
    assert (signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)) == handlers
    assert not (folder / "training.json").exists()
    monkeypatch.setattr(TrainingLog, "add", add)
    assert trainer.main([str(folder), "--no-stream", "--resume"]) == 0
    result = json.loads((folder / "training.json").read_text())
    assert result["interactions"] == 240


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("run.seed=9", "made with seed = 1, but this run has 9"),
        ("train.hindsight=8", "made with hindsight = 4, but this run has 8"),
        ("train.network=plain", "made with network = headings, but this run has plain"),
        ("train.buffer=3000", "made with buffer = "),
    ],
)
def test_a_checkpoint_of_another_run_is_refused(
    tmp_path: Path, rows: Rows, override: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = run_folder(tmp_path / "run", rows, "train.hindsight=4")
    assert trainer.main([str(folder), "--no-stream"]) == 0
    other = _core.Config.from_file(folder / "config.yaml", [override])
    (folder / "config.yaml").write_text(other.yaml)
    assert trainer.main([str(folder), "--no-stream", "--resume"]) == 2
    assert message in capsys.readouterr().err


def test_a_learner_is_not_begun_anew_over_its_checkpoint(
    tmp_path: Path, rows: Rows, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = run_folder(tmp_path / "run", rows)
    assert trainer.main([str(folder), "--no-stream"]) == 0
    before = (folder / "checkpoint" / "state.pt").read_bytes()
    assert trainer.main([str(folder), "--no-stream"]) == 2
    words = "holds a learner already (checkpoint/); legal: --resume, another folder"
    assert words in capsys.readouterr().err
    assert (folder / "checkpoint" / "state.pt").read_bytes() == before


def test_files_that_are_no_checkpoints_are_refused(tmp_path: Path) -> None:
    for content in (b"", b"no", b"\x80\x02\x95", b"junk", b"hello", b"task:\n"):
        (tmp_path / "state.pt").write_bytes(content)
        with pytest.raises(
            UserError, match=r"state\.pt: is damaged or foreign; legal: a file that RTG wrote$"
        ):
            checkpoint.read(tmp_path / "state.pt")
    with pytest.raises(UserError, match="Is a directory; legal: a file to read"):
        checkpoint.read(tmp_path)
    with pytest.raises(UserError, match="no such file; legal: a checkpoint"):
        checkpoint.read(tmp_path / "absent.pt")


def test_a_checkpoint_without_its_transitions_is_refused_and_says_what_helps(
    tmp_path: Path, rows: Rows, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = run_folder(tmp_path / "run", rows)
    assert trainer.main([str(folder), "--no-stream"]) == 0
    (folder / "transitions.npz").unlink()
    assert trainer.main([str(folder), "--resume"]) == 2
    words = capsys.readouterr().err
    assert "transitions.npz: is missing, but the checkpoint" in words
    assert f"legal: {folder / 'checkpoint'} complete, or removed, to learn anew" in words


def test_missing_files_are_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert trainer.main([str(tmp_path / "absent")]) == 2
    folder = run_folder(tmp_path / "run", None)
    assert trainer.main([str(folder), "--no-stream"]) == 2
    assert "transitions.npz" in capsys.readouterr().err


def test_held_out_starts_are_legal_distinct_and_no_training_starts() -> None:
    config = _core.Config.from_file(TINY, ["train.eval_episodes=50"])
    task, starts = config.task, held_out_starts(config)
    assert len(np.unique(starts[:, 1, 0])) == 50
    assert np.abs(starts - task.start).max() <= task.start_jitter + 1e-6
    assert HELD_OUT_SEED > 2**31 - 1  # the largest legal run.seed
    final = final_starts(config, 500)
    assert not set(starts[:, 1, 0]) & set(final[:, 1, 0])


def test_the_result_is_measured_on_starts_that_did_not_stop_training(
    tmp_path: Path, rows: Rows, monkeypatch: pytest.MonkeyPatch
) -> None:
    wanted = ("train.stop_at_success=0.5", "train.stop_evaluations=1", "train.eval_every=20")
    one = training(run_folder(tmp_path / "run", rows, *wanted))
    watched = held_out_starts(one.config)

    def lucky(config, values, starts, discount):  # success on just the starts of the evaluations
        found = evaluate(config, values, starts, discount)
        return found._replace(success=np.isin(starts[:, 1, 0], watched[:, 1, 0]))

    monkeypatch.setattr("rtg.learn.training.evaluate", lucky)
    source = FileSource(one.folder / "transitions.npz", one.task, one.data)
    assert one.run(source, lambda: False, record=False)
    assert one.interactions == 20 and one.log.rows[-1]["success_rate"] == 1.0
    one.finish()
    assert json.loads((one.folder / "training.json").read_text())["success_rate"] == 0.0


def first_action(seen: np.ndarray) -> np.ndarray:
    """Returns values of actions, the largest of which is that of action 0."""
    return -np.arange(8.0) + np.zeros((len(seen), 1))


def test_evaluation_agrees_with_single_episodes() -> None:
    config = _core.Config.from_file(TINY, ["train.eval_episodes=3", "train.leave_loops=false"])
    starts = held_out_starts(config)
    starts[1] = [[-4.5, 0.0, 0.0], [-2.9, 0.0, 0.0], [1.2, 0.7, 0.0], [1.2, -0.7, 0.0]]
    found = evaluate(config, first_action, starts, discount=0.9)
    assert found.success.tolist() == [False, True, False]
    assert found.length.tolist() == [60, 1, 60]
    assert found.discounted.tolist() == [0.0, 1.0, 0.0]
    assert found.best() == 1
    assert found._replace(success=np.zeros(3, np.bool_)).best() == 0
    assert [len(path) for path in found.paths] == [61, 2, 61]
    simulator = _core.Simulator(config)
    for path in found.paths:
        after, _ = simulator.push(path[:-1], np.zeros(len(path) - 1, np.int64))
        np.testing.assert_array_equal(after, path[1:])
    assert found.summary()["success_rate"] == pytest.approx(1 / 3)


def test_an_episode_ends_in_failure_where_the_simulator_gives_up(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """This holds in a state that would be a success, too."""
    config = _core.Config.from_file(TINY, ["train.eval_episodes=2"])
    starts = held_out_starts(config)
    goal = config.task.goal_state(0)
    assert config.task.succeeded(goal[None])[0]
    starts[1] = goal

    class GivesUp:
        def __init__(self, config: _core.Config) -> None:
            pass

        def push(self, states: np.ndarray, actions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            return np.full_like(states, np.nan), np.zeros(len(states), np.bool_)

    monkeypatch.setattr("rtg.learn.evaluation._core.Simulator", GivesUp)
    found = evaluate(config, first_action, starts, discount=0.9)
    assert not found.success.any() and not found.discounted.any()
    np.testing.assert_array_equal(np.stack(found.paths), np.stack([starts, starts], axis=1))


def test_empty_transition_set_has_the_right_shapes() -> None:
    config = _core.Config.from_file(TINY)
    empty = Recorder(config).transitions()
    assert empty.poses.shape == (0, 4, 3) and empty.observation.shape == (0, 20)
