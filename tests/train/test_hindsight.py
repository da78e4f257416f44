"""Hindsight goals against an episode made by hand; batches that ask for them."""

from typing import Any

import numpy as np
import torch as th
from gymnasium import spaces
from rtg import _core, paths
from rtg.hindsight import HindsightReplayBuffer, future_goals
from rtg.networks import ValuePolicy
from samples import random_transitions, replay_rules

TASK = _core.Config.from_file(paths.CONFIG / "gathering.yaml").task

# Of s_0 to s_4. The first atom is reached, lost and reached again; the second for good in s_3.
HELD = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 0], [1, 1, 0], [1, 1, 0]], np.bool_)
ONE, BOTH = (1, 0, 0), (1, 1, 0)
NOTHING = {"held": HELD[0], "held_next": HELD[0]}


def goals_by_hand(count: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return future_goals(HELD[:-1], HELD[1:], count, 0.5, rng)


def test_goals_are_what_a_later_state_reached_and_this_one_lacks() -> None:
    goals, _ = goals_by_hand(200)
    found = [{tuple(map(int, goal)) for goal in of_step} for of_step in goals]
    # From s_1, where the first holds, that one alone teaches nothing; nothing is new after s_3.
    assert found == [{ONE, BOTH}, {BOTH}, {BOTH}, {(0, 0, 0)}]


def test_every_later_state_is_as_likely() -> None:
    """Of s_1, s_3 and s_4 after s_0; s_2 holds nothing."""
    goals, _ = goals_by_hand(9000)
    share = goals[0, :, 1].mean()
    assert abs(share - 2 / 3) < 4 * np.sqrt(2 / 9 / 9000)  # four sigma


def test_bounds_are_those_that_the_episode_proves() -> None:
    goals, bounds = goals_by_hand(50)
    proven = {0: {ONE: 1.0, BOTH: 0.25}, 1: {BOTH: 0.5}, 2: {BOTH: 1.0}}
    for t, of_step in proven.items():
        for goal, bound in zip(goals[t], bounds[t], strict=True):
            assert bound == of_step[tuple(map(int, goal))]
    assert not bounds[3].any()


def buffer(capacity: int = 1000, n_envs: int = 1, **rules: Any) -> HindsightReplayBuffer:
    space = spaces.Box(-1e4, 1e4, (20,), np.float32)
    rules = {"discount": 0.5, "offline_share": 0.25, **rules}
    return HindsightReplayBuffer(
        capacity,
        space,
        spaces.Discrete(48),
        rules=replay_rules(**rules),
        atoms=3,
        goals=4,
        n_envs=n_envs,
    )


def play(replay: HindsightReplayBuffer) -> None:
    """The episode of HELD, cut by time; the observation of s_t is t everywhere, its action t."""
    for t in range(4):
        row = np.full((1, 20), t, np.float32)
        last = t == 3
        info = {"TimeLimit.truncated": last, "held": HELD[t], "held_next": HELD[t + 1]}
        replay.add(row, row + 1, np.array([t]), np.zeros(1), np.array([last]), [info])


def test_a_batch_asks_for_what_was_reached_and_rewards_it() -> None:
    replay = buffer()
    replay.add_offline(random_transitions(50))
    play(replay)
    batches = [replay.sample(4) for _ in range(1000)]  # as many rows as the buffer has
    assert all(batch.offline == 1 and (batch.observations[0, 20:] == 1).all() for batch in batches)
    seen, after, reward, terminated, bound = (
        np.concatenate([getattr(batch, name)[1:].numpy() for batch in batches])
        for name in ("observations", "next_observations", "rewards", "terminated", "bounds")
    )
    assert seen.shape == after.shape == (3000, 23)
    asked, step = seen[:, 20:], seen[:, 0].astype(int)
    np.testing.assert_array_equal(asked, after[:, 20:])
    reached = (HELD[step + 1] >= asked.astype(bool)).all(axis=1)
    assert 0.1 < reached.mean() < 0.9
    np.testing.assert_array_equal(reward[:, 0], reached)
    np.testing.assert_array_equal(terminated[:, 0], reached)
    assert (bound[reached] == 1).all() and (bound[~reached] < 1).all()
    relabelled = ~asked.all(axis=1)
    assert not relabelled[step == 3].any()
    rest = relabelled[step < 3]
    assert abs(rest.mean() - 0.8) < 4 * np.sqrt(0.16 / len(rest))  # k / (k + 1), four sigma


def test_running_episodes_are_asked_for_the_tasks_goal() -> None:
    replay = buffer()
    row = np.zeros((1, 20), np.float32)
    info = {"held": HELD[0], "held_next": HELD[1]}
    replay.add(row, row, np.array([0]), np.zeros(1), np.array([False]), [info])
    assert (replay.sample(50).observations[:, 20:] == 1).all()


def test_an_episode_longer_than_the_ring_is_relabelled_as_far_as_it_is_left() -> None:
    replay = buffer(capacity=3)
    play(replay)
    steps = replay.online.action
    assert sorted(steps) == [1, 2, 3]
    for step, goals in zip(steps, replay.online.goals, strict=True):
        assert {tuple(map(int, goal)) for goal in goals} == {BOTH if step < 3 else (0, 0, 0)}


def test_episodes_side_by_side_are_relabelled_each_by_its_own() -> None:
    """The first plays HELD; in the second nothing ever holds, and the simulator gives up s_2."""
    replay = buffer(n_envs=2)
    for t in range(4):
        rows = np.repeat([[t], [10 + t]], 20, axis=1).astype(np.float32)
        last, rejected = t == 3, t == 2
        infos = [
            {"TimeLimit.truncated": last, "held": HELD[t], "held_next": HELD[t + 1]},
            {"rejected": rejected, "TimeLimit.truncated": rejected or last, **NOTHING},
        ]
        done = np.array([last, rejected or last])
        replay.add(rows, rows + 1, np.array([t, 10 + t]), np.zeros(2), done, infos)
    store = replay.online
    of_step = {
        int(action): {tuple(map(int, goal)) for goal in goals}
        for action, goals in zip(store.action[: store.count], store.goals, strict=False)
    }
    nothing = {(0, 0, 0)}
    assert of_step.keys() == {0, 10, 1, 11, 2, 3, 13}
    assert of_step[0] <= {ONE, BOTH} and of_step[1] == of_step[2] == {BOTH}
    assert all(of_step[action] == nothing for action in (3, 10, 11, 13))


def test_unused_bounds_bound_nothing() -> None:
    replay = buffer(use_bounds=False)
    play(replay)
    assert (replay.sample(50).bounds == -th.inf).all()


def test_a_restored_buffer_goes_on_with_the_same_samples() -> None:
    replay, other = buffer(), buffer(seed=9)
    play(replay)
    replay.sample(16)
    other.restore(replay.state())
    for one in (replay, other):
        play(one)
    for ours, theirs in zip(replay.sample(64), other.sample(64), strict=True):
        assert ours == theirs if isinstance(ours, int) else th.equal(ours, theirs)


def test_a_network_that_is_told_nothing_is_asked_for_all() -> None:
    space = spaces.Box(-1e4, 1e4, (20,), np.float32)
    policy = ValuePolicy(space, spaces.Discrete(48), lambda _: 1.0, network={"atoms": 3})
    seen = th.randn(10, 20)
    asked = [th.cat((seen, th.full((10, 3), value)), dim=1) for value in (1.0, 0.0)]
    with th.no_grad():
        assert th.equal(policy.q_net(seen), policy.q_net(asked[0]))
        assert not th.equal(policy.q_net(seen), policy.q_net(asked[1]))


def test_the_goal_holds_when_all_atoms_do() -> None:
    rng = np.random.default_rng(0)
    states = np.repeat(TASK.start[None], 500, 0)
    states[:, 1:, :2] = rng.uniform(-2.2, 2.2, (500, 3, 2))
    held = TASK.atoms(states)
    assert held.shape == (500, TASK.atom_count) == (500, 3)
    np.testing.assert_array_equal(held.all(axis=1), TASK.succeeded(states))
    np.testing.assert_array_equal(held, np.linalg.norm(states[:, 1:, :2], axis=2) <= 2.0)
