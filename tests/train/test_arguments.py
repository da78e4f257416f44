"""Arguments that are not legal are refused at the door: the error names them and what is legal."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import rtg
from rtg.arguments import checked
from rtg.envs.push_env import PushEnv
from rtg.envs.push_vector_env import PushVectorEnv

TASK = rtg.load_task("push_t")  # one object, 48 actions
STATE = TASK.start()
ENERGY = rtg.StepEnergy(TASK)
A_TASK = "legal: an object of class Task"
TEXTS = 'legal: a list of texts, such as ["search.breadth=20"]'
STATES = "legal: an array of numbers [N, 2, 3]"
Call = Callable[[], object]

WRONG_KINDS: dict[str, Call] = {
    "data []; legal: an object of class Transitions": lambda: rtg.train([], TASK, "run"),
    f"task 'push_t'; {A_TASK}": lambda: rtg.generate("push_t"),
    f"task None; {A_TASK}": lambda: rtg.ReverseSimulator(None),
    f"task 3; {A_TASK}": lambda: rtg.StepEnergy(3),
    f"task 4; {A_TASK}": lambda: rtg.forward.Box2D(4),
    f"task 5; {A_TASK}": lambda: rtg.BeamSearch(5),
    f"task 6; {A_TASK}": lambda: rtg.Transitions.load("a.npz", 6),
    "config 'push_t'; legal: an object of class Config": lambda: rtg.Task("push_t"),
    "seed 'a'; legal: a whole number from 0 on": lambda: TASK.goal_state(seed="a"),
    "seed 0.5; legal: a whole number from 0 on": lambda: TASK.start(seed=0.5),
    "seed None; legal: a whole number from 0 on": lambda: rtg.generate(TASK, seed=None),
    "count '9'; legal: a whole number from 0 on or None": lambda: rtg.generate(TASK, "9"),
    "threads 'a'; legal: a whole number from 0 on": lambda: rtg.ReverseSimulator(TASK).solve(
        STATE, [0], threads="a"
    ),
    f"settings 'a=b'; {TEXTS}": lambda: rtg.load_task("push_t", "a=b"),
    f"settings {{'a': 3}}; {TEXTS}": lambda: rtg.load_task("push_t", {"a": 3}),
    f"settings [3]; {TEXTS}": lambda: rtg.generate(TASK, settings=[3]),
    f"settings 'c=d'; {TEXTS}": lambda: rtg.BeamSearch(TASK, settings="c=d"),
    f"settings 'e=f'; {TEXTS}": lambda: PushEnv(settings="e=f"),
    f"settings 'g=h'; {TEXTS}": lambda: PushVectorEnv(settings="g=h"),
    "jitter 'a'; legal: a number or None": lambda: PushEnv(jitter="a"),
    "run 3; legal: a text or a path": lambda: rtg.load_policy(3),
    "task 7; legal: a text or a path": lambda: rtg.load_task(7),
}
WRONG_VALUES: dict[str, Call] = {
    "seed -1; legal: a whole number from 0 on": lambda: TASK.goal_state(-1),
    f"seed {2**63}; legal: a whole number from 0 on": lambda: TASK.start(2**63),
    f"states 'abc'; {STATES}": lambda: TASK.succeeded("abc"),
    "states of shape [1]; legal: [N, 2, 3]": lambda: TASK.observation([0.5]),
    "state of shape [1]; legal: [2, 3]": lambda: TASK.outlines([0.5]),
    "state of shape [2]; legal: [2, 3]": lambda: ENERGY.gaps([1, 2]),
    "now of shape [1]; legal: [2, 3]": lambda: ENERGY.value(STATE, [1]),
    "forces of shape [1]; legal: [": lambda: ENERGY.value(STATE, STATE, [1]),
    "target of shape [1]; legal: [2, 3]": lambda: rtg.BeamSearch(TASK, [1]),
    "end_poses of shape [1]; legal: [N, 2, 3]": lambda: rtg.ReverseSimulator(TASK).solve([0.5], 0),
    "end_poses of shape [1, 1]; legal: [2, 3]": lambda: rtg.ReverseSimulator(TASK).solve([[1]], 0),
    "actions of type float64; legal: whole numbers": lambda: rtg.ReverseSimulator(TASK).solve(
        STATE, [0.5]
    ),
    "actions of type <U1; legal: whole numbers": lambda: rtg.forward.Newton(TASK).push(
        STATE[None], ["a"]
    ),
    "ways of shape [1]; legal: [N, 2]": lambda: rtg.forward.Newton(TASK).push_along(
        STATE[None], [1.0]
    ),
    "parts []; legal: objects of rtg.Transitions": lambda: rtg.Transitions.joined([]),
    "parts ['a']; legal: objects of rtg.Transitions": lambda: rtg.Transitions.joined(["a"]),
    "push_tt: no task of that name (did you mean 'push_t'?); legal: ": lambda: rtg.load_task(
        "push_tt"
    ),
}


@pytest.mark.parametrize("message", WRONG_KINDS)
def test_a_value_of_another_kind_is_named(message: str) -> None:
    with pytest.raises(TypeError) as error:
        WRONG_KINDS[message]()
    assert str(error.value) == message


@pytest.mark.parametrize("message", WRONG_VALUES)
def test_a_value_that_is_not_legal_is_named(message: str) -> None:
    with pytest.raises(ValueError) as error:
        WRONG_VALUES[message]()
    assert str(error.value).startswith(message)


def test_numbers_of_numpy_are_numbers() -> None:
    np.testing.assert_array_equal(TASK.start(np.int64(3)), TASK.start(3))
    assert PushEnv("push_t", jitter=np.float32(0.0)).jitter == 0.0


def test_no_actions_are_legal() -> None:
    assert rtg.ReverseSimulator(TASK).solve(STATE, []).status == []


def test_what_has_no_checked_annotation_passes() -> None:
    @checked
    def add(a: int | np.ndarray, b: Path | None, *rest: object) -> object:
        return a, b, rest

    assert add(-1, None, "c") == (-1, None, ("c",))
    with pytest.raises(TypeError, match=r"b 'x'; legal: a path or None"):
        add(1, "x")
