"""The planner: its summary against direct calls of the search; stopping and going on."""

import csv
import json
import os
import signal
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rtg import _core
from rtg.files.run_folder import read_json
from rtg.learn import planning, trainer
from rtg.learn.evaluation import final_starts
from rtg.learn.offline_data import NoSource
from rtg.learn.planning import Plan, Planning, evaluate_plans
from rtg.processes.interrupts import Interrupts
from training_runs import TINY, run_folder, training

# A push from success, but from those starts in which another box is outside the goal, too.
NEAR = (
    "run.method=planner",
    "task.bodies.0.start=[-4.5, 0.0, 0.0]",
    "task.bodies.1.start=[-3.05, 0.0, 0.0]",
    "task.bodies.2.start=[1.95, 0.4, 0.0]",
    "task.bodies.3.start=[0.8, -1.2, 0.0]",
    "search.depth=1",
    "train.eval_episodes=8",
    "train.discount=0.5",
)
SECONDS = {"train_wall_s", "train_cpu_s"}


def planner(folder: Path) -> Planning:
    return Planning(_core.Config.from_file(folder / "config.yaml"), folder)


def result(folder: Path) -> dict:
    """Returns what a run leaves but for its seconds."""
    found = read_json(folder / "training.json")
    return {name: value for name, value in found.items() if name not in SECONDS}


def test_plans_are_judged_as_episodes_are() -> None:
    """None found, a success, one at the horizon, one beyond it, one that began in success."""
    task = _core.Config.from_file(TINY).task
    goal = task.goal_state(0)
    ends = [
        (1, task.start),
        (4, goal),
        (task.horizon + 1, goal),
        (task.horizon + 2, goal),
        (1, goal),
    ]
    plans = [Plan(np.stack([end] * states), 9, 0.0, 0.0) for states, end in ends]
    found = evaluate_plans(task, plans, discount=0.5)
    assert found.success.tolist() == [False, True, True, False, False]
    assert found.length.tolist() == [task.horizon, 3] + [task.horizon] * 3
    assert found.discounted.tolist() == [0.0, 0.25, 0.5 ** (task.horizon - 1), 0.0, 0.0]
    assert found.best() == 1 and found.paths[1] is plans[1].states


def test_the_result_is_that_of_a_search_from_each_final_start(tmp_path: Path) -> None:
    folder = run_folder(tmp_path / "run", None, *NEAR)
    assert trainer.main([str(folder), "--no-stream"]) == 0
    config = _core.Config.from_file(folder / "config.yaml")
    starts = final_starts(config, 8)
    states, pushes = zip(*(_core.plan(config, one[None]) for one in starts), strict=True)
    success = np.array([len(one) == 2 for one in states])  # a layer finds one action, or none
    assert 0 < success.sum() < 8
    assert result(folder) == {
        "interactions": 0,
        "gradient_steps": 0,
        "online_successes": 0,
        "success_rate": success.mean(),
        "episode_length_mean": np.where(success, 1, config.task.horizon).mean(),
        "episode_return_mean": success.mean(),
        "offline_transitions": 0,
        "learning_pushes": sum(pushes),
        "final_episodes": 8,
    }
    with np.load(folder / "best_episode.npz") as best:
        assert best["success"]
        np.testing.assert_array_equal(best["poses"], states[int(success.argmax())])
    assert not (folder / "model.pt").exists()


def test_what_it_took_is_written_down(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = run_folder(tmp_path / "run", None, *NEAR)
    costs = iter(range(1, 9))
    start = np.stack([_core.Config.from_file(folder / "config.yaml").task.start])
    monkeypatch.setattr(
        planning, "plan", lambda *_: Plan(start, 10 * (k := next(costs)), 0.5 * k, 0.25 * k)
    )
    one = planner(folder)
    assert one.run(NoSource(), lambda: False, record=False)
    one.finish()
    with (folder / "progress.csv").open() as file:
        (row,) = csv.DictReader(file)
    assert (row["interactions"], row["pushes"], row["success_rate"]) == ("0", "360", "0")
    assert (row["wall_s"], row["cpu_s"]) == ("18", "9")
    found = read_json(folder / "training.json")
    assert (found["train_wall_s"], found["train_cpu_s"]) == (18.0, 9.0)


def test_the_time_of_all_workers_counts() -> None:
    def plan(workers: int) -> planning.Plan:
        config = _core.Config.from_file(TINY, [f"run.workers={workers}", "search.depth=4"])
        return planning.plan(config, config.task.start, None)

    one, two = plan(1), plan(2)
    assert two.pushes == one.pushes > 0 and two.wall_s > 0
    # Pushes of Box2D take 50 µs or more. Two workers share those of one, and both count.
    assert two.cpu_s > 2e-5 * two.pushes
    assert two.cpu_s > 0.7 * one.cpu_s


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_stops_it_between_starts_and_it_goes_on(
    tmp_path: Path, number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole, cut = (run_folder(tmp_path / name, None, *NEAR) for name in ("whole", "cut"))
    assert trainer.main([str(whole), "--no-stream"]) == 0
    asked, search, heard = [], planning.plan, threading.Event()

    class Hearing(Interrupts):
        def _handle(self, *words: Any) -> None:
            super()._handle(*words)
            heard.set()

    def noted(config: _core.Config, start: np.ndarray, replay: None) -> Plan:
        asked.append(start)
        if len(asked) == 3:
            os.kill(os.getpid(), number)
            assert heard.wait(60.0)  # the main thread hears it
        return search(config, start, replay)

    monkeypatch.setattr(planning, "plan", noted)
    monkeypatch.setattr(trainer, "Interrupts", Hearing)
    assert trainer.main([str(cut), "--no-stream"]) == 128 + number
    assert len(asked) == 3 and not (cut / "training.json").exists()
    assert not json.loads((cut / "training_state.json").read_text())["done"]
    assert trainer.main([str(cut), "--no-stream", "--resume"]) == 0
    starts = final_starts(_core.Config.from_file(cut / "config.yaml"), 8)
    np.testing.assert_array_equal(asked, starts)
    assert result(cut) == result(whole)
    files = [(folder / "best_episode.npz").read_bytes() for folder in (whole, cut)]
    assert files[0] == files[1]


@pytest.mark.parametrize(
    ("changes", "kept"),
    [
        ([], 8),
        (["train.eval_episodes=5"], 5),
        (["train.eval_episodes=9"], 8),
        (["train.randomise=true", "task.randomisation=0.3"], 0),
    ],
)
def test_plans_are_taken_over_where_the_starts_are_the_same(
    tmp_path: Path, changes: list[str], kept: int
) -> None:
    folder = run_folder(tmp_path / "run", None, *NEAR)
    one = planner(folder)
    assert one.run(NoSource(), lambda: False, record=False)
    config = _core.Config.from_file(folder / "config.yaml", changes)
    other = Planning(config, folder)
    other.restore()
    assert len(other.plans) == kept
    for found, known in zip(other.plans, one.plans, strict=False):
        np.testing.assert_array_equal(found.states, known.states)
        assert found[1:] == known[1:]


def test_it_does_not_go_on_from_a_learners_checkpoint(tmp_path: Path, capsys) -> None:
    folder = run_folder(tmp_path / "run", None, "run.method=ddqn")
    training(folder).save()
    changes = ["train.learner=planning", "train.interact=false"]
    config = _core.Config.from_file(folder / "config.yaml", changes)
    (folder / "config.yaml").write_text(config.yaml)
    assert trainer.main([str(folder), "--no-stream", "--resume"]) == 2
    words = "made with learner = q_learning, but this run has planning"
    assert words in capsys.readouterr().err
