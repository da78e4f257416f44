"""The plan of a transition set that is shown where nothing was learned."""

import numpy as np
import pytest
import scaled
from rtg import _core, paths
from rtg.files.dataset import SOURCES, Transitions
from rtg.files.episodes import replayed_plan, replayed_plans, simulated

CONFIG = _core.Config.from_file(paths.CONFIG / "gathering.yaml")
TASK = CONFIG.task


def push(state, action):
    after, ok = _core.Simulator(CONFIG).push(state[None], np.array([action]))
    assert ok[0]
    return after[0]


def row(state, action, *, source="tree", shift=0.0, success=False):
    """A true transition whose begin was then moved by `shift` [m], as the next step of a tree."""
    begin = state.copy()
    begin[0, 0] += shift
    return begin, action, push(begin, action), success, SOURCES.index(source)


def transitions(*rows):
    poses, action, after, success, source = (np.array(column) for column in zip(*rows, strict=True))
    nothing = np.zeros((len(rows), TASK.observation_size), np.float32)
    success = success.astype(bool)
    return Transitions(
        poses=poses,
        action=action.astype(np.int32),
        next_poses=after,
        reward=success.astype(np.float32),
        terminated=success,
        observation=nothing,
        next_observation=nothing,
        source=source.astype(np.int8),
    )


FIRST = row(TASK.start, 24)
SECOND = row(FIRST[2], 12, shift=0.1)
LAST = row(SECOND[2], 24, shift=-0.2, success=True)  # said to succeed: it shows where plans end


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 0, 1)])
def test_a_plan_is_replayed_from_its_first_step_end_to_end(order):
    """Each step begins a little off where the one before it ends."""
    rows = [(FIRST, SECOND, LAST)[k] for k in order]
    states = replayed_plan(CONFIG, transitions(*rows))
    expected = [TASK.start]
    for action in (24, 12, 24):
        expected.append(push(expected[-1], action))
    assert np.array_equal(states, expected)


def test_steps_that_lead_to_no_success_are_no_plan():
    far = row(FIRST[2], 12, shift=0.3)  # begins too far from where the first one ends
    last = row(far[2], 24, success=True)
    states = replayed_plan(CONFIG, transitions(FIRST, far, last))
    assert np.array_equal(states[0], far[0]) and len(states) == 3
    assert replayed_plan(CONFIG, transitions(FIRST, SECOND)) is None
    assert replayed_plan(CONFIG, transitions((*FIRST[:4], SOURCES.index("branch")))) is None


def test_branches_are_no_steps_of_a_plan():
    branch = row(FIRST[2], 12, source="branch")
    states = replayed_plan(CONFIG, transitions(FIRST, branch, row(branch[2], 24, success=True)))
    assert len(states) == 2 and np.array_equal(states[0], branch[2])


def test_a_round_trip_of_steps_leads_nowhere():
    """Their lengths are never known, and the search for them ends."""
    back = row(FIRST[2], 0)
    assert np.abs(back[2] - TASK.start).max() < 0.1
    apart = row(np.roll(TASK.start, 1, axis=1) * [1.0, 1.0, 0.0], 3, success=True)
    states = replayed_plan(CONFIG, transitions(FIRST, back, apart))
    assert len(states) == 2 and np.array_equal(states[0], apart[0])


def test_of_many_plans_the_nearest_to_the_start_that_succeeds_is_shown():
    """And it ends with its success, though its plan would go on."""
    solved = TASK.start.copy()
    solved[1:, :2] = [[-1.0, 0.0], [1.0, 0.0], [0.0, 1.2]]
    solved[0, :2] = (0.0, -5.0)
    fails = row(TASK.start, 24, success=True)
    succeeds = row(solved, 24)
    beyond = row(succeeds[2], 24, success=True)
    states = replayed_plan(CONFIG, transitions(fails, succeeds, beyond))
    assert np.array_equal(states, [solved, succeeds[2]]) and TASK.succeeded(states[-1:])[0]
    assert np.array_equal(replayed_plan(CONFIG, transitions(fails)), [TASK.start, fails[2]])


def test_plans_are_whole_episodes_and_those_within_them_are_left_out():
    """Each with its own result, said of where it ends."""
    again = row(TASK.start, 6, success=True)
    found = replayed_plans(CONFIG, transitions(FIRST, SECOND, LAST, again))
    assert sorted(episode.action.tolist() for episode in found) == [[6], [24, 12, 24]]
    for episode in found:
        assert episode.poses.shape == (len(episode.action) + 1, TASK.bodies, 3)
        assert not episode.success  # as the simulator has it
        for step, action in enumerate(episode.action):
            assert np.array_equal(episode.poses[step + 1], push(episode.poses[step], action))


def test_of_plans_those_nearest_to_the_start_come_first_and_may_be_counted():
    far = TASK.start.copy()
    far[0, 1] += 0.5
    rows = transitions(row(far, 6, success=True), row(TASK.start, 6, success=True))
    near, other = replayed_plans(CONFIG, rows)
    assert np.array_equal(near.poses[0], TASK.start) and np.array_equal(other.poses[0], far)
    (only,) = replayed_plans(CONFIG, rows, 1)
    assert np.array_equal(only.poses, near.poses)


def test_without_a_success_there_are_no_plans():
    assert replayed_plans(CONFIG, transitions(FIRST, SECOND)) == []


def test_an_episode_ends_at_the_horizon_and_after_a_success():
    short = _core.Config.from_file(paths.CONFIG / "gathering.yaml", ["task.horizon=3"])
    solved = TASK.start.copy()
    solved[1:, :2] = [[-1.0, 0.0], [1.0, 0.0], [0.0, 1.2]]
    solved[0, :2] = (0.0, -5.0)
    long, done = simulated(short, [TASK.start, solved], [np.array([6] * 5), np.array([24] * 5)])
    assert len(long.action) == 3 and not long.success
    assert len(done.action) == 1 and done.success


def test_an_episode_stops_before_a_push_that_the_simulator_cannot_finish(monkeypatch):
    class Rejects:
        def __init__(self, config):
            self.core = Simulator(config)

        def push(self, states, actions):
            after, ok = self.core.push(states, actions)
            return after, ok & (actions != 7)

    Simulator = _core.Simulator  # noqa: N806
    monkeypatch.setattr("rtg.files.episodes._core.Simulator", Rejects)
    cut, none, whole = simulated(
        CONFIG, [TASK.start] * 3, [np.array([6, 7, 6]), np.array([7]), np.array([6, 6])]
    )
    assert (cut.action.tolist(), len(cut.poses)) == ([6], 2)
    assert (none.action.tolist(), len(none.poses)) == ([], 1)
    assert whole.action.tolist() == [6, 6]


def test_plans_are_found_in_a_task_of_any_size():
    """Steps of a robot of 4 cm begin as far apart, in its units, as those of one of 80 cm."""
    small = scaled.gathering(1 / 20)
    joined = transitions(FIRST, SECOND, LAST)
    assert np.array_equal(replayed_plan(small, joined), replayed_plan(CONFIG, joined))
    far = row(FIRST[2], 12, shift=0.3)
    apart = transitions(FIRST, far, row(far[2], 24, success=True))
    assert len(replayed_plan(small, apart)) == len(replayed_plan(CONFIG, apart)) == 3
