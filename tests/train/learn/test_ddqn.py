import numpy as np
import pytest
import torch as th
from rtg.learn import networks
from rtg.learn.ddqn import DoubleDqn, Statistics, bootstrap_targets, next_values, td_targets
from rtg.learn.replay import Batch
from samples import train_settings
from stable_baselines3.common.vec_env import DummyVecEnv
from toy import Outcomes, line

SETTINGS = dict(
    interactions=1000,
    batch=32,
    target_sync=10,
    target_rate=1.0,
    target_acts=False,
    averaging_rate=1.0,
    buffer=10_000,
    reduced_precision=False,
)


def model(seed: int = 0, **changes: object) -> DoubleDqn:
    return DoubleDqn(line(), train_settings(**{**SETTINGS, **changes}), discount=0.9, seed=seed)


def column(*values: float) -> th.Tensor:
    return th.tensor(values, dtype=th.float32)[:, None]


def constant(net: th.nn.Module, *q: float) -> None:
    """The network says these values of the first actions, -9 of the others, in every state."""
    with th.no_grad():
        net.head.weight.zero_()
        net.head.bias.fill_(-9.0)
        net.head.bias[: len(q)] = th.tensor(q)


def batch(rewards: th.Tensor, terminated: th.Tensor, bounds: th.Tensor) -> Batch:
    nothing = th.zeros(len(rewards), 1)
    return Batch(nothing, nothing, nothing, rewards, terminated, bounds, offline=0)


def test_targets_by_hand() -> None:
    none = column(*[-np.inf] * 5)
    data = batch(column(0, 1, 0, 0, 0), column(0, 1, 0, 0, 0), none)
    plain = bootstrap_targets(data, column(0.5, 0.7, -0.4, 2.0, 0.0), 0.8)
    th.testing.assert_close(plain, column(0.4, 1.0, -0.32, 1.6, 0.0))
    assert th.equal(td_targets(plain, none, clip=False), plain)
    clipped = td_targets(plain, none, clip=True)
    th.testing.assert_close(clipped, column(0.4, 1.0, 0.0, 1.0, 0.0))


def test_targets_are_raised_to_proven_bounds() -> None:
    targets = td_targets(column(0.4, 0.4, -0.2), column(0.64, 0.1, 0.0), clip=False)
    th.testing.assert_close(targets, column(0.64, 0.4, 0.0))


def test_double_q_agrees_with_a_plain_loop() -> None:
    rng = np.random.default_rng(1)
    online, target = rng.normal(size=(2, 64, 48)).astype(np.float32)
    single, double, lesser = np.zeros((3, 64, 1), np.float32)
    for i in range(64):
        single[i] = max(target[i])
        double[i] = target[i, int(np.argmax(online[i]))]
        lesser[i] = min(double[i], max(online[i]))
    seen, held = th.from_numpy(online), th.from_numpy(target)
    for clipped_double_q in (False, True):  # plain Q: one network does both
        np.testing.assert_array_equal(next_values(held, held, clipped_double_q), single)
    np.testing.assert_array_equal(next_values(seen, held, clipped_double_q=False), double)
    np.testing.assert_array_equal(next_values(seen, held, clipped_double_q=True), lesser)
    assert (double <= single).all() and (double < single).any()
    assert (lesser <= double).all() and (lesser < double).any()


@pytest.mark.parametrize("dueling", [True, False])
def test_network_starts_near_zero(dueling: bool) -> None:
    q = model(dueling=dueling).values(np.random.default_rng(0).normal(size=(100, 3)).astype("f4"))
    assert q.shape == (100, 8)
    assert np.abs(q).max() < 0.02 and q.std() > 0


def test_dueling_advantages_sum_to_zero() -> None:
    net = model(dueling=True).q_net
    x = th.randn(10, 3)
    out = net.head(net.inner(net.first(x)))
    th.testing.assert_close(net(x).mean(dim=1), out[:, 0])


