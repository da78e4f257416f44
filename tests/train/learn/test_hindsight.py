"""Layouts as goals: of an episode made by hand, in batches and for a learner."""

from typing import Any

import numpy as np
import pytest
import torch as th
from rtg import _core, paths
from rtg.envs.layouts import TOLERANCE, Layouts
from rtg.envs.training_environments import TrainingEnvironments
from rtg.learn.ddqn import DoubleDqn
from rtg.learn.hindsight import SUBSET_DIVISOR, HindsightReplayBuffer, future_goals
from samples import random_transitions, replay_rules, step_to, train_settings

CONFIG = _core.Config.from_file(paths.CONFIG / "gathering.yaml")
TASK = CONFIG.task
BOXES = Layouts(TASK)
SIZE = TASK.observation_size
UNIT = TASK.position_unit  # [m]

# Of s_0 to s_4: the first box goes 2 m, back and there again; the second goes 1 m in the end.
PLACES = np.zeros((5, 3, 2))
PLACES[[1, 3, 4], 0, 0] = 2.0
PLACES[4, 1, 1] = 1.0
PLACES[:, 2] = (4.0, -4.0)
EPISODE = np.float32(PLACES.reshape(5, 6) / UNIT)  # layouts
SOME, ALL = EPISODE[1], EPISODE[4]


def observed(layout: np.ndarray, robot: float = 0.0) -> np.ndarray:
    """An observation of Gathering's with that layout. [observation]"""
    state = TASK.start.copy()
    state[1:, :2], state[0, :2] = UNIT * layout.reshape(3, 2), robot
    return TASK.observation(state[None])[0]


