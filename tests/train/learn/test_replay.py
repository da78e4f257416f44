from typing import Any

import numpy as np
import pytest
import torch as th
from rtg.learn.replay import MixedReplayBuffer, Store
from samples import random_transitions, replay_rules, step_to
from test_hindsight import BOXES, EPISODE, asked_for, names, observed, play
from test_hindsight import buffer as asking_buffer

SIZE = 20


def buffer(capacity: int = 1000, count: int = 1, **rules: Any) -> MixedReplayBuffer:
    """Makes a buffer for `count` environments."""
    return MixedReplayBuffer(capacity, SIZE, count, replay_rules(**rules))


def add_online(replay: MixedReplayBuffer, tag: float, **outcome: Any) -> None:
    """Adds a transition whose observation is `tag` everywhere."""
    row = np.full((1, SIZE), tag, np.float32)
    replay.add(row, np.array([3]), step_to(row + 0.5, **outcome))


def test_store_returns_what_went_in() -> None:
    store = Store(100, SIZE)
    data = random_transitions(30)
    known = {name: getattr(data, name) for name in store.columns if name != "bound"}
    np.testing.assert_array_equal(store.append(**known), np.arange(30))
    for name in ("observation", "next_observation", "action", "reward", "terminated"):
        np.testing.assert_array_equal(store.rows[name][:30], getattr(data, name))


def test_full_store_overwrites_the_oldest() -> None:
    store = Store(5, 1)
    for value in range(8):
        store.append(observation=np.full((1, 1), value), action=np.array([value]))
    assert store.count == 5
    assert sorted(store.rows["action"][:5]) == [3, 4, 5, 6, 7]
    assert store.rows["observation"][:, 0].tolist() == [5, 6, 7, 3, 4]


def test_offline_transitions_are_never_evicted() -> None:
    replay = buffer(capacity=40)
    replay.add_offline(random_transitions(40))
    for tag in range(100):
        add_online(replay, float(tag))
    assert (replay.offline.count, replay.online.count) == (40, 40)
    np.testing.assert_array_equal(
        replay.offline.rows["observation"][:40], random_transitions(40).observation
    )
    with pytest.raises(ValueError, match=r"more offline transitions than train\.buffer = 40"):
        replay.add_offline(random_transitions(1))


def test_samples_are_stored_transitions_in_the_wanted_mix() -> None:
    replay = buffer(offline_share=0.25)
    data = random_transitions(60)
    replay.add_offline(data)
    for tag in range(100, 200):
        add_online(replay, float(tag))
    batch = replay.sample(80)
    assert batch.offline == 20
    known = {row.tobytes(): k for k, row in enumerate(data.observation)}
    for i in range(20):
        k = known[batch.observations[i].numpy().tobytes()]
        assert batch.actions[i, 0] == data.action[k]
        assert batch.rewards[i, 0] == data.reward[k]
        np.testing.assert_array_equal(batch.next_observations[i], data.next_observation[k])
    online = batch.observations[20:, 0]
    assert ((online >= 100) & (online < 200)).all()
    assert (batch.next_observations[20:, 0] == online + 0.5).all()
    assert (batch.actions[20:] == 3).all()


def test_batches_are_offline_until_a_batch_of_online_data_exists() -> None:
    replay = buffer(offline_share=0.5)
    replay.add_offline(random_transitions(10))
    for tag in range(31):
        add_online(replay, float(tag))
    assert replay.sample(32).offline == 32
    add_online(replay, 31.0)
    assert replay.sample(32).offline == 16


def test_with_a_share_of_nothing_all_is_online() -> None:
    replay = buffer(offline_share=0.0)
    replay.add_offline(random_transitions(300))
    for tag in range(64):
        add_online(replay, float(tag))
    assert [replay.sample(64).offline for _ in range(5)] == [0] * 5


@pytest.mark.parametrize("capacity", [3000, 1200])  # the ring not yet full, and full
def test_a_share_of_the_online_rows_is_recent(capacity: int, monkeypatch) -> None:
    monkeypatch.setattr("rtg.learn.replay.RECENT_COUNT", 100)
    replay = buffer(capacity=capacity, recent_share=0.25)
    for tag in range(2000):
        add_online(replay, float(tag))
    drawn = replay.sample(400).observations[:, 0].numpy()
    assert set(drawn[:100]) <= set(range(1900, 2000))
    assert {1900.0, 1999.0} <= set(replay.sample(8000).observations[:2000, 0].tolist())
    assert np.sum(drawn[100:] >= 1900) < 60 and drawn[100:].min() < 1000  # uniform