def test_plain_network_has_the_layers_of_table_2() -> None:
    net = model(dueling=False, layer_norm=False).q_net
    weights = [tuple(p.shape) for name, p in net.named_parameters() if name.endswith("weight")]
    assert weights == [(512, 3), (512, 512), (128, 512), (8, 128)]


@pytest.mark.skipif(not networks.has_fast_bfloat16(), reason="no bfloat16 in this processor")
def test_reduced_precision_stays_close() -> None:
    fast, exact = model(reduced_precision=True), model(reduced_precision=False)
    exact.q_net.load_state_dict(fast.q_net.state_dict())
    x = th.randn(200, 3)
    with th.no_grad():
        error = (fast.q_net.train()(x) - exact.q_net.train()(x)).abs().max()
        assert 0 < error < 0.02 * exact.q_net(x).abs().max()  # bfloat16 has 8 bits
        assert th.equal(fast.q_net.eval()(x), exact.q_net.eval()(x))


@pytest.mark.skipif(not networks.has_fast_bfloat16(), reason="no bfloat16 in this processor")
def test_both_networks_train_in_reduced_precision() -> None:
    one, modes = model(reduced_precision=True), []
    for net in (one.q_net, one.q_net_target):
        net.register_forward_hook(lambda net, *_: modes.append(net.training))
    one.learn(4, reset_num_timesteps=False)
    assert modes == [False, True, True, True]  # one choice of actions, three passes to learn


def weights(net: th.nn.Module) -> th.Tensor:
    return th.cat([p.detach().ravel() for p in net.parameters()])


def test_target_network_moves_by_the_target_rate() -> None:
    one = model(target_sync=1, target_rate=0.25)
    one.learn(4, reset_num_timesteps=False)
    start = weights(one.q_net_target).clone()
    one.train(1, 32)
    th.testing.assert_close(weights(one.q_net_target), 0.75 * start + 0.25 * weights(one.q_net))


def test_the_policy_is_of_a_mean_over_weights() -> None:
    """At first over the last fifth of them, then as the rate says; with 1 it is the learner's."""
    one = model(averaging_rate=0.25)
    mean = weights(one.mean_net).clone()
    one.learn(4, reset_num_timesteps=False)
    for step in range(1, 60):
        rate = max(0.25, 5 / (5 + step))
        mean += rate * (weights(one.q_net) - mean)
        th.testing.assert_close(weights(one.mean_net), mean)
        one.train(1, 32)
    assert rate == 0.25
    for averaging_rate in (0.25, 1.0):
        other = model(averaging_rate=averaging_rate)
        other.learn(400, reset_num_timesteps=False)
        learned = weights(other.q_net)
        assert th.equal(learned, weights(other.mean_net)) == (averaging_rate == 1.0)


def test_target_network_follows_every_target_sync_gradient_steps() -> None:
    one = model(target_sync=10)
    one.learn(4, reset_num_timesteps=False)  # fills the online buffer
    start = weights(one.q_net_target)
    one.train(10 - one._n_updates - 1, 32)
    th.testing.assert_close(weights(one.q_net_target), start, rtol=0, atol=0)
    one.train(1, 32)
    th.testing.assert_close(weights(one.q_net_target), weights(one.q_net), rtol=0, atol=0)
    assert not th.equal(weights(one.q_net), start)


def test_interactions_are_counted_singly() -> None:
    one = model(train_frequency=4)
    one.learn(40, reset_num_timesteps=False)
    assert (one.num_timesteps, one._n_updates, one.replay_buffer.online.count) == (40, 10, 40)


def test_exploration_follows_the_interactions_not_the_calls() -> None:
    one = model(epsilon_start=0.3, epsilon_end=0.1, epsilon_share=0.5)
    assert one.exploration_rate == pytest.approx(0.3)
    for _ in range(5):
        one.learn(52, reset_num_timesteps=False)
    assert one.num_timesteps == 260
    assert one.exploration_rate == pytest.approx(0.3 - 0.2 * 260 / 500)
    one.learn(400, reset_num_timesteps=False)
    assert one.exploration_rate == pytest.approx(0.1)


