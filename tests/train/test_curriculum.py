"""Which starts the reverse curriculum keeps, and where the next ones come from."""

import json
from pathlib import Path

import numpy as np
import pytest
from rtg import _core, curriculum, paths
from rtg.curriculum import ELSEWHERE, EPISODES, NEW, OLD, PUSHES, WALKS, Curriculum
from rtg.errors import UserError
from rtg.offline_data import NoSource
from rtg.vector_env import PushVecEnv
from training_runs import run_folder, training

CONFIG = _core.Config.from_file(paths.CONFIG / "gathering.yaml")
TASK = CONFIG.task


def play_round(one: Curriculum, solved: dict[int, int]) -> np.ndarray:
    """The pool of a round in which start k is solved `solved[k]` times of EPISODES, else never."""
    pool = one.pool
    numbers = [one.draw()[0] for _ in range(EPISODES * len(pool))]
    for count, number in enumerate(numbers):
        k = number - numbers[0]
        one.note(number, success=count // len(pool) < solved.get(k, 0))
    return pool


def near(states: np.ndarray, seeds: np.ndarray) -> np.ndarray:
    """Of each state, whether most objects are where those of one of the seeds are. [states]"""
    moved = np.abs(states[:, None, 1:] - seeds[None, :, 1:]).max(axis=3) > 1e-9
    return moved.sum(axis=2).min(axis=1) <= 1


def test_the_first_starts_are_near_goals_and_do_not_meet_them() -> None:
    pool = Curriculum(CONFIG, 1.0, seed=1).pool
    assert pool.shape == (NEW, TASK.bodies, 3)
    assert not TASK.succeeded(pool).any()
    assert (np.linalg.norm(pool[:, 1:, :2], axis=2) < 2.0).mean() > 0.4  # at the start none is
    assert len(np.unique(pool[:, 0, 0])) > NEW / 2


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
    with pytest.raises(UserError, match="goal: none of 100 draws"):
        curriculum.goal_states(Never(), seed=5)


def test_pushes_of_the_walks_are_counted() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    assert one.pushes == PUSHES * WALKS
    for number in range(NEW * EPISODES):
        one.note(number % NEW, success=False)
    assert one.pushes == 2 * PUSHES * WALKS


def test_starts_are_drawn_in_turn_and_as_often_as_asked() -> None:
    every = Curriculum(CONFIG, 1.0, seed=1)
    assert [every.draw()[0] for _ in range(2 * NEW)] == [*range(NEW), *range(NEW)]
    some = Curriculum(CONFIG, 0.25, seed=1)
    drawn = [some.draw() for _ in range(4000)]
    share = np.mean([number != ELSEWHERE for number, _ in drawn])
    assert abs(share - 0.25) < 4 * np.sqrt(0.25 * 0.75 / 4000)  # four sigma
    assert all((number == ELSEWHERE) == (start is None) for number, start in drawn)


def test_starts_that_are_solved_now_and_then_are_kept_and_seed_the_next() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    pool = play_round(one, {3: 1, 7: 2, 11: EPISODES})
    good = pool[[3, 7]]
    np.testing.assert_array_equal(one.state()["good"], good)
    np.testing.assert_array_equal(one.state()["seeds"], good)
    assert near(one.pool, good).mean() > 0.8 and near(pool, good).mean() < 0.2
    assert len(one.pool) == NEW, "no good ones of earlier rounds yet"


def test_old_good_starts_are_played_again() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    good = play_round(one, {k: 1 for k in range(OLD + 10)})[: OLD + 10]
    play_round(one, {0: 1})
    assert len(one.pool) == NEW + OLD
    replayed = one.pool[NEW:]
    known = {start.tobytes() for start in good}
    assert len({start.tobytes() for start in replayed} & known) == OLD


def test_without_a_good_start_the_mastered_ones_seed_else_the_last_seeds_again() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    first = one.state()["seeds"]
    play_round(one, {})
    np.testing.assert_array_equal(one.state()["seeds"], first)
    pool = play_round(one, {5: EPISODES, 6: EPISODES})
    np.testing.assert_array_equal(one.state()["seeds"], pool[[5, 6]])
    assert len(one.state()["good"]) == 0


def test_episodes_of_an_earlier_round_no_longer_count() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    late, _ = one.draw()
    for number in [late, *(one.draw()[0] for _ in range(EPISODES * NEW - 1))]:
        one.note(number, success=False)
    before = one.state()["tries"].copy()
    one.note(late, success=True)
    one.note(ELSEWHERE, success=True)
    np.testing.assert_array_equal(one.state()["tries"], before)
    assert not one.state()["wins"].any()


def test_a_task_whose_goal_surrounds_the_seeds_begins_at_its_start(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(curriculum, "PUSHES", 0)  # the walks stay where the goal holds
    np.testing.assert_array_equal(Curriculum(CONFIG, 1.0, seed=1).pool, TASK.start[None])


def test_environments_begin_at_its_starts_and_tell_how_they_ended() -> None:
    one = Curriculum(CONFIG, 1.0, seed=1)
    env = PushVecEnv(CONFIG, 2, jitter=0.1, seed=9, curriculum=one)
    np.testing.assert_array_equal(env.reset(), TASK.observation(one.pool[:2]))
    rng, episodes, wins = np.random.default_rng(0), 0, 0
    while episodes < 20:
        _, reward, done, _ = env.step(rng.integers(48, size=2))
        episodes, wins = episodes + int(done.sum()), wins + int(reward.sum())
    assert one.state()["tries"].sum() == episodes and one.state()["wins"].sum() == wins


def test_a_restored_curriculum_goes_on_with_the_same_starts() -> None:
    one, other = Curriculum(CONFIG, 0.9, seed=1), Curriculum(CONFIG, 0.9, seed=2)

    def starts(some: Curriculum) -> list[bytes]:
        seen = []
        for _ in range(2 * EPISODES * NEW):
            number, start = some.draw()
            seen.append(b"" if start is None else start.tobytes())
            some.note(number, success=bool(number % 3 == 0))
        return seen

    starts(one)
    other.restore(one.state())
    first_round = one.state()["pushes"]
    same = starts(one) == starts(other)
    assert same  # no diff of bytes
    assert one.pushes == other.pushes > first_round


def test_pushes_for_starts_of_a_curriculum_are_told(tmp_path: Path) -> None:
    folder = run_folder(tmp_path / "run", None, "run.method=rcg")
    one = training(folder)
    assert one.run(NoSource(), lambda: False, record=False)
    one.finish(lost=0)
    found = json.loads((folder / "training.json").read_text())
    assert found["curriculum_pushes"] == one.env.curriculum.pushes > 0