def test_uniform_mixing_follows_the_sizes() -> None:
    replay = buffer(offline_share=-1.0)
    replay.add_offline(random_transitions(300))
    for tag in range(100):
        add_online(replay, float(tag))
    drawn = [replay.sample(100).offline for _ in range(200)]
    assert abs(np.mean(drawn) - 75.0) < 4 * np.sqrt(100 * 0.75 * 0.25 / 200)  # four sigma


def test_without_offline_data_all_is_online() -> None:
    replay = buffer(offline_share=0.5)
    add_online(replay, 1.0)
    assert replay.sample(8).offline == 0
    with pytest.raises(ValueError, match="nothing to sample from"):
        buffer().sample(1)


def test_time_out_keeps_the_bootstrap_and_success_ends_it() -> None:
    replay = buffer()
    add_online(replay, 0.0, truncated=True)
    add_online(replay, 1.0, reward=1.0)
    np.testing.assert_array_equal(replay.online.rows["terminated"][:2], [0.0, 1.0])


def test_successful_episode_proves_its_own_values() -> None:
    replay = buffer(discount=0.5)
    add_online(replay, 0.0, truncated=True)
    for tag in range(2):
        add_online(replay, float(tag))
    add_online(replay, 2.0, reward=1.0)
    np.testing.assert_array_equal(replay.online.rows["bound"][:4], [0.0, 0.25, 0.5, 1.0])


def test_unused_bounds_bound_nothing() -> None:
    replay = buffer(use_bounds=False)
    add_online(replay, 2.0, reward=1.0)
    assert (replay.sample(4).bounds == -th.inf).all()


def test_episodes_of_parallel_environments_are_kept_apart() -> None:
    replay = buffer(count=2, discount=0.5)
    row = np.zeros((2, SIZE), np.float32)
    for step in range(2):
        replay.add(row, np.array([1, 2]), step_to(row, reward=np.array([0.0, step == 1])))
    np.testing.assert_array_equal(replay.online.rows["bound"][:4], [0.0, 0.5, 0.0, 1.0])


@pytest.mark.parametrize("capacity", [11, 8, 6])
def test_an_episode_longer_than_the_ring_bounds_what_is_left_of_it(capacity: int) -> None:
    """Environment 0 of 4 succeeds with its fifth action; 20 rows have been written by then."""
    replay = buffer(capacity, count=4, discount=0.5)
    steps = np.zeros((4, SIZE), np.float32)
    for step in range(5):
        reward = np.array([step == 4, 0, 0, 0], np.float32)
        replay.add(steps, 10 * np.arange(4) + step, step_to(steps, reward))
    store = replay.online
    bounds = dict(zip(store.rows["action"].tolist(), store.rows["bound"].tolist(), strict=True))
    assert len(bounds) == capacity
    proven = {0: 0.0625, 1: 0.125, 2: 0.25, 3: 0.5, 4: 1.0}
    assert bounds == {action: proven.get(action, 0.0) for action in bounds}


def test_restored_buffer_continues_with_the_same_samples() -> None:
    replay = buffer(capacity=70)
    replay.add_offline(random_transitions(70))
    for tag in range(100):
        add_online(replay, float(tag))
    replay.sample(16)
    other = buffer(capacity=70, seed=99)
    other.add_offline(random_transitions(70))
    other.restore(replay.state())
    for tag in range(3):
        for one in (replay, other):
            add_online(one, float(tag), reward=float(tag == 2))
    for ours, theirs in zip(replay.sample(64), other.sample(64), strict=True):
        assert ours == theirs if isinstance(ours, int) else th.equal(ours, theirs)
    np.testing.assert_array_equal(replay.online.rows["bound"], other.online.rows["bound"])


def test_state_holds_only_what_is_filled() -> None:
    replay = buffer(capacity=1_000_000)
    replay.add_offline(random_transitions(7))
    add_online(replay, 1.0)
    assert replay.state()["online"]["observation"].shape == (1, SIZE)


def test_a_push_that_the_simulator_gave_up_is_not_stored() -> None:
    replay = buffer(count=2, discount=0.5)
    rows = np.array([[1.0], [2.0]], np.float32) * np.ones(SIZE, np.float32)
    given_up = np.array([False, True])
    replay.add(rows, np.array([1, 2]), step_to(rows, truncated=given_up, rejected=given_up))
    assert replay.online.count == 1 and replay.online.rows["action"][0] == 1
    replay.add(rows, np.array([3, 4]), step_to(rows, reward=1.0))
    np.testing.assert_array_equal(replay.online.rows["bound"][:3], [0.5, 1.0, 1.0])


