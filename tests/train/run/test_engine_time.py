"""What a run with a forward simulator of Python says before it begins."""

import itertools
import re
from pathlib import Path

import numpy as np
import pytest
import rtg
from rtg import _core
from rtg.run import engine_time
from rtg.run.plan import make_plan
from rtg.run.run_args import parse

TOYS = Path(__file__).parents[1] / "engines"
GHOST = "forward.engine=toy_engines:Ghost"


@pytest.fixture(autouse=True)
def _toys_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(TOYS))


def test_simulators_of_the_core_are_not_waited_for() -> None:
    assert engine_time.words(rtg.load_task("gathering").config, 49000, 350000) == []


@pytest.mark.parametrize("name", ["gathering", "push_t", "art_manip", "drawer", "insert", "cable"])
def test_the_trial_is_of_pushes_that_meet_a_body(name: str) -> None:
    task = rtg.load_task(name)
    states, actions = engine_time.meeting_pushes(task.core)
    ends, _ = _core.Simulator(task.config).push(states, actions)
    moved = task.core.moved(states, ends)[:, 1:].any(axis=1)
    assert moved.mean() > 0.8


class Crowded:
    """A task in which the robot has no room beside a body."""

    def __init__(self, task: _core.Task) -> None:
        self.actions, self.ways, self.fixed, self.start = (
            task.actions,
            task.ways,
            task.fixed,
            task.start,
        )

    def is_legal(self, states: np.ndarray) -> np.ndarray:
        return np.zeros(len(states), np.bool_)


def test_without_room_beside_a_body_the_pushes_are_those_of_the_start() -> None:
    task = rtg.load_task("gathering").core
    states, actions = engine_time.meeting_pushes(Crowded(task))
    assert (states == task.start).all() and (actions == np.arange(48)).all()


def test_the_time_is_that_of_one_push_in_a_batch_of_a_second(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock = itertools.count(0.0, 0.25)
    monkeypatch.setattr(engine_time.time, "perf_counter", lambda: next(clock))
    # A trial of one push takes 0.25 s, so that four are timed, together.
    assert engine_time.push_seconds(rtg.load_task("gathering", [GHOST]).config) == 0.25 / 4


def test_the_pushes_are_counted_and_timed(tmp_path: Path) -> None:
    words = ["gathering", "--in-process", "--set", GHOST]
    # 4 pushes for each of 49,000 transitions; 350,000 interactions, 140 evaluations of 100 episodes
    # and a final one of 1,000
    time = r"\d+:\d\d(:\d\d)?"
    said = r"forward.engine toy_engines:Ghost: \S+ ms a push that meets a body"
    generating = rf"; about 196,000 for the transitions, {time}"
    learning = rf"; up to 1,250,000 for learning, {time}"
    for method, expected in {
        "ddqn_rtg": said + generating + learning,
        "bc_rtg": said + generating,
        "planner": said,
    }.items():
        out = ["--out", str(tmp_path / method)]
        (note,) = make_plan(parse([*words, "--method", method, *out])).notes
        assert re.fullmatch(expected, note), note
        assert make_plan(parse(["--resume", *out])).notes == ()
