"""Learners of Stable-Baselines3 on the environments, and the vector environment made for it."""

from typing import Any

import gymnasium
import numpy as np
import pytest
from rtg.envs.sb3 import PushVecEnv
from stable_baselines3 import DQN, PPO, SAC, HerReplayBuffer
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.env_checker import check_env
from stable_baselines3.common.evaluation import evaluate_policy
from stable_baselines3.common.vec_env import VecMonitor


def small() -> dict[str, Any]:
    """Settings of a small learner. Learners change `policy_kwargs`, so each needs its own."""
    return {"policy_kwargs": {"net_arch": [16]}, "seed": 1, "device": "cpu", "batch_size": 16}


def made(**variant: Any) -> gymnasium.Env:
    return gymnasium.make("RTG/Gathering-v0", max_episode_steps=8, **variant)


def vector(**variant: Any) -> PushVecEnv:
    return PushVecEnv(2, max_episode_steps=8, **variant)


@pytest.mark.parametrize(
    "variant", [{}, {"actions": "continuous"}, {"observations": "image"}, {"goals": "drawn"}]
)
def test_its_checker_finds_nothing_to_complain_about(
    variant: dict[str, str], recwarn: pytest.WarningsRecorder
) -> None:
    check_env(made(**variant).unwrapped)
    assert [str(warning.message) for warning in recwarn] == []


@pytest.mark.parametrize("make", [made, vector])
def test_ppo_dqn_sac_and_hindsight_learn(make: Any) -> None:
    off_policy: dict[str, Any] = {"learning_starts": 20}
    hindsight: dict[str, Any] = {**off_policy, "replay_buffer_class": HerReplayBuffer}
    learners: list[BaseAlgorithm] = [
        PPO("MlpPolicy", make(), n_steps=16, **small()),
        DQN("MlpPolicy", make(), **off_policy, **small()),
        SAC("MlpPolicy", make(actions="continuous"), **off_policy, **small()),
        DQN("MultiInputPolicy", make(goals="drawn"), **hindsight, **small()),
        SAC("MultiInputPolicy", make(goals="drawn", actions="continuous"), **hindsight, **small()),
    ]
    for learner in learners:
        learner.learn(64)
        assert learner.num_timesteps >= 64
        evaluate_policy(learner, make_like(learner), n_eval_episodes=1, warn=False)


def make_like(learner: BaseAlgorithm) -> gymnasium.Env:
    env = learner.get_env()
    assert env is not None
    continuous = isinstance(env.action_space, gymnasium.spaces.Box)
    drawn = isinstance(env.observation_space, gymnasium.spaces.Dict)
    return made(
        actions="continuous" if continuous else "discrete", goals="drawn" if drawn else "task"
    )


def test_a_learner_sees_pictures() -> None:
    learner = PPO("CnnPolicy", vector(observations="image", pixels=40), n_steps=4, batch_size=4)
    learner.learn(8)


def test_episodes_end_with_what_was_seen_last_and_begin_at_once() -> None:
    envs = vector(goals="drawn")
    envs.seed(3)
    first = envs.reset()
    seen = first
    for step in range(1, 9):
        before, (seen, reward, done, infos) = seen, envs.step(np.array([36, 36]))
        assert done.tolist() == [step == 8] * 2 and not reward.any()
    assert infos[0]["TimeLimit.truncated"] and not infos[0]["is_success"]
    last = infos[1]["terminal_observation"]
    np.testing.assert_array_equal(last["achieved_goal"], before["achieved_goal"][1])
    assert not np.array_equal(seen["desired_goal"], first["desired_goal"])
    assert not envs.step(np.array([0, 0]))[2].any()
    envs.seed(3)
    for key, value in envs.reset().items():
        np.testing.assert_array_equal(value, first[key])


def test_it_has_what_wrappers_ask_for() -> None:
    envs = VecMonitor(vector(render_mode="rgb_array"))
    envs.reset()
    assert len(envs.get_images()) == 2 and envs.get_images()[0].shape == (360, 360, 3)
    assert envs.get_attr("jitter") == [0.1 * envs.get_attr("task")[0].metre] * 2
    envs.set_attr("jitter", 0.0)
    assert envs.get_attr("jitter", indices=[1]) == [0.0]
    with pytest.raises(ValueError, match="'jitter' of some environments; legal: of all"):
        envs.set_attr("jitter", 1.0, indices=[0])
    ended = [info for _ in range(8) for info in envs.step(np.array([36, 36]))[3]][-1]
    assert ended["episode"]["l"] == 8


def test_each_environment_has_its_own_part_of_attributes_and_results() -> None:
    envs = PushVecEnv(3, goals="drawn", render_mode="rgb_array")
    seen = envs.reset()
    assert isinstance(seen, dict)
    for indices in (None, [2, 0], 1):
        asked = [0, 1, 2] if indices is None else np.atleast_1d(indices).tolist()
        infos = [envs.reset_infos[env] for env in asked]
        poses = envs.get_attr("_poses", indices)
        observations = envs.env_method("observation", indices=indices)
        pictures = envs.env_method("render", indices=indices)
        assert len(poses) == len(observations) == len(pictures) == len(asked)
        for env, info, state, one, picture in zip(
            asked, infos, poses, observations, pictures, strict=True
        ):
            np.testing.assert_array_equal(state, info["poses"])
            assert envs.observation_space.contains(one)
            np.testing.assert_array_equal(one["observation"], seen["observation"][env])
            np.testing.assert_array_equal(picture, envs.get_images()[env])
    assert envs.get_attr("observation_space", 1) == [envs.observation_space]
    assert envs.get_attr("task", [0, 1]) == [envs.envs.task] * 2


def test_what_all_share_is_called_once_and_returned_whole() -> None:
    envs = vector(goals="drawn")
    goals = envs.reset()["desired_goal"]  # type: ignore[index]
    (reward,) = envs.env_method("compute_reward", goals, goals[::-1], None, indices=[1])
    assert reward.tolist() == [0.0, 0.0]  # as hindsight replay asks for a batch of its own
    assert envs.env_method("render") == [None, None]  # as no mode was asked for


@pytest.mark.parametrize("name", ["reset", "step", "begin", "close"])
def test_episodes_of_single_environments_are_not_gone_on_with(name: str) -> None:
    with pytest.raises(
        ValueError, match=rf"method '{name}'; legal: reset\(\) and step\(\) of this"
    ):
        vector().env_method(name, indices=[0])
