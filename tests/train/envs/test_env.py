import warnings

import gymnasium
import numpy as np
import pytest
import rtg
from gymnasium.utils.env_checker import check_env as check_gymnasium
from rtg.envs.push_env import PushEnv
from rtg.envs.push_vector_env import PushVectorEnv
from stable_baselines3.common.env_checker import check_env as check_sb3


def rollout(seed: int, steps: int) -> list[np.ndarray]:
    env = gymnasium.make("RTG/Gathering-v0")
    observation, _ = env.reset(seed=seed)
    seen = [observation]
    actions = np.random.default_rng(5)
    for _ in range(steps):
        observation, _, terminated, truncated, _ = env.step(actions.integers(48))
        seen.append(observation)
        if terminated or truncated:
            seen.append(env.reset()[0])
    return seen


def test_gymnasium_and_sb3_find_nothing_to_complain_about() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make("RTG/Gathering-v0", render_mode="rgb_array").unwrapped
        check_gymnasium(env)
        check_sb3(env)


@pytest.mark.parametrize("name", rtg.ENVIRONMENTS)
def test_every_shipped_task_is_registered(name: str) -> None:
    task = gymnasium.make(name).unwrapped.task
    assert task.name == rtg.ENVIRONMENTS[name][0]


def test_the_seed_decides_all() -> None:
    first, again, other = rollout(3, 130), rollout(3, 130), rollout(4, 130)
    np.testing.assert_array_equal(first, again)
    assert not np.array_equal(first[0], other[0])
    assert not np.array_equal(first[0], first[61])  # the second episode starts elsewhere


def test_jitter_moves_the_objects_as_far_as_asked_and_the_robot_not_at_all() -> None:
    env = PushEnv(jitter=0.3)
    starts = np.array([env.reset(seed=k)[1]["poses"] for k in range(200)])
    shift = starts - env.task.start
    assert (shift[:, 0] == 0).all() and (shift[:, :, 2] == 0).all()
    reach = np.abs(shift[:, 1:, :2]).max(axis=(0, 2))
    assert (reach <= 0.3 + 1e-6).all() and (reach > 0.28).all()
    nominal = env.reset(seed=0, options={"jitter": 0.0})[1]["poses"]
    np.testing.assert_array_equal(nominal, env.task.start)


@pytest.mark.parametrize("make", [PushEnv, PushVectorEnv])
@pytest.mark.parametrize(
    ("jitter", "message"),
    [
        (16.0, r"jitter 16\.0 \(10 m\): key 'task\.start_jitter': 10\.0 is out of range; legal: "),
        (-0.5, r"jitter -0\.5 \(-0\.3125 m\): key .*out of range; legal: a number from 0\.0 to"),
        (float("nan"), r"jitter nan \(nan m\): key .*'nan' is not a number; legal: "),
    ],
)
def test_a_jitter_that_cannot_be_used_is_refused_at_once(make, jitter, message) -> None:
    with pytest.raises(ValueError, match=message):
        make(config="push_t", jitter=jitter)


def test_a_jitter_that_leaves_few_legal_starts_is_refused_at_once() -> None:
    """Six boxes moved by up to 10 m are hardly ever all within 7 m."""
    with pytest.raises(ValueError, match=r"jitter 10\.0 .*too few starts are legal .*; legal: "):
        PushEnv("sorting_hard", ["task.push.arena=7"], jitter=10.0)


def test_success_ends_the_episode_with_reward_one() -> None:
    env = PushEnv()
    start = env.task.start.copy()
    # All but box 1 are gathered; the robot stands left of it and pushes it along x.
    start[:] = [[-4.5, 0.0, 0.0], [-2.9, 0.0, 0.0], [1.2, 0.7, 0.0], [1.2, -0.7, 0.0]]
    env.reset(options={"poses": start})
    observation, reward, terminated, truncated, info = env.step(0)
    assert (reward, terminated, truncated, info["is_success"]) == (1.0, True, False, True)
    assert info["poses"][1, 0] > -2.0
    np.testing.assert_array_equal(observation, env.task.observation(info["poses"][None])[0])


def test_time_runs_out_at_the_horizon() -> None:
    env = PushEnv()
    env.reset(seed=0)
    flags = [env.step(36)[2:4] for _ in range(60)]  # along the lower wall: nothing to push
    assert flags[-1] == (False, True) and not any(any(flag) for flag in flags[:-1])


def test_rendering_shows_the_robot_where_it_is() -> None:
    env = gymnasium.make("RTG/Gathering-v0", render_mode="rgb_array", jitter=0.0)
    env.reset(seed=0)
    before = env.render()
    env.step(0)
    after = env.render()
    assert before.shape == after.shape and before.dtype == np.uint8
    changed = (before != after).any(axis=2)
    assert 0 < changed.mean() < 0.1


def test_wrong_arguments_are_named() -> None:
    for action in (48, -1, 3.5):
        with pytest.raises(ValueError, match=f"action {action}; legal: integers from 0 to 47"):
            PushEnv().step(action)
    with pytest.raises(ValueError, match=r"options \['pose'\]; legal: 'poses', 'jitter'"):
        PushEnv().reset(options={"pose": 1})
    with pytest.raises(ValueError, match="states of 2 bodies; legal: 4, the bodies of the task"):
        PushEnv().task.observation(np.zeros((1, 2, 3)))
    with pytest.raises(ValueError, match="is out of range; legal: 0 to 10"):
        PushEnv().task.jittered_start(float("nan"), 0)
