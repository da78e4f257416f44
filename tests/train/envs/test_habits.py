"""What users of Gymnasium do with environments beyond step and reset."""

import copy
import multiprocessing
import pickle
from collections.abc import Callable
from pathlib import Path

import gymnasium
import numpy as np
import pytest
import rtg
from gymnasium.wrappers import RecordEpisodeStatistics, TimeAwareObservation
from rtg import _core, paths
from rtg.envs.push_env import PushEnv

IDS = [*rtg.ENVIRONMENTS, "RTG/Task-v0"]
TINY = str(paths.CONFIG / "tests" / "tiny.yaml")


def steps_of_an_episode(env: gymnasium.Env, heading: int = 36) -> int:
    """Pushes along the lower wall, where there is nothing, until the episode ends."""
    env.reset(seed=0)
    for step in range(1, 500):
        _, _, terminated, truncated, _ = env.step(heading)
        if terminated or truncated:
            return step
    return 0


@pytest.mark.parametrize("name", IDS)
def test_a_spec_is_text_and_made_again_from_it(name: str) -> None:
    env = gymnasium.make(name, **({} if name in rtg.ENVIRONMENTS else {"config": TINY}))
    again = gymnasium.make(gymnasium.envs.registration.EnvSpec.from_json(env.spec.to_json()))
    np.testing.assert_array_equal(env.reset(seed=1)[0], again.reset(seed=1)[0])


@pytest.mark.parametrize("name", rtg.ENVIRONMENTS)
def test_the_number_of_steps_is_the_horizon_of_the_task(name: str) -> None:
    env = gymnasium.make(name)
    assert env.spec.max_episode_steps == env.unwrapped.task.horizon


@pytest.mark.parametrize("steps", [7, 90])
def test_the_number_of_steps_that_is_asked_for_is_obeyed(steps: int) -> None:
    env = gymnasium.make("RTG/Gathering-v0", max_episode_steps=steps)
    assert steps_of_an_episode(env) == steps
    assert steps_of_an_episode(PushEnv()) == 60


@pytest.mark.parametrize(
    ("ends_at_horizon", "most", "steps"), [(True, 3, 3), (True, 8, 5), (False, 3, 3), (False, 8, 8)]
)
def test_make_and_make_vec_end_an_episode_of_ones_own_task_alike(
    ends_at_horizon: bool, most: int, steps: int
) -> None:
    own = {"config": TINY, "settings": ("task.horizon=5",), "ends_at_horizon": ends_at_horizon}
    env = gymnasium.make("RTG/Task-v0", max_episode_steps=most, **own)
    assert steps_of_an_episode(env) == steps
    envs = gymnasium.make_vec("RTG/Task-v0", num_envs=1, max_episode_steps=most, **own)
    envs.reset(seed=0)
    ends = [bool(envs.step(np.array([36]))[3][0]) for _ in range(steps)]
    assert ends == [False] * (steps - 1) + [True]


def test_wrappers_that_ask_for_the_number_of_steps_work() -> None:
    env = RecordEpisodeStatistics(TimeAwareObservation(gymnasium.make("RTG/Gathering-v0")))
    assert steps_of_an_episode(env) == 60


def test_a_task_of_ones_own_has_its_horizon_and_a_spec() -> None:
    env = gymnasium.make("RTG/Task-v0", config=TINY, settings=("task.horizon=5",))
    assert steps_of_an_episode(env) == 5 and env.spec is not None
    given = gymnasium.make("RTG/Task-v0", config=_core.Config.from_file(TINY))
    assert given.spec is not None


@pytest.mark.parametrize("make", [gymnasium.make, gymnasium.make_vec])
def test_a_task_that_nobody_names_is_refused(make: Callable[[str], object]) -> None:
    with pytest.raises(ValueError, match="config is missing; legal: config= with the name of a"):
        make("RTG/Task-v0")


def test_environments_and_parts_of_the_core_are_pickled_and_copied() -> None:
    env = gymnasium.make("RTG/PushT-v0")
    env.reset(seed=3)
    env.step(5)
    for again in (pickle.loads(pickle.dumps(env)), copy.deepcopy(env)):
        for action in (7, 20):
            one, other = copy.deepcopy(env), again
            np.testing.assert_array_equal(one.step(action)[0], copy.deepcopy(other).step(action)[0])
        np.testing.assert_array_equal(
            copy.deepcopy(env).reset()[0], again.reset()[0]
        )  # the generator of random numbers, too
    config = _core.Config.from_file(TINY, ["run.seed=4"])
    assert pickle.loads(pickle.dumps(config)).yaml == config.yaml
    assert copy.deepcopy(config.task).content == config.task.content
    pickle.loads(pickle.dumps(_core.ReverseSimulator(config)))


def _push(simulator: _core.Simulator, states: np.ndarray) -> np.ndarray:
    return simulator.push(states, np.zeros(len(states), np.int64))[0]


def test_a_simulator_is_sent_to_a_process_that_was_spawned() -> None:
    config = _core.Config.from_file(TINY)
    states = np.stack([config.task.jittered_start(0.1, 1, k) for k in range(3)])
    simulator = _core.Simulator(config)
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        found = pool.apply(_push, (simulator, states))
    np.testing.assert_array_equal(found, _push(simulator, states))


