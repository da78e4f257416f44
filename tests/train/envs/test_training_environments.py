from collections import Counter
from typing import Any

import numpy as np
from rtg import _core, paths
from rtg.envs.curriculum import NOT_FROM_CURRICULUM
from rtg.envs.push_env import PushEnv
from rtg.envs.training_environments import TrainingEnvironments

CONFIG = _core.Config.from_file(paths.CONFIG / "gathering.yaml")
TASK = CONFIG.task


def steps(env: TrainingEnvironments, count: int, seed: int = 0) -> list[np.ndarray]:
    """Makes random pushes; returns all that the environments say of them but for the episodes."""
    rng = np.random.default_rng(seed)
    return [np.column_stack(env.step(rng.integers(48, size=env.count))[:-1]) for _ in range(count)]


# A push from success, out of four.
NEAR = _core.Config.from_file(
    paths.CONFIG / "gathering.yaml",
    [
        "task.horizon=4",
        "task.bodies.0.start=[-4.5, 0.0, 0.0]",
        "task.bodies.1.start=[-3.05, 0.0, 0.0]",
        "task.bodies.2.start=[1.2, 0.7, 0.0]",
        "task.bodies.3.start=[1.2, -0.7, 0.0]",
    ],
)


class Singles:
    """Single environments, each of which begins anew at the next start of the stream `seed`."""

    def __init__(self, config: _core.Config, count: int, jitter: float, seed: int) -> None:
        self.envs = [PushEnv(config) for _ in range(count)]
        self.jitter, self.seed, self.starts, self.successes = jitter, seed, 0, 0
        self.lengths = [0] * count
        self.ends: list[tuple[bool, int]] = []  # success and length of all episodes

    def begin(self, k: int) -> np.ndarray:
        start = self.envs[k].task.jittered_start(self.jitter, self.seed, self.starts)
        self.starts += 1
        self.lengths[k] = 0
        return self.envs[k].reset(options={"poses": start})[0]

    def step(self, k: int, action: int) -> tuple[Any, ...]:
        """Does what one copy of TrainingEnvironments does; returns the fields of Step for it."""
        seen, reward, terminated, truncated, _ = self.envs[k].step(action)
        self.lengths[k] += 1
        self.successes += terminated
        if not (terminated or truncated):
            return seen, reward, False, False, False, seen, []
        end = (terminated, self.lengths[k])
        self.ends.append(end)
        return seen, reward, terminated, truncated, False, self.begin(k), [end]


def test_every_copy_does_what_the_single_environment_does_over_many_episodes() -> None:
    count, horizon = 3, NEAR.task.horizon
    many, singles = (
        TrainingEnvironments(NEAR, count, 0.1, seed=9),
        Singles(NEAR, count, 0.1, seed=9),
    )
    first = many.reset()
    np.testing.assert_array_equal(first, [singles.begin(k) for k in range(count)])
    rng = np.random.default_rng(0)
    for _ in range(400):
        actions = np.where(rng.random(count) < 0.3, 0, rng.integers(48, size=count))
        found = many.step(actions)
        expected = [singles.step(k, int(actions[k])) for k in range(count)]
        for of_many, *of_singles in zip(found[:-1], *(one[:-1] for one in expected), strict=True):
            np.testing.assert_array_equal(of_many, np.stack(of_singles))
        assert found.episodes == [end for *_, ends in expected for end in ends]
        assert many.successes == singles.successes
    kinds = Counter(singles.ends)
    assert kinds[True, 1] > 10 and kinds[False, horizon] > 10
    assert kinds[True, horizon] >= 3, "an action that both solves the task and is the last"


def test_a_finished_episode_reports_its_end_and_starts_again() -> None:
    env = TrainingEnvironments(CONFIG, 2, jitter=0.1, seed=9)
    env.reset()
    for _ in range(60):
        step = env.step(np.array([36, 36]))
    assert step.truncated.all() and not (step.reward.any() or step.terminated.any())
    assert not step.rejected.any() and step.episodes == [(False, 60)] * 2
    for k in range(2):
        start = TASK.observation(TASK.jittered_start(0.1, 9, 2 + k)[None])[0]
        np.testing.assert_array_equal(step.observation[k], start)
        assert not np.array_equal(step.next_observation[k], start)


class Turns:
    """A curriculum of every other episode."""

    def __init__(self) -> None:
        self.drawn, self.noted = 0, []

    def draw(self):
        self.drawn += 1
        return (0, TASK.start) if self.drawn % 2 else (NOT_FROM_CURRICULUM, None)

    def record_episode(self, origin, success, length):
        self.noted.append((origin, success, length))


def test_only_episodes_from_the_starts_of_the_task_count() -> None:
    curriculum = Turns()
    env = TrainingEnvironments(CONFIG, 2, jitter=0.1, seed=9, curriculum=curriculum)
    env.reset()
    for _ in range(60):
        step = env.step(np.array([36, 36]))
    assert step.truncated.all()
    assert curriculum.noted == [(0, False, 60), (NOT_FROM_CURRICULUM, False, 60)]
    assert step.episodes == [(False, 60)]


def test_a_restored_environment_goes_on_with_the_same_bits() -> None:
    env = TrainingEnvironments(CONFIG, 4, jitter=0.1, seed=1)
    env.reset()
    steps(env, 50)
    state = env.state()
    expected = steps(env, 100, seed=7)
    other = TrainingEnvironments(CONFIG, 4, jitter=0.1, seed=1)
    other.restore(state)
    np.testing.assert_array_equal(steps(other, 100, seed=7), expected)


def test_contact_headings_are_those_of_the_present_states() -> None:
    env = TrainingEnvironments(CONFIG, 3, jitter=0.1, seed=1)
    env.reset()
    for _ in range(3):
        steps(env, 1)
        poses = env.state()["poses"]
        np.testing.assert_array_equal(env.contact_headings(7), TASK.contact_headings(poses, 7))
    many = [env.contact_headings(seed).tolist() for seed in range(50)]
    assert len({tuple(headings) for headings in many}) > 25


class GivesUp:
    """A simulator that finishes no push of environment 1."""

    def __init__(self, env: TrainingEnvironments) -> None:
        self.real = env._simulator

    def push(self, states: np.ndarray, actions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        after, ok = self.real.push(states, actions)
        after[1:], ok[1:] = np.nan, False
        return after, ok


def test_a_push_that_the_simulator_gives_up_cuts_the_episode() -> None:
    env = TrainingEnvironments(CONFIG, 2, jitter=0.1, seed=9)
    before = env.reset()
    env._simulator = GivesUp(env)
    step = env.step(np.array([0, 0]))
    assert step.rejected.tolist() == step.truncated.tolist() == [False, True]
    assert not step.terminated.any() and step.reward.tolist() == [0.0, 0.0]
    assert step.episodes == [(False, 1)]
    np.testing.assert_array_equal(step.next_observation[1], before[1])
    start = TASK.observation(TASK.jittered_start(0.1, 9, 2)[None])[0]
    np.testing.assert_array_equal(step.observation[1], start)
    assert env.successes == 0
