import numpy as np
import pytest
import torch as th
from rtg.learn import networks
from rtg.learn.ddqn import DoubleDqn, Statistics, bootstrap_targets, td_targets
from rtg.learn.replay import Batch
from samples import train_settings
from toy import TIME_LIMIT, Line, Outcomes

SETTINGS = dict(
    interactions=1000,
    batch=32,
    target_sync=10,
    target_rate=1.0,
    target_acts=False,
    averaging_rate=1.0,
    buffer=10_000,
)


def model(seed: int = 0, **changes: object) -> DoubleDqn:
    return DoubleDqn(Line(), train_settings(**{**SETTINGS, **changes}), discount=0.9, seed=seed)


def play(one: DoubleDqn, interactions: int) -> None:
    """Learns in rounds with so many interactions in all."""
    assert interactions % one.settings.train_frequency == 0
    for _ in range(interactions // one.settings.train_frequency):
        one.learn()


def column(*values: float) -> th.Tensor:
    return th.tensor(values, dtype=th.float32)[:, None]


def constant(net: th.nn.Module, *q: float) -> None:
    """A plain network says these values of the first actions, -9 of the others, in every state."""
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


class Table(th.nn.Module):
    """A network whose values are set: those of state k are in row k, and x = k is seen of it."""

    def __init__(self, values: np.ndarray) -> None:
        super().__init__()
        self.values = th.from_numpy(values)

    def forward(self, x: th.Tensor) -> th.Tensor:
        return self.values[x[:, 0].long()]

    def at(self, x: th.Tensor, headings: th.Tensor) -> th.Tensor:
        return self(x).gather(1, headings)


def test_double_q_agrees_with_a_plain_loop() -> None:
    rng = np.random.default_rng(1)
    online, target = rng.normal(size=(2, 64, 48)).astype(np.float32)
    single, double, lesser = np.zeros((3, 64, 1), np.float32)
    for i in range(64):
        single[i] = max(target[i])
        double[i] = target[i, int(np.argmax(online[i]))]
        lesser[i] = min(double[i], max(online[i]))
    before, after = column(*[63.0] * 64), column(*range(64))
    data = Batch(before, before.long(), after, before, before, before, offline=0)

    def next_values(**settings: bool) -> np.ndarray:
        one = model(**settings)
        one.online, one.target = Table(online), Table(target)
        return one._next_values(data).numpy()

    for clipped in (False, True):  # plain Q: one network does both
        np.testing.assert_array_equal(next_values(double_q=False, clipped_double_q=clipped), single)
    np.testing.assert_array_equal(next_values(clipped_double_q=False), double)
    np.testing.assert_array_equal(next_values(clipped_double_q=True), lesser)
    assert (double <= single).all() and (double < single).any()
    assert (lesser <= double).all() and (lesser < double).any()


@pytest.mark.parametrize("network", networks.KINDS)
def test_networks_of_a_learner_begin_alike_and_have_no_weights_in_common(network: str) -> None:
    one = model(network=network)
    nets = (one.online, one.target, one.mean)
    assert {type(net) for net in nets} == {networks.KINDS[network]}
    first = weights(one.online)
    for net in nets:
        th.testing.assert_close(weights(net), first, rtol=0, atol=0)
    assert len({p.data_ptr() for net in nets for p in net.parameters()}) == 3 * len(
        list(one.online.parameters())
    )


@pytest.mark.parametrize("network", networks.KINDS)
def test_a_gradient_step_moves_every_layer_of_the_online_network_alone(network: str) -> None:
    one = model(network=network, target_sync=1000)
    play(one, 400)
    nets = (one.online, one.target)
    before = [[p.detach().clone() for p in net.parameters()] for net in nets]
    one._gradient_step(one.replay.sample(32))
    for net, old, moves in zip(nets, before, (True, False), strict=True):
        for p, was in zip(net.parameters(), old, strict=True):
            assert th.equal(p, was) != moves


def weights(net: th.nn.Module) -> th.Tensor:
    return th.cat([p.detach().ravel() for p in net.parameters()])


def test_target_network_moves_by_the_target_rate() -> None:
    one = model(target_sync=1, target_rate=0.25)
    one.learn()
    start = weights(one.target).clone()
    one.train(1)
    th.testing.assert_close(weights(one.target), 0.75 * start + 0.25 * weights(one.online))


def test_the_policy_is_of_a_mean_over_weights() -> None:
    """At first over the last fifth of them, then as the rate says; with 1 it is the learner's."""
    one = model(averaging_rate=0.25)
    mean = weights(one.mean).clone()
    one.learn()
    for step in range(1, 60):
        rate = max(0.25, 5 / (5 + step))
        mean += rate * (weights(one.online) - mean)
        th.testing.assert_close(weights(one.mean), mean)
        one.train(1)
    assert rate == 0.25
    for averaging_rate in (0.25, 1.0):
        other = model(averaging_rate=averaging_rate)
        play(other, 400)
        learned = weights(other.online)
        assert th.equal(learned, weights(other.mean)) == (averaging_rate == 1.0)


def test_target_network_follows_every_target_sync_gradient_steps() -> None:
    one = model(target_sync=10)
    one.learn()  # fills the online buffer
    start = weights(one.target)
    one.train(10 - one.gradient_steps - 1)
    th.testing.assert_close(weights(one.target), start, rtol=0, atol=0)
    one.train(1)
    th.testing.assert_close(weights(one.target), weights(one.online), rtol=0, atol=0)
    assert not th.equal(weights(one.online), start)


def test_interactions_are_counted_singly() -> None:
    one = model(train_frequency=4)
    play(one, 40)
    assert (one.interactions, one.gradient_steps, one.replay.online.count) == (40, 10, 40)


def test_stored_transitions_end_with_their_episode_and_the_next_ones_begin_anew() -> None:
    one = model(epsilon_start=1.0, epsilon_end=1.0, nearby_share=0.0)
    for _ in range(200):
        one._interact()
    store, cut = one.replay.online, 0
    at, after = (
        4.0 * seen[:800, 0] for seen in (store.rows["observation"], store.rows["next_observation"])
    )
    success = after == 4
    np.testing.assert_array_equal(after, at + (store.rows["action"][:800] == 1))
    np.testing.assert_array_equal(store.rows["reward"][:800], success)
    np.testing.assert_array_equal(store.rows["terminated"][:800], success)
    for env in range(4):
        place, steps = 0, 0
        for k in range(env, 800, 4):
            assert at[k] == place
            steps += 1
            ended = success[k] or steps == TIME_LIMIT
            cut += ended and not success[k]
            place, steps = (0, 0) if ended else (after[k], steps)
    assert cut > 5 and success.sum() > 5


def test_exploration_follows_the_interactions_not_the_calls() -> None:
    one = model(epsilon_start=0.3, epsilon_end=0.1, epsilon_share=0.5)
    assert one.exploration_rate == pytest.approx(0.3)
    for _ in range(5):
        play(one, 52)
    assert one.interactions == 260
    assert one.exploration_rate == pytest.approx(0.3 - 0.2 * 260 / 500)
    play(one, 400)
    assert one.exploration_rate == pytest.approx(0.1)


def test_greedy_actions_do_not_explore_and_those_of_training_do() -> None:
    one = model(network="plain", epsilon_start=1.0, epsilon_end=1.0)
    for net in (one.online, one.target, one.mean):
        constant(net, 1.0)
    x = np.random.default_rng(0).normal(size=(50, 3)).astype(np.float32)
    assert (one.values(x).argmax(axis=1) == 0).all()
    assert len(set(one.training_actions(x).tolist())) > 4


@pytest.mark.parametrize("target_acts", [True, False])
def test_who_acts_in_evaluations_and_in_training(target_acts: bool) -> None:
    none = {"epsilon_start": 0.0, "epsilon_end": 0.0}
    one = model(network="plain", target_acts=target_acts, **none)
    nets = (one.online, one.target, one.mean)
    for net in nets:
        th.nn.init.normal_(net.head.weight)  # they disagree
    x = np.random.default_rng(0).normal(size=(50, 3)).astype(np.float32)
    with th.no_grad():
        own, target, mean = (net(th.from_numpy(x)).argmax(dim=1).numpy() for net in nets)
    assert (own != target).any() and (own != mean).any() and (target != mean).any()
    np.testing.assert_array_equal(one.values(x).argmax(axis=1), mean)
    acting = target if target_acts else own
    np.testing.assert_array_equal(one.training_actions(x), acting)


def test_learns_the_line() -> None:
    one = model(epsilon_start=1.0, epsilon_end=0.1, learning_rate=1e-3)
    play(one, 2000)
    x = np.array([[k / 4, 1, 0] for k in range(4)], np.float32)
    assert (one.values(x).argmax(axis=1) == 1).all()
    np.testing.assert_allclose(one.values(x).max(axis=1), 0.9 ** np.arange(3, -1, -1), atol=0.1)


def test_only_targets_that_a_proof_raises_count_as_bound() -> None:
    """Two are raised; then one above its bound, two unproven ones, a success, one above 1."""
    bootstrap = column(0.4, -0.2, 0.7, -0.1, 0.0, 1.0, 1.1)
    bounds = column(0.5, 0.5, 0.5, 0.0, 0.0, 1.0, 0.9)
    data = batch(bootstrap, bootstrap, bounds)
    for clip in (False, True):
        statistics = Statistics()
        y = td_targets(bootstrap, bounds, clip)
        statistics.add(data, *(each[:, 0].numpy() for each in (bootstrap, y, bootstrap)))
        shares = statistics.pop()
        assert shares["bound_share"] == pytest.approx(2 / 7)
        assert shares["clipped_share"] == pytest.approx(3 / 7)


def test_statistics_are_means_and_peaks_since_the_last_take() -> None:
    statistics = Statistics()
    data = batch(column(0, 0), column(0, 0), column(0, 0))
    for q, y in (((0.1, 0.5), (0.0, 0.4)), ((0.2, 0.2), (0.5, 0.5))):
        statistics.add(data, *(np.float32(each) for each in (q, y, y)))
    found = statistics.pop()
    assert found["td_error"] == pytest.approx((0.1 + 0.3) / 2)
    assert found["q_online_mean"] == pytest.approx((0.3 + 0.2) / 2)
    assert found["q_online_max"] == pytest.approx(0.5)
    assert "q_offline_mean" not in found  # there was none
    assert statistics.pop() == {}


def test_recent_episodes_are_the_last_100() -> None:
    """60 successes, 30 failures, 70 successes."""
    ends = [True] * 60 + [False] * 30 + [True] * 70
    one = DoubleDqn(Outcomes(ends), train_settings(**SETTINGS), discount=0.9, seed=0)
    assert one.recent_episodes() == {}
    play(one, len(ends))
    found = one.recent_episodes()
    assert found == {"rollout_success": 0.7, "rollout_length_mean": np.mean(range(60, 160))}
    other = model()
    other.restore(one.state())
    assert other.recent_episodes() == found