def test_offline_transitions_are_asked_for_the_nearest_layout() -> None:
    replay, data = asking_buffer(capacity=3000), random_transitions(2300)
    replay.add_offline(data)
    expected = BOXES.nearest(data.observation)
    np.testing.assert_array_equal(replay.offline.rows["asked"][:2300], expected)
    batch = replay.sample(64)
    assert batch.offline == 64
    known = {row.tobytes(): k for k, row in enumerate(data.observation)}
    for seen, goal, reward in zip(
        batch.observations.numpy(),
        asked_for(batch.observations.numpy()),
        batch.rewards,
        strict=True,
    ):
        k = known[seen[:SIZE].tobytes()]
        np.testing.assert_allclose(goal, expected[k], atol=1e-6)
        assert reward == data.reward[k]


def test_an_episode_longer_than_the_ring_is_relabelled_as_far_as_it_is_left() -> None:
    replay = asking_buffer(capacity=3)
    play(replay)
    steps = replay.online.rows["action"]
    assert sorted(steps) == [1, 2, 3] and replay.online.rows["has_goals"].all()
    wanted = {1: {"rest", "all"}, 2: {"some", "all"}, 3: {"all"}}
    for step, goals in zip(steps, replay.online.rows["goals"], strict=True):
        assert names(goals) <= wanted[step]
    play(replay, reward=0.0)
    row = observed(EPISODE[0])[None]
    replay.add(row, np.array([9]), step_to(row))
    new = replay.online.rows["action"] == 9
    np.testing.assert_array_equal(replay.online.rows["has_goals"], ~new)


def test_episodes_side_by_side_are_relabelled_each_by_its_own() -> None:
    """The first plays EPISODE; in the second nothing moves, and two pushes are given up."""
    replay, asked = asking_buffer(count=2), []
    for t in range(4):
        rows, after = (
            np.stack((observed(EPISODE[k], k), observed(EPISODE[0], k))) for k in (t, t + 1)
        )
        last, rejected = t == 3, t in (0, 2)
        step = step_to(after, truncated=[last, rejected or last], rejected=[False, rejected])
        asked.append(replay.desired_layouts(rows))
        replay.add(rows, np.array([t, 10 + t]), step)
    store = replay.online
    n = store.count
    action = store.rows["action"][:n].tolist()
    assert sorted(action) == [0, 1, 2, 3, 11, 13]
    columns = zip(
        store.rows["goals"][:n], store.rows["has_goals"][:n], store.rows["asked"][:n], strict=True
    )
    found = dict(zip(action, columns, strict=True))
    wanted = {0: {"some", "all"}, 1: {"rest", "all"}, 2: {"some", "all"}, 3: {"all"}}
    for t in range(4):
        goals, has_goals, of_episode = found[t]
        assert has_goals and names(goals) <= wanted[t]
        np.testing.assert_array_equal(of_episode, asked[0][0])
    for t in (1, 3):
        assert not found[10 + t][1]
        np.testing.assert_array_equal(found[10 + t][2], asked[t][1])
    assert len({layout.tobytes() for _, layout in asked}) == 3, "another in each episode"


@pytest.mark.parametrize("cut", [0, 2])
def test_a_restored_hindsight_buffer_goes_on_with_the_same_samples(cut: int) -> None:
    """It is restored after an episode, or within another one."""
    replay, other = asking_buffer(), asking_buffer(seed=9)
    play(replay)
    for t in range(cut):
        row = observed(EPISODE[t])[None]
        replay.add(row, np.array([t]), step_to(row))
    replay.sample(16)
    other.restore(replay.state())
    for one in (replay, other):
        play(one)
        play(one)
    for ours, theirs in zip(replay.sample(64), other.sample(64), strict=True):
        assert ours == theirs if isinstance(ours, int) else th.equal(ours, theirs)
    count = replay.online.count
    np.testing.assert_array_equal(
        replay.online.rows["asked"][:count], other.online.rows["asked"][:count]
    )


def test_unused_bounds_of_hindsight_bound_nothing() -> None:
    replay = asking_buffer(use_bounds=False)
    play(replay)
    assert (replay.sample(50).bounds == -th.inf).all()