def test_a_state_is_left_and_come_back_to_with_its_step_count() -> None:
    env = PushEnv()
    env.reset(seed=2)
    for action in (0, 3, 9):
        env.step(action)
    state = env.get_state()
    ahead = [env.step(action)[0] for action in (1, 2)]
    other = PushEnv()
    seen = env.task.observation(state["poses"][None])[0]
    np.testing.assert_array_equal(other.set_state(state), seen)
    np.testing.assert_array_equal([other.step(action)[0] for action in (1, 2)], ahead)
    assert other.get_state()["steps"] == 5


START = PushEnv().task.start


@pytest.mark.parametrize(
    ("poses", "message"),
    [
        (
            np.full_like(START, np.nan),
            "no state of the task: numbers that are not finite; legal",
        ),
        (np.zeros_like(START), "'robot' and 'box1' overlap by more than 0.03 m; legal"),
        (START[None], r"poses of shape \[1, 4, 3\]"),
        (np.add(START, [40.0, 0.0, 0.0]), r"'robot' at \(40 m, .*, out of twice the arena; legal"),
        (START[:2], r"poses of shape \[2, 3\]; legal: \[4, 3\]"),
    ],
)
def test_states_that_are_none_are_refused(poses: np.ndarray, message: str) -> None:
    env = PushEnv()
    with pytest.raises(ValueError, match=message):
        env.reset(options={"poses": poses})
    with pytest.raises(ValueError, match=message):
        env.set_state({"poses": poses, "goal": START, "steps": 0})


@pytest.mark.parametrize("steps", [-5, 10**30, 2.7, "3", None])
def test_a_count_of_steps_that_is_none_is_refused_and_changes_nothing(steps: object) -> None:
    env = PushEnv()
    env.reset(seed=2)
    before = env.get_state()
    with pytest.raises(ValueError, match=r"steps .*; legal: a whole number from 0 to 2\*\*63 - 1"):
        env.set_state({"poses": START, "goal": START, "steps": steps})
    np.testing.assert_array_equal(env.get_state()["poses"], before["poses"])


def test_a_state_that_lacks_a_part_is_refused() -> None:
    with pytest.raises(ValueError, match=r"state without \['goal'\]; legal: one of get_state\(\)"):
        PushEnv().set_state({"poses": START, "steps": 0})


def test_info_of_a_reset_has_the_keys_of_a_step() -> None:
    env = PushEnv()
    _, before = env.reset(seed=1)
    assert before.keys() == env.step(0)[4].keys() and not before["is_success"]


def rollout(envs: gymnasium.vector.VectorEnv, steps: int) -> list[tuple]:
    rng, seen = np.random.default_rng(1), [envs.reset(seed=1)[0]]
    for _ in range(steps):
        seen += envs.step(rng.integers(48, size=envs.num_envs))[:4]
    return seen


def test_the_vector_environment_steps_as_single_ones_do() -> None:
    envs = gymnasium.make_vec("RTG/Gathering-v0", num_envs=3, max_episode_steps=4)
    assert type(envs.unwrapped).__name__ == "PushVectorEnv"
    first, info = envs.reset(seed=1)
    poses = info["poses"]
    simulator = _core.Simulator(_core.Config.from_file(paths.CONFIG / "gathering.yaml"))
    for step in range(1, 5):
        actions = np.array([0, 10, 20])
        observation, reward, terminated, truncated, info = envs.step(actions)
        poses = simulator.push(poses, actions)[0]
        np.testing.assert_array_equal(info["poses"], poses)
        np.testing.assert_array_equal(observation, envs.unwrapped.task.observation(poses))
        assert not terminated.any() and not reward.any() and (truncated == (step == 4)).all()
    observation, reward, terminated, truncated, info = envs.step(actions)  # begins new episodes
    assert not terminated.any() and not truncated.any()
    assert (info["poses"][:, 0] == envs.unwrapped.task.start[0]).all()
    assert not np.array_equal(observation, first)


def test_it_is_the_same_for_a_seed_and_ends_episodes_in_success(tmp_path: Path) -> None:
    make = lambda: gymnasium.make_vec("RTG/Gathering-v0", num_envs=2)  # noqa: E731
    for one, other in zip(rollout(make(), 70), rollout(make(), 70), strict=True):
        np.testing.assert_array_equal(one, other)
    envs = make().unwrapped
    envs.reset(seed=1)
    envs._poses[1] = [[-4.5, 0.0, 0.0], [-2.9, 0.0, 0.0], [1.2, 0.7, 0.0], [1.2, -0.7, 0.0]]
    _, reward, terminated, truncated, info = envs.step(np.array([12, 0]))
    assert reward.tolist() == [0.0, 1.0] and terminated.tolist() == [False, True]
    assert info["is_success"].tolist() == [False, True] and not truncated.any()


@pytest.mark.parametrize("mode", ["sync", "async", "vector_entry_point"])
def test_vector_environments_are_made_in_all_three_ways(mode: str) -> None:
    envs = gymnasium.make_vec("RTG/Drawer-v0", num_envs=2, vectorization_mode=mode)
    seen, _ = envs.reset(seed=1)
    assert seen.shape == (2, envs.single_observation_space.shape[0])
    envs.step(envs.action_space.sample())
    envs.close()