def test_deterministic_predictions_do_not_explore() -> None:
    one = model(epsilon_start=1.0, epsilon_end=1.0)
    x = np.random.default_rng(0).normal(size=(50, 3)).astype(np.float32)
    action, _ = one.predict(x, deterministic=True)
    np.testing.assert_array_equal(action, one.values(x).argmax(axis=1))


@pytest.mark.parametrize("target_acts", [True, False])
def test_who_acts_in_evaluations_and_in_training(target_acts: bool) -> None:
    one = model(target_acts=target_acts, epsilon_start=0.0, epsilon_end=0.0)
    nets = (one.q_net, one.q_net_target, one.mean_net)
    for net in nets:
        th.nn.init.normal_(net.head.weight)  # they disagree
    x = np.random.default_rng(0).normal(size=(50, 3)).astype(np.float32)
    with th.no_grad():
        own, target, mean = (net(th.from_numpy(x)).argmax(dim=1).numpy() for net in nets)
    assert (own != target).any() and (own != mean).any() and (target != mean).any()
    np.testing.assert_array_equal(one.predict(x, deterministic=True)[0], mean)
    acting = target if target_acts else own
    np.testing.assert_array_equal(one.predict(x, deterministic=False)[0], acting)


def test_learns_the_line() -> None:
    one = model(epsilon_start=1.0, epsilon_end=0.1, learning_rate=1e-3)
    one.learn(2000)
    x = np.array([[k / 4, 1, 0] for k in range(4)], np.float32)
    assert (one.greedy(x) == 1).all()
    np.testing.assert_allclose(one.values(x).max(axis=1), 0.9 ** np.arange(3, -1, -1), atol=0.1)


def test_only_targets_that_a_proof_raises_count_as_bound() -> None:
    """Two are raised; then one above its bound, two unproven ones, a success, one above 1."""
    bootstrap = column(0.4, -0.2, 0.7, -0.1, 0.0, 1.0, 1.1)
    bounds = column(0.5, 0.5, 0.5, 0.0, 0.0, 1.0, 0.9)
    data = batch(bootstrap, bootstrap, bounds)
    for clip in (False, True):
        statistics = Statistics()
        statistics.add(data, bootstrap, td_targets(bootstrap, bounds, clip), bootstrap)
        shares = statistics.pop()
        assert shares["bound_share"] == pytest.approx(2 / 7)
        assert shares["clipped_share"] == pytest.approx(3 / 7)


def test_a_batch_is_made_of_what_the_settings_say() -> None:
    buffer = model(offline_share=0.25, recent_share=0.125, value_bounds=False).replay_buffer
    rules = (buffer.offline_share, buffer.recent_share, buffer.use_bounds, buffer.discount)
    assert rules == (0.25, 0.125, False, 0.9)


def test_statistics_are_means_and_peaks_since_the_last_take() -> None:
    statistics = Statistics()
    data = batch(column(0, 0), column(0, 0), column(0, 0))
    for q, y in (((0.1, 0.5), (0.0, 0.4)), ((0.2, 0.2), (0.5, 0.5))):
        statistics.add(data, column(*q), column(*y), column(*y))
    found = statistics.pop()
    assert found["td_error"] == pytest.approx((0.1 + 0.3) / 2)
    assert found["q_online_mean"] == pytest.approx((0.3 + 0.2) / 2)
    assert found["q_online_max"] == pytest.approx(0.5)
    assert "q_offline_mean" not in found  # there was none
    assert statistics.pop() == {}


def test_recent_episodes_are_the_last_100() -> None:
    """60 successes, 30 failures, 70 successes."""
    ends = [True] * 60 + [False] * 30 + [True] * 70
    env = DummyVecEnv([lambda: Outcomes(ends)])
    one = DoubleDqn(env, train_settings(**SETTINGS), discount=0.9, seed=0)
    assert one.recent_episodes() == {}
    one.learn(len(ends), reset_num_timesteps=False)
    found = one.recent_episodes()
    assert found == {"rollout_success": 0.7, "rollout_length_mean": np.mean(range(60, 160))}
    other = model()
    other.restore(one.state())
    assert other.recent_episodes() == found
