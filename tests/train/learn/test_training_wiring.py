"""Checks what the trainer makes of the settings, and that its parts work with the same values."""

from pathlib import Path

import numpy as np
import pytest
from rtg import _core
from rtg.files.dataset import Rows
from rtg.learn.evaluation import evaluate, held_out_starts
from rtg.learn.stages import STAGES
from rtg.learn.training import MAX_ENVIRONMENTS
from rtg.learn.training_result import figures
from rtg.learn.value_bounds import value_bounds
from training_runs import TINY, Stream, after_polls, run_folder, training


@pytest.mark.parametrize(
    ("setting", "discount"), [("train.discount=0.7", 0.7), ("train.discount=0", 0.8)]
)
def test_learner_bounds_and_evaluation_have_one_discount(
    tmp_path: Path, rows: Rows, setting: str, discount: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """train.discount, or the task's, 0.8, if that is 0."""
    one, used = training(run_folder(tmp_path / "run", None, setting)), set[float]()

    def watched(config, values, starts, discount):
        used.add(discount)
        return evaluate(config, values, starts, discount)

    monkeypatch.setattr("rtg.learn.training.evaluate", watched)
    trees = Stream(rows.slice(0, 350), one.data, piece=300)  # at 350 complete, but hardly grown
    assert one.run(trees, lambda: False, record=False)
    assert one.task.discount == 0.8
    assert one.model.discount == discount and used == {discount}
    seen, bound = one.data.record.transitions(), one.model.replay.offline.rows["bound"]
    proven = value_bounds(seen.observation, seen.next_observation, seen.reward, discount)
    np.testing.assert_array_equal(bound[: len(proven)], proven)
    assert (proven[300:] > 0).any()


def test_bounds_are_proven_before_all_transitions_are_in(tmp_path: Path, rows: Rows) -> None:
    one = training(run_folder(tmp_path / "run", None))
    stream = Stream(rows, one.data, piece=400)
    assert not one.run(stream, after_polls(3), record=False)
    bound = one.model.replay.offline.rows["bound"]
    assert not stream.complete and ((bound > 0) & (bound < 1)).any()


def test_a_learner_has_as_many_threads_as_the_run_has_workers(tmp_path: Path) -> None:
    one = training(run_folder(tmp_path / "run", None, "run.workers=3"))
    assert one.model.threads == 3
    one.model.share_process()  # with other learners, on a thread each
    assert one.model.threads == 1


@pytest.mark.parametrize("randomise", [False, True])
def test_training_starts_are_jittered(tmp_path: Path, randomise: bool) -> None:
    """They are by train.start_jitter, or all over task.randomisation where it is asked for."""
    method = "ddqn_rtg_dr" if randomise else "ddqn_rtg"
    wanted = (
        "train.start_jitter=0.2",
        "task.randomisation=0.3",
        f"run.method={method}",
        "train.eval_episodes=50",
    )
    one = training(run_folder(tmp_path / "run", None, *wanted))
    drawn = []
    for _ in range(50):
        one.env.reset()
        drawn.append(one.env.state()["poses"] - one.task.start)
    jitter = 0.3 if randomise else 0.2
    spread = np.abs(np.concatenate(drawn)[:, 1:, :2]).max(axis=0)  # [objects, x and y]
    assert (spread <= jitter).all() and (spread > 0.9 * jitter).all()
    judged = np.abs(held_out_starts(one.config) - one.task.start)[:, 1:, :2].max()
    assert judged <= 0.1 if not randomise else 0.2 < judged <= 0.3


def test_the_least_legal_buffer_takes_a_step_of_all_environments(
    tmp_path: Path, rows: Rows
) -> None:
    with pytest.raises(_core.ConfigError, match=f"legal: an integer from {MAX_ENVIRONMENTS} to "):
        _core.Config.from_file(TINY, [f"train.buffer={MAX_ENVIRONMENTS - 1}"])
    one = training(run_folder(tmp_path / "run", None, "search.transitions=4", "train.buffer=4"))
    assert one.env.count == MAX_ENVIRONMENTS
    assert one.run(Stream(rows.slice(0, 4), one.data, piece=4), lambda: False, record=False)
    assert one.interactions == 240


def test_the_seconds_of_a_run_go_on_where_it_is_resumed(tmp_path: Path) -> None:
    one = training(run_folder(tmp_path / "run", None))
    one.clock.restore({"wall_s": 1e6, "cpu_s": 2e6})
    one.save()
    other = training(one.folder)
    other.restore()
    assert other.clock.seconds() == {"wall_s": 1e6, "cpu_s": 2e6}


def test_each_stage_of_learning_has_its_times_and_they_go_on_where_it_is_resumed(
    tmp_path: Path, rows: Rows
) -> None:
    one = training(run_folder(tmp_path / "run", None, "train.checkpoint_every=80"))
    assert one.run(Stream(rows, one.data, piece=60), lambda: False, record=False)
    found = one.model.stages.seconds()
    assert set(found) == set(STAGES)
    assert all(times["wall_s"] > 0 for times in found.values()), found
    assert figures(one, one.evaluate())["learning_stages"] == found
    other = training(one.folder)
    other.restore()
    saved = other.model.stages.seconds()
    assert all(saved[name]["wall_s"] > 0.5 * found[name]["wall_s"] for name in STAGES)