def goals_by_hand(count: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return future_goals(BOXES, EPISODE, count, 0.5, rng)


def names(goals: np.ndarray) -> set[str]:
    """Names the layouts, all of which states of EPISODE have."""
    known = {EPISODE[0].tobytes(): "rest", SOME.tobytes(): "some", ALL.tobytes(): "all"}
    return {known[goal.tobytes()] for goal in goals}


def test_goals_are_what_a_later_state_reached_and_this_one_has_not() -> None:
    goals, _, found = goals_by_hand(200)
    assert found.tolist() == [True] * 4
    # From s_1, with the layout SOME, SOME teaches nothing though s_3 has it.
    assert [names(of_step) for of_step in goals] == [
        {"some", "all"},
        {"rest", "all"},
        {"some", "all"},
        {"all"},
    ]


def test_every_later_state_is_as_likely() -> None:
    """After s_0, whose layout s_2 has, these are s_1, s_3 and s_4."""
    goals, _, _ = goals_by_hand(9000)
    share = (goals[0] == ALL).all(axis=1).mean()
    assert abs(share - 1 / 3) < 4 * np.sqrt(2 / 9 / 9000)  # four sigma


def test_bounds_are_those_that_the_episode_proves() -> None:
    goals, bounds, _ = goals_by_hand(50)
    proven = [
        {"some": 1.0, "all": 0.125},
        {"rest": 1.0, "all": 0.25},
        {"some": 1.0, "all": 0.5},
        {"all": 1.0},
    ]
    for t, of_step in enumerate(proven):
        for goal, bound in zip(goals[t], bounds[t], strict=True):
            (name,) = names(goal[None])
            assert bound == of_step[name]


def test_an_episode_in_which_nothing_moves_teaches_nothing_in_hindsight() -> None:
    still = np.repeat(EPISODE[:1], 5, axis=0)
    still[3:] += 0.4 / UNIT / np.sqrt(2.0)  # less than TOLERANCE
    rng = np.random.default_rng(0)
    goals, bounds, found = future_goals(BOXES, still, 4, 0.5, rng)
    assert not (found.any() or bounds.any() or goals.any()) and TOLERANCE == 0.5


def buffer(capacity: int = 1000, count: int = 1, **rules: Any) -> HindsightReplayBuffer:
    """Makes a buffer for `count` environments."""
    of = replay_rules(**{"discount": 0.5, "offline_share": 0.25, **rules})
    return HindsightReplayBuffer(capacity, SIZE, count, of, layouts=BOXES, goals=4)


def play(replay: HindsightReplayBuffer, reward: float = 0.0) -> None:
    """Plays EPISODE, cut by time where there is no reward; robot and action of s_t are t."""
    for t in range(4):
        before, after = observed(EPISODE[t], t)[None], observed(EPISODE[t + 1], t + 1)[None]
        last, got = t == 3, reward * (t == 3)
        replay.add(before, np.array([t]), step_to(after, got, truncated=last and not got))


def asked_for(seen: np.ndarray) -> np.ndarray:
    """The layouts that rows of batches ask for. [N, observation + size] -> [N, size]"""
    return BOXES.of(seen[:, :SIZE]) + seen[:, SIZE:]


def is_one_of(layouts: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Tells which layouts are known, up to rounding. [N, size], [M, size] -> [N] bool"""
    return (np.abs(layouts[:, None] - known).max(axis=2) < 1e-6).any(axis=1)


@pytest.mark.parametrize("reward", [0.0, 1.0])
def test_a_batch_asks_for_what_was_reached_and_rewards_it(reward: float) -> None:
    """`reward`: of the task at the end, which counts where its own layout was asked for."""
    replay = buffer()
    replay.add_offline(random_transitions(50))
    play(replay, reward)
    batches = [replay.sample(4) for _ in range(1000)]  # as many rows as the buffer has
    offline = asked_for(np.concatenate([batch.observations[:1].numpy() for batch in batches]))
    assert all(batch.offline == 1 for batch in batches)
    assert is_one_of(offline, BOXES.goal_layouts).all() and not is_one_of(offline, EPISODE).any()
    seen, after, got, terminated, bound = (
        np.concatenate([getattr(batch, name)[1:].numpy() for batch in batches])
        for name in ("observations", "next_observations", "rewards", "terminated", "bounds")
    )
    assert seen.shape == after.shape == (3000, SIZE + 6) and seen.dtype == np.float32
    goal, step = asked_for(seen), np.rint(UNIT * seen[:, 0]).astype(int)
    np.testing.assert_allclose(asked_for(after), goal, atol=1e-6)
    relabelled = is_one_of(goal, EPISODE)
    assert abs(relabelled.mean() - 0.8) < 4 * np.sqrt(0.16 / 3000)  # k / (k + 1), four sigma
    assert is_one_of(goal[~relabelled], BOXES.goal_layouts).all()
    assert len(np.unique(goal[~relabelled].round(5), axis=0)) == 1, "one layout for the episode"
    reached = np.abs(EPISODE[step + 1] - goal).max(axis=1) < 1e-6
    expected = np.where(relabelled, reached, reward * (step == 3))
    assert 0.2 < reached[relabelled].mean() < 0.8
    np.testing.assert_array_equal(got[:, 0], expected)
    np.testing.assert_array_equal(terminated[:, 0], expected)
    assert (bound[relabelled & reached] == 1).all() and (bound[relabelled & ~reached] < 1).all()
    np.testing.assert_array_equal(bound[~relabelled, 0], reward * 0.5 ** (3 - step[~relabelled]))


def test_running_episodes_keep_what_they_were_asked_for() -> None:
    replay = buffer()
    row = observed(EPISODE[0])[None]
    asked = replay.desired_layouts(row)
    replay.add(row, np.array([0]), step_to(row))
    np.testing.assert_array_equal(replay.desired_layouts(observed(ALL)[None]), asked)
    assert is_one_of(asked_for(replay.sample(50).observations.numpy()), asked).all()


def test_each_episode_is_asked_for_the_nearest_of_a_few_layouts() -> None:
    """They differ. Of a random tenth the nearest is the tenth nearest of all, in the mean."""
    replay, asked = buffer(), []
    row = observed(np.float32(TASK.start[1:, :2].ravel() / UNIT))[None]
    for _ in range(60):
        asked.append(replay.desired_layouts(row)[0])
        replay.add(row, np.array([0]), step_to(row, truncated=True))
    way = np.hypot(*(UNIT * (BOXES.goal_layouts - BOXES.of(row))).reshape(-1, 3, 2).T).sum(axis=0)
    rank = [int((way < way[(BOXES.goal_layouts == goal).all(axis=1)][0]).sum()) for goal in asked]
    assert len(set(rank)) > 8 and min(rank) == 0 and max(rank) < 10 * SUBSET_DIVISOR
    assert np.mean(rank) == pytest.approx(SUBSET_DIVISOR - 1, abs=4.5)


def learner(seed: int = 0, **changes: Any) -> DoubleDqn:
    settings = train_settings(hindsight=4, offline=False, batch=8, buffer=1000, **changes)
    env = TrainingEnvironments(CONFIG, 2, jitter=0.1, seed=seed)
    return DoubleDqn(env, settings, discount=0.9, seed=seed)


def test_a_learner_acts_as_its_episodes_ask_and_is_judged_by_the_nearest_layouts() -> None:
    greedy = dict(epsilon_start=0.0, epsilon_end=0.0, leave_loops=False, target_acts=False)
    one = learner(network="plain", symmetry=False, **greedy)
    th.nn.init.normal_(one.online.head.weight)
    th.nn.init.normal_(one.mean.head.weight)
    seen = TASK.observation(np.stack([TASK.jittered_start(0.5, 1, k) for k in range(2)]))
    asked = one.replay.desired_layouts(seen)
    with th.no_grad():
        acting = one.online(th.from_numpy(BOXES.network_input(seen, asked))).argmax(dim=1).numpy()
        nearest = BOXES.network_input(seen, BOXES.nearest(seen))
        judged = one.mean(th.from_numpy(nearest)).numpy()
    np.testing.assert_array_equal(one.training_actions(seen), acting)
    np.testing.assert_array_equal(one.values(seen), judged)


def test_episodes_of_a_learner_are_stored_with_what_they_were_asked_for() -> None:
    """All steps of an episode have the same layout; some layouts are reached when objects move."""
    one = learner(epsilon_start=1.0, epsilon_end=1.0, contact_share=1.0)
    for _ in range(600 // one.settings.train_frequency):
        one.learn()
    store = one.replay.online
    for of_episode in (
        store.rows["asked"][:120:2],
        store.rows["asked"][1:120:2],
    ):  # the environments' first
        assert len(of_episode) == 60 and (of_episode == of_episode[0]).all()
    assert not (store.rows["asked"][120] == store.rows["asked"][0]).all()
    assert 0.3 < store.rows["has_goals"][:480].mean() < 1.0
