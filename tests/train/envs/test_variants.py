"""Variants of the environments: images, continuous actions, drawn goals."""

import copy
import itertools
import pickle
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from rtg import _core
from rtg.envs.push_env import PushEnv
from rtg.envs.push_vector_env import PushVectorEnv

ALL = [
    {"observations": seen, "actions": done, "goals": asked}
    for seen, done, asked in itertools.product(
        ("state", "image"), ("discrete", "continuous"), ("task", "drawn")
    )
]


@pytest.mark.parametrize("variant", ALL)
def test_each_passes_the_checker_and_has_a_spec_of_text(variant: dict[str, str]) -> None:
    env = gymnasium.make("RTG/Gathering-v0", **variant)
    check_env(env.unwrapped, skip_render_check=True)
    again = gymnasium.make(gymnasium.envs.registration.EnvSpec.from_json(env.spec.to_json()))
    assert again.observation_space == env.observation_space


def entries(observation: Any) -> list[np.ndarray]:
    return list(observation.values()) if isinstance(observation, dict) else [observation]


@pytest.mark.parametrize("variant", ALL)
def test_vectors_see_and_do_what_single_ones_do(variant: dict[str, str]) -> None:
    envs = PushVectorEnv(2, "push_t", **variant)
    _, info = envs.reset(seed=4)
    single = [PushEnv("push_t", **variant) for _ in range(2)]
    for env, poses, goal in zip(single, info["poses"], envs._goals, strict=True):
        env.reset(options={"poses": poses} | ({"goal": goal} if env.interface.draws_goals else {}))
    rng = np.random.default_rng(1)
    for _ in range(3):
        actions = (
            rng.uniform(-1, 1, (2, 2)).astype(np.float32)
            if variant["actions"] == "continuous"
            else rng.integers(48, size=2)
        )
        seen, reward, *_ = envs.step(actions)
        assert envs.observation_space.contains(seen)
        for k, env in enumerate(single):
            alone, alone_reward, *_ = env.step(actions[k])
            assert env.observation_space.contains(alone) and alone_reward == reward[k]
            for one, other in zip(entries(alone), entries(seen), strict=True):
                np.testing.assert_array_equal(one, other[k])


def test_a_way_of_the_longest_stride_is_the_push_of_a_heading() -> None:
    discrete, continuous = PushEnv(), PushEnv(actions="continuous")
    for action in (0, 12, 24, 36):
        heading = 2 * np.pi * action / 48
        discrete.reset(seed=3)
        continuous.reset(seed=3)
        discrete.step(action)
        continuous.step(np.array([np.cos(heading), np.sin(heading)], np.float32))
        np.testing.assert_allclose(continuous.poses, discrete.poses, atol=1e-6)


def test_ways_may_be_short_none_and_too_long() -> None:
    env = PushEnv(actions="continuous")
    start = env.reset(seed=1)[1]["poses"]
    for way, length in [((0.0, -0.25), 0.5), ((0.0, 0.0), 0.0), ((-1.0, -1.0), 2.0)]:
        env.reset(options={"poses": start})
        *_, info = env.step(way)
        assert not info["rejected"]
        moved = info["poses"][0] - start[0]
        np.testing.assert_allclose(np.hypot(*moved[:2]), length, atol=1e-6)
        np.testing.assert_array_equal(info["poses"][1:], start[1:])


@pytest.mark.parametrize("action", [(0.5, 1.5), (np.nan, 0.0), (0.5,), 3])
def test_other_ways_are_refused(action: Any) -> None:
    env = PushEnv(actions="continuous")
    env.reset(seed=1)
    with pytest.raises(ValueError, match="legal: two numbers from -1 to 1"):
        env.step(action)


@pytest.mark.parametrize(
    ("variant", "actions", "legal"),
    [
        ("continuous", np.full((2, 2), np.nan), "two numbers from -1 to 1"),
        ("continuous", np.full((2, 2), 1.5), "two numbers from -1 to 1"),
        ("continuous", np.zeros((2, 3)), "two numbers from -1 to 1"),
        ("discrete", np.array([1.7, 2.0]), "integers from 0 to 47"),
        ("discrete", np.array([1, 48]), "integers from 0 to 47"),
        ("discrete", np.array([1]), "integers from 0 to 47"),
    ],
)
def test_vectors_refuse_what_single_ones_refuse(variant: str, actions: Any, legal: str) -> None:
    envs = PushVectorEnv(2, actions=variant)
    envs.reset(seed=1)
    with pytest.raises(ValueError, match=f"legal: {legal}"):
        envs.step(actions)


def test_vectors_take_one_seed_and_at_least_one_environment_and_step() -> None:
    with pytest.raises(ValueError, match="num_envs 0; legal: at least 1"):
        PushVectorEnv(0)
    with pytest.raises(ValueError, match="seed is a list; legal: one number"):
        PushVectorEnv(2).reset(seed=[1, 2])
    with pytest.raises(ValueError, match="max_episode_steps 0; legal: at least 1"):
        PushVectorEnv(2, max_episode_steps=0)


class CountedTask:
    """A task that counts how many states it is asked to observe."""

    def __init__(self, task: _core.Task) -> None:
        self.task, self.observed = task, 0

    def __getattr__(self, name: str) -> Any:
        return getattr(self.task, name)

    def observation(self, states: np.ndarray) -> np.ndarray:
        self.observed += len(states)
        return self.task.observation(states)


