"""Checks which starts the reverse curriculum keeps, and where the next ones come from."""

import numpy as np
import pytest
from rtg import _core, paths
from rtg.envs import curriculum
from rtg.envs.curriculum import (
    EPISODES_PER_START,
    MIN_GOOD_STARTS,
    NEW_STARTS,
    NOT_FROM_CURRICULUM,
    OLD_STARTS,
    PUSHES_PER_WALK,
    WALKS,
    Curriculum,
)
from rtg.envs.training_environments import TrainingEnvironments
from rtg.errors import UserError

CONFIG = _core.Config.from_file(paths.CONFIG / "gathering.yaml")
TASK = CONFIG.task


def play_round(one: Curriculum, solved: dict[int, int]) -> np.ndarray:
    """The pool of a round in which start k is solved `solved[k]` times, else never.

    It plays EPISODES_PER_START episodes per start. An episode from start k takes k pushes.
    """
    pool = one.pool
    numbers = [one.draw()[0] for _ in range(EPISODES_PER_START * len(pool))]
    for count, number in enumerate(numbers):
        k = number - numbers[0]
        one.record_episode(number, success=count // len(pool) < solved.get(k, 0), length=k)
    return pool


def near(states: np.ndarray, seeds: np.ndarray) -> np.ndarray:
    """Tells of each state whether an object is where that of one of the seeds is. [states]"""
    moved = np.abs(states[:, None, 1:] - seeds[None, :, 1:]).max(axis=3) > 1e-9
    return ~moved.all(axis=2).all(axis=1)


def test_the_first_starts_are_near_goals_and_do_not_meet_them() -> None:
    pool = Curriculum(CONFIG, 1.0, seed=1).pool
    assert pool.shape == (NEW_STARTS, TASK.bodies, 3)
    assert not TASK.succeeded(pool).any()
    assert (np.linalg.norm(pool[:, 1:, :2], axis=2) < 2.0).mean() > 0.4  # at the start none is
    assert len(np.unique(pool[:, 0, 0])) > NEW_STARTS / 2


class Rarely:
    """A task whose goal states are drawn in vain but for three."""

    def goal_state(self, seed: int, index: int) -> np.ndarray | None:
        return np.full((2, 3), seed + index) if index in (1, 41, 99) else None


class Never(Rarely):
    def goal_state(self, seed: int, index: int) -> np.ndarray | None:
        return None


def test_draws_of_goal_states_in_vain_are_left_out() -> None:
    found = curriculum.goal_states(Rarely(), seed=5)
    np.testing.assert_array_equal(found[:, 0, 0], [6, 46, 104])
    with pytest.raises(UserError, match="goal: 100 random draws gave no goal state"):
        curriculum.goal_states(Never(), seed=5)


def test_pushes_of_the_walks_are_counted() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    assert one.pushes == PUSHES_PER_WALK * WALKS
    for number in range(NEW_STARTS * EPISODES_PER_START):
        one.record_episode(number % NEW_STARTS, success=False, length=60)
    assert one.pushes == 2 * PUSHES_PER_WALK * WALKS


def test_starts_are_drawn_in_turn_and_as_often_as_asked() -> None:
    every = Curriculum(CONFIG, 1.0, seed=1)
    numbers = [every.draw()[0] for _ in range(2 * NEW_STARTS)]
    assert numbers == [*range(NEW_STARTS), *range(NEW_STARTS)]
    some = Curriculum(CONFIG, 0.25, seed=1)
    drawn = [some.draw() for _ in range(4000)]
    share = np.mean([number != NOT_FROM_CURRICULUM for number, _ in drawn])
    assert abs(share - 0.25) < 4 * np.sqrt(0.25 * 0.75 / 4000)  # four sigma
    assert all((number == NOT_FROM_CURRICULUM) == (start is None) for number, start in drawn)


def test_starts_that_are_solved_now_and_then_are_kept_and_seed_the_next() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    kept = list(range(3, 3 + MIN_GOOD_STARTS))
    pool = play_round(one, {**{k: 1 + k % 2 for k in kept}, 31: EPISODES_PER_START})
    good = pool[kept]
    np.testing.assert_array_equal(one.state()["good"], good)
    np.testing.assert_array_equal(one.state()["seeds"], good)
    assert near(one.pool, good).mean() > 0.8
    far = pool[~near(pool, good)]
    assert len(far) > 15 and not near(one.pool, far).any()
    assert len(one.pool) == NEW_STARTS, "no good ones of earlier rounds yet"


def test_old_good_starts_are_played_again() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    good = play_round(one, {k: 1 for k in range(OLD_STARTS + 10)})[: OLD_STARTS + 10]
    play_round(one, {0: 1})
    assert len(one.pool) == NEW_STARTS + OLD_STARTS
    replayed = one.pool[NEW_STARTS:]
    known = {start.tobytes() for start in good}
    assert len({start.tobytes() for start in replayed} & known) == OLD_STARTS


def test_with_few_good_starts_those_mastered_with_most_pushes_seed_too() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    mastered = {k: EPISODES_PER_START for k in (5, 9, 20, 30, 31)}
    pool = play_round(one, {2: 1, **mastered})
    np.testing.assert_array_equal(one.state()["seeds"], pool[[2, 31, 30, 20]])
    np.testing.assert_array_equal(one.state()["good"], pool[[2]])


def test_mastered_starts_that_are_played_again_seed_nothing() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    play_round(one, {k: 1 for k in range(OLD_STARTS)})
    assert len(play_round(one, {})) == NEW_STARTS
    assert len(one.pool) == NEW_STARTS + OLD_STARTS
    always = dict.fromkeys((4, 6, NEW_STARTS + 1), EPISODES_PER_START)
    pool = play_round(one, {**always, NEW_STARTS + 2: 1})
    np.testing.assert_array_equal(one.state()["seeds"], pool[[NEW_STARTS + 2, 6]])


def test_without_a_solved_start_walks_begin_again_where_the_last_ones_did() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    first = one.state()["seeds"]
    pool = play_round(one, {})
    np.testing.assert_array_equal(one.state()["seeds"], first)
    assert len(one.state()["good"]) == 0
    assert not np.array_equal(one.pool, pool), "the walks are others"


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_pool_moves_outwards_with_a_learner_that_masters_more_and_more(seed: int) -> None:
    """It solves starts whose boxes are no further out in all than a reach that grows by 0.5 m a
    round, half of those up to 1 m beyond, and needs a push for each metre."""
    one, reach, ways = Curriculum(CONFIG, 1.0, seed), 1.0, []
    rng = np.random.default_rng(seed)
    for _ in range(25):
        way = np.maximum(np.linalg.norm(one.pool[:, 1:, :2], axis=2) - 2.0, 0.0).sum(axis=1)
        first = one.state()["first"]
        while one.state()["first"] == first:
            number, _ = one.draw()
            beyond = way[number - first] - reach
            success = beyond < rng.choice((0.0, 1.0))
            one.record_episode(number, success, length=int(way[number - first]) if success else 60)
        ways.append(np.median(way))
        reach += 0.5
    nominal = np.maximum(np.linalg.norm(TASK.start[1:, :2], axis=1) - 2.0, 0.0).sum()
    assert ways[0] < 1.5 and max(ways[15:]) > nominal > 3.5
    assert np.mean(ways[20:]) > np.mean(ways[10:15]) > np.mean(ways[:5]) + 0.7


def test_half_of_the_walks_pushes_seek_contact(monkeypatch: pytest.MonkeyPatch) -> None:
    """All boxes lie on one side of the robot: no push that seeks contact heads for the other."""
    assert curriculum.CONTACT_SHARE == 0.5
    away = {}
    for share in (0.0, 0.5, 1.0):
        monkeypatch.setattr(curriculum, "CONTACT_SHARE", share)
        states = np.repeat(TASK.start[None], 4000, axis=0)
        headings = Curriculum(CONFIG, 1.0, seed=1)._headings(states)
        away[share] = np.bincount(headings, minlength=48)[30:42].sum() / 4000
    assert away[1.0] == 0.0
    assert away[0.0] == pytest.approx(0.25, abs=0.03)
    assert away[0.5] == pytest.approx(0.125, abs=0.03)


def test_starts_have_all_objects_within_the_arena() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    seeds = np.repeat(one.pool[:1], 3, axis=0)
    seeds[0, 1, 0], seeds[1, 2, 1] = 12.0, -12.0
    seeds[2, 3, :2] = 5.0, -5.0  # within
    one.restore({**one.state(), "seeds": seeds})
    play_round(one, {})
    assert len(one.pool) == NEW_STARTS and (np.abs(one.pool[:, 1:, :2]) <= 8.0).all()
    assert (one.pool[:, 3, 0] > 3.0).all()


def test_episodes_of_an_earlier_round_no_longer_count() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    late, _ = one.draw()
    for number in [late, *(one.draw()[0] for _ in range(EPISODES_PER_START * NEW_STARTS - 1))]:
        one.record_episode(number, success=False, length=60)
    before = one.state()["tries"].copy()
    one.record_episode(late, success=True, length=1)
    one.record_episode(NOT_FROM_CURRICULUM, success=True, length=1)
    np.testing.assert_array_equal(one.state()["tries"], before)
    assert not one.state()["wins"].any()


def test_walks_that_meet_no_start_leave_the_start_of_the_task() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    beyond = one.pool[:1].copy()
    beyond[:, 1, 0] = 30.0
    one.restore({**one.state(), "seeds": beyond})
    play_round(one, {})
    np.testing.assert_array_equal(one.pool, TASK.start[None])


def test_environments_begin_at_its_starts_and_tell_how_they_ended() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    env = TrainingEnvironments(CONFIG, 2, jitter=0.1, seed=9, curriculum=one)
    np.testing.assert_array_equal(env.reset(), TASK.observation(one.pool[:2]))
    rng, episodes, wins, steps = np.random.default_rng(0), 0, 0, 0
    while episodes < 50:
        step = env.step(rng.integers(48, size=2))
        assert step.episodes == []  # none began at a start of the task
        episodes += int((step.terminated | step.truncated).sum())
        wins += int(step.reward.sum())
        steps += 2
    assert one.state()["tries"].sum() == episodes and one.state()["wins"].sum() == wins
    running = env.state()["steps"].sum()
    assert one.state()["lengths"].sum() == steps - running and 0 < wins < episodes


def test_a_restored_curriculum_goes_on_with_the_same_starts() -> None:
    one, other = Curriculum(CONFIG, 0.9, seed=1), Curriculum(CONFIG, 0.9, seed=2)

    def starts(some: Curriculum) -> list[bytes]:
        seen = []
        for _ in range(2 * EPISODES_PER_START * NEW_STARTS):
            number, start = some.draw()
            seen.append(b"" if start is None else start.tobytes())
            some.record_episode(number, success=bool(number % 3 == 0), length=number % 7)
        return seen

    starts(one)
    other.restore(one.state())
    first_round = one.state()["pushes"]
    same = starts(one) == starts(other)
    assert same  # no diff of bytes
    assert one.pushes == other.pushes > first_round
