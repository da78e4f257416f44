"""Which stored transitions form episodes, in sets of every generator."""

import numpy as np
import pytest
from rtg import _core, paths
from rtg.files.chains import chains_of

STEP, BRANCH, WALK = (_core.SOURCES.index(name) for name in ("tree", "branch", "walk"))
TASK = paths.CONFIG / "gathering.yaml"


def chains(*rows, success=(), source=None):
    """Of rows between numbered states: (from, to). `success`: rows that end in one."""
    poses = np.array([np.full((2, 3), begin, float) for begin, _ in rows])
    after = np.array([np.full((2, 3), end, float) for _, end in rows])
    terminated = np.isin(np.arange(len(rows)), success)
    return chains_of(poses, after, terminated, np.int8(source or [WALK] * len(rows)))


def test_walks_that_were_stored_side_by_side_are_told_apart():
    found = chains((0, 1), (10, 11), (1, 2), (11, 12), (2, 3))
    assert found.episode.tolist() == [0, 1, 0, 1, 0]
    assert found.step.tolist() == [0, 0, 1, 1, 2]
    assert found.truncated.tolist() == [False, False, False, True, True]


def test_a_success_ends_an_episode_and_is_not_cut_off():
    found = chains((0, 1), (1, 2), (2, 3), success=[1])
    assert found.episode.tolist() == [0, 0, 1]
    assert found.truncated.tolist() == [False, False, True]


def test_an_episode_goes_on_in_one_row_alone():
    """Of several rows from the state the first one; of several into it the last one."""
    found = chains((0, 2), (1, 2), (2, 3), (2, 4), (5, 2))
    assert found.episode.tolist() == [0, 1, 1, 2, 3]
    assert found.step.tolist() == [0, 0, 1, 0, 0]


def test_earlier_rows_and_the_row_itself_do_not_continue_a_row():
    """So there is no way round: a push that moves nothing, and back to where it began."""
    found = chains((1, 1), (1, 2), (2, 1))
    assert found.step.tolist() == [0, 1, 2] and found.episode.tolist() == [0, 0, 0]
    found = chains((1, 2), (0, 1))
    assert found.step.tolist() == [0, 0] and found.episode.tolist() == [0, 1]


def test_branches_stand_alone():
    found = chains((0, 1), (0, 5), (1, 2), (5, 6), source=[STEP, BRANCH, STEP, STEP])
    assert found.episode.tolist() == [0, 1, 0, 2]
    assert found.truncated.tolist() == [False, True, True, True]


def test_states_that_differ_in_one_bit_are_different():
    poses = np.array([[[0.0, 0.0, 0.0]], [[np.nextafter(1.0, 2.0), 0.0, 0.0]]])
    after = np.array([[[1.0, 0.0, 0.0]], [[2.0, 0.0, 0.0]]])
    found = chains_of(poses, after, np.zeros(2, bool), np.zeros(2, np.int8))
    assert found.episode.tolist() == [0, 1]


def test_no_rows_have_no_episodes():
    none = np.zeros((0, 4, 3))
    found = chains_of(none, none, np.zeros(0, bool), np.zeros(0, np.int8))
    assert [len(column) for column in found] == [0, 0, 0]


def generated(generator):
    settings = [f"search.generator={generator}", "search.transitions=2000"]
    config = _core.Config.from_file(TASK, settings)
    parts = []

    def store(poses, action, after, success, source):
        parts.append((poses.copy(), after.copy(), success.copy(), source.copy()))

    _core.generate(config, store, lambda progress: None)
    return [np.concatenate(column) for column in zip(*parts, strict=True)]


@pytest.mark.parametrize(
    ("generator", "mean"), [("rrbs", 1.0), ("naive", 1.0), ("forward", 1.2), ("scatter", 2.0)]
)
def test_episodes_of_every_generator_are_ways_of_the_simulator(generator, mean):
    """Longer than `mean` [steps]: of trees some plans are stored whole, of the others one step."""
    poses, after, success, source = generated(generator)
    found = chains_of(poses, after, success, source)
    order = np.lexsort((found.step, found.episode))
    joined = found.episode[order[1:]] == found.episode[order[:-1]]
    before, then = order[:-1][joined], order[1:][joined]
    assert np.array_equal(after[before], poses[then]) and not success[before].any()
    assert (found.step[then] == found.step[before] + 1).all()
    steps = source != BRANCH
    assert steps.sum() / len(np.unique(found.episode[steps])) > mean
    is_last = np.isin(np.arange(len(source)), before, invert=True)
    assert np.array_equal(found.truncated, is_last & ~success)


def test_random_walks_are_told_apart():
    """400 steps of 50 walks, but for walks that come to a step which is stored already."""
    poses, after, success, source = generated("random")
    steps = source != BRANCH
    found = chains_of(poses, after, success, source)
    assert 50 <= len(np.unique(found.episode[steps])) < 60
