import numpy as np
import pytest
from rtg import _core
from rtg.learn.evaluation import evaluate, held_out_starts
from rtg.learn.tried_actions import TriedActions
from training_runs import TINY

VALUES = np.array([[0.2, 0.5, 0.1], [0.2, 0.5, 0.1]])


TASK = _core.Config.from_file(TINY).task


def tried(episodes: int) -> TriedActions:
    return TriedActions(episodes, TASK)


def here(*x: float) -> np.ndarray:
    return np.array(x)[:, None] * np.ones(TASK.observation_size)


def test_a_short_push_leads_to_another_state() -> None:
    """The robot pushes a box by strides of 0.15 m; what differs are places, all in 4 m."""
    short = _core.Config.from_file(TINY, ["task.push.strides=[0.15]"]).task
    states = np.stack([short.start] * 2)
    states[1, :2, 0] += 0.15
    seen = short.observation(states)
    one = TriedActions(1, short)
    one.add(seen[:1], np.array([1]))
    assert one.best_untried(seen[1:], VALUES[:1]).tolist() == [1]
    assert one.best_untried(seen[:1], VALUES[:1]).tolist() == [0]


def test_the_best_action_is_the_best_of_those_not_tried_in_a_state() -> None:
    one = tried(2)
    assert one.best_untried(here(0, 0), VALUES).tolist() == [1, 1]
    one.add(here(0, 0), np.array([1, 2]))
    assert one.best_untried(here(0, 0), VALUES).tolist() == [0, 1]
    one.add(here(0, 0), np.array([0, 1]))
    assert one.best_untried(here(0.03, -0.03), VALUES).tolist() == [2, 0]
    assert one.best_untried(here(0.05, 0), VALUES).tolist() == [1, 0]
    assert VALUES.tolist() == [[0.2, 0.5, 0.1]] * 2, "the values are not changed"


def test_one_number_that_differs_makes_another_state() -> None:
    one, seen = tried(1), here(0)
    one.add(seen, np.array([1]))
    seen = seen.copy()
    seen[0, 3] = 0.05
    assert one.best_untried(seen, VALUES[:1]).tolist() == [1]


def test_the_other_episodes_stay_as_they_are() -> None:
    one = tried(2)
    one.add(here(0, 5), np.array([1, 1]))
    assert one.best_untried(here(5, 5), VALUES).tolist() == [1, 0]
    one.keep(np.array([False, True]))
    assert one.best_untried(here(5), VALUES[:1]).tolist() == [0]


def test_where_all_are_tried_an_episode_goes_on() -> None:
    one = tried(1)
    for action in range(3):
        one.add(here(0), np.array([action]))
    assert one.best_untried(here(0), VALUES[:1]).tolist() == [0]


@pytest.mark.parametrize(("leaves", "places"), [("false", {2}), ("true", set(range(6, 22)))])
def test_an_evaluated_policy_leaves_loops_if_asked_for(leaves: str, places: set[int]) -> None:
    """Its values lead the robot north and back south, for ever."""
    wanted = ("train.eval_episodes=1", f"train.leave_loops={leaves}", "task.horizon=20")
    config = _core.Config.from_file(TINY, list(wanted))
    task, y = config.task, -4.0
    start = held_out_starts(config)[:1]
    start[0, 0] = -4.5, y, 0.0

    def values(seen: np.ndarray) -> np.ndarray:
        q = np.zeros((len(seen), task.actions))
        away = seen[:, 1] * task.position_unit > y + 0.1
        q[~away, task.headings // 4] = q[away, 3 * task.headings // 4] = 1.0
        return q

    path = evaluate(config, values, start, 0.9).paths[0]
    assert len(np.unique(path[:, 0, :2].round(1), axis=0)) in places