@pytest.mark.parametrize("observations", ["state", "image"])
def test_a_step_observes_the_state_and_its_drawn_goal_once(observations: str) -> None:
    env = PushEnv(goals="drawn", observations=observations)
    envs = PushVectorEnv(3, goals="drawn", observations=observations)
    for one, actions, count in ((env, 5, 1), (envs, np.full(3, 5), 3)):
        one.reset(seed=1)
        counted = one.interface.task = CountedTask(one.task)
        one.step(actions)
        assert counted.observed == 2 * count


def test_an_episode_with_a_drawn_goal_ends_where_its_layout_is_reached() -> None:
    env = PushEnv(goals="drawn")
    first, _ = env.reset(seed=1)
    second, info = env.reset()
    assert not np.array_equal(first["desired_goal"], second["desired_goal"])
    assert env.task.succeeded(env.get_state()["goal"][None])[0] and not info["is_success"]
    goal = np.array([[-4.5, 0.0, 0.0], [0.9, 0.0, 0.0], [2.4, 2.0, 0.0], [2.4, -2.0, 0.0]])
    start = np.add(goal, [[0.0, 0.0, 0.0], [-1.4, 0.0, 0.0], [0.1, 0.0, 1.0], [0.0, -0.1, 0.0]])
    seen, _ = env.reset(options={"poses": start, "goal": goal})
    np.testing.assert_array_equal(seen["desired_goal"], np.float32(goal[1:, :2].ravel() / 4.0))
    rewards = []
    for _ in range(3):
        seen, reward, terminated, _, info = env.step(0)
        rewards.append(reward)
        told = env.compute_reward(seen["achieved_goal"], seen["desired_goal"], info)
        assert terminated == info["is_success"] == (reward == 1.0) == told
    assert 1.0 in rewards and not env.task.succeeded(env.poses[None])[0]  # the task's own goal


def test_rewards_of_many_layouts_are_told_at_once() -> None:
    env = PushEnv(goals="drawn")
    seen, _ = env.reset(seed=2)
    near = np.float32(0.49 / env.task.position_unit)
    achieved = np.repeat(seen["desired_goal"][None], 3, axis=0)
    achieved[1, 0] += near
    achieved[2, 0] += 1.1 * near
    desired = np.repeat(seen["desired_goal"][None], 3, axis=0)
    assert env.compute_reward(achieved, desired, [{}] * 3).tolist() == [1.0, 1.0, 0.0]
    assert not hasattr(PushEnv(), "compute_reward")


def test_a_state_with_its_goal_is_left_and_come_back_to() -> None:
    env = PushEnv("drawer", goals="drawn")
    env.reset(seed=5)
    env.step(3)
    other = pickle.loads(pickle.dumps(PushEnv("drawer", goals="drawn")))
    back = other.set_state(env.get_state())
    ahead, now = copy.deepcopy(env).step(7)[0], other.step(7)[0]
    np.testing.assert_array_equal(back["desired_goal"], ahead["desired_goal"])
    for key, value in ahead.items():
        np.testing.assert_array_equal(now[key], value)


def test_an_image_shows_the_state_and_the_goal_without_the_past() -> None:
    env = PushEnv(observations="image", goals="drawn", pixels=64)
    seen, info = env.reset(seed=1)
    assert seen["observation"].shape == (64, 64, 3)
    other = PushEnv(observations="image", goals="drawn", pixels=64)
    other.reset(seed=9, options={"goal": env.get_state()["goal"]})
    other.step(5)
    same = other.set_state({**env.get_state(), "steps": 7})
    np.testing.assert_array_equal(same["observation"], seen["observation"])
    elsewhere, _ = other.reset(seed=10, options={"poses": info["poses"]})
    assert not np.array_equal(elsewhere["observation"], seen["observation"])  # another goal


@pytest.mark.parametrize(
    ("variant", "message"),
    [
        ({"observations": "pixels"}, "observations 'pixels'; legal: 'state', 'image'"),
        ({"actions": "box"}, "actions 'box'; legal: 'discrete', 'continuous'"),
        ({"goals": "mine"}, "goals 'mine'; legal: 'task', 'drawn'"),
        ({"pixels": 4}, "pixels 4; legal: 8 to 2048"),
        ({"pixels": "96"}, "pixels '96'; legal: 8 to 2048"),
        ({"goal": "drawn"}, r"unknown keywords \['goal'\]; legal: .*config, .*jitter, .*goals"),
        ({"render_mode": "ansi"}, "render_mode 'ansi'; legal: None, 'rgb_array'"),
    ],
)
def test_unknown_variants_are_refused(variant: dict[str, Any], message: str) -> None:
    for make in (PushEnv, PushVectorEnv):
        with pytest.raises(ValueError, match=message):
            make(**variant)


def test_goals_are_no_options_where_none_are_drawn() -> None:
    env = PushEnv()
    with pytest.raises(ValueError, match=r"unknown options \['goal'\]"):
        env.reset(options={"goal": env.task.start})


def test_vectors_are_rendered_one_by_one() -> None:
    envs = gymnasium.make_vec("RTG/Maze-v0", num_envs=2, render_mode="rgb_array")
    envs.reset(seed=1)
    frames = envs.render()
    assert len(frames) == 2 and frames[0].shape == (360, 360, 3)
