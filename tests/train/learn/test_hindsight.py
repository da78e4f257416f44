"""Layouts as goals: of tasks, of an episode made by hand, in batches and for a learner."""

from typing import Any

import numpy as np
import pytest
import torch as th
from rtg import _core, paths
from rtg.envs.training_environments import TrainingEnvironments
from rtg.learn import hindsight
from rtg.learn.ddqn import DoubleDqn
from rtg.learn.hindsight import (
    MAX_LAYOUTS,
    SUBSET_DIVISOR,
    TOLERANCE,
    HindsightReplayBuffer,
    Layouts,
    future_goals,
)
from samples import random_transitions, replay_rules, step_to, train_settings

CONFIG = _core.Config.from_file(paths.CONFIG / "gathering.yaml")
TASK = CONFIG.task
BOXES = Layouts(TASK)
CHAIN_TASK = _core.Config.from_file(paths.CONFIG / "art_manip.yaml").task
CHAIN = Layouts(CHAIN_TASK)
SIZE = TASK.observation_size
UNIT = TASK.position_unit  # [m], CHAIN_TASK's too

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


def moved(state: np.ndarray, **by: tuple[int, float]) -> np.ndarray:
    """The layout of the state with `x`, `y` or `theta` of a body changed: (body, by). [size]"""
    changed = state.copy()
    for name, (body, amount) in by.items():
        changed[body, ("x", "y", "theta").index(name)] += amount
    task, layouts = (TASK, BOXES) if len(state) == TASK.bodies else (CHAIN_TASK, CHAIN)
    return layouts.of(task.observation(changed[None]))[0]


def test_a_layout_is_where_objects_are_and_how_jointed_ones_are_turned() -> None:
    assert (BOXES.size, CHAIN.size) == (6, 16)
    boxes = BOXES.of(TASK.observation(TASK.start[None]))
    np.testing.assert_array_equal(boxes[0], np.float32(TASK.start[1:, :2].ravel() / UNIT))
    state = CHAIN_TASK.goal_state(1)
    x, y, theta = state[1:].T
    expected = np.concatenate(
        (np.stack((x, y), 1).ravel() / UNIT, np.stack((np.cos(theta), np.sin(theta)), 1).ravel())
    )
    found = CHAIN.of(CHAIN_TASK.observation(state[None]))[0]
    np.testing.assert_array_equal(found, expected.astype(np.float32))


def test_fixed_bodies_are_no_part_of_a_layout() -> None:
    wall = "{name: wall, kind: wall, shape: {box: [1, 1]}, fixed: true, start: [6, 6, 0]}"
    text = (paths.CONFIG / "gathering.yaml").read_text()
    first = "    - {name: box1"
    task = _core.Config.from_text(text.replace(first, f"    - {wall}\n{first}")).task
    assert task.bodies == 5
    found = Layouts(task).of(task.observation(task.start[None]))
    np.testing.assert_array_equal(found[0], np.float32(task.start[2:, :2].ravel() / UNIT))


@pytest.mark.parametrize("body", [1, 2, 3])
def test_a_layout_is_near_where_no_object_is_half_a_metre_off(body: int) -> None:
    start = TASK.start
    assert BOXES.near(moved(start), moved(start, x=(body, -0.49), theta=(body, 2.0)))
    assert not BOXES.near(moved(start), moved(start, x=(body, -0.51)))
    assert not BOXES.near(moved(start), moved(start, x=(body, 0.37), y=(body, 0.37)))


@pytest.mark.parametrize("body", [1, 4])
def test_a_layout_of_a_chain_is_near_where_its_links_are_turned_alike_too(body: int) -> None:
    state = CHAIN_TASK.start
    assert CHAIN.near(moved(state), moved(state, theta=(body, 0.04), x=(body, 0.45)))
    for turn in (0.06, -0.06, np.pi):
        assert not CHAIN.near(moved(state), moved(state, theta=(body, turn)))
    assert CHAIN.near(moved(state), moved(state, theta=(body, 2 * np.pi)))


def test_the_network_sees_how_far_objects_are_from_what_is_asked_for() -> None:
    state = CHAIN_TASK.goal_state(1)
    seen = CHAIN_TASK.observation(state[None])
    goal = moved(state, x=(2, 0.8), y=(3, -1.6), theta=(4, 0.3))
    asked = CHAIN.network_input(seen, goal[None])
    assert asked.dtype == np.float32 and asked.shape == (1, CHAIN_TASK.observation_size + 16)
    np.testing.assert_array_equal(asked[:, :-16], seen)
    turn = [1, 0, 1, 0, 1, 0, np.cos(0.3), np.sin(0.3)]
    np.testing.assert_allclose(asked[0, -16:], [0, 0, 0.2, 0, 0, -0.4, 0, 0, *turn], atol=1e-6)


def test_layouts_of_the_task_stay_goals_where_all_objects_are_a_little_off() -> None:
    """The disc's radius is 2.0 m; within it are most draws, but few layouts stay within by 0.5."""
    radius = np.linalg.norm(UNIT * BOXES.goal_layouts.reshape(-1, 3, 2), axis=2)
    assert 300 < len(BOXES.goal_layouts) <= MAX_LAYOUTS and radius.max() < 1.6
    assert 300 < len(CHAIN.goal_layouts) <= MAX_LAYOUTS
    centre = UNIT * CHAIN.goal_layouts[:, :8].reshape(-1, 4, 2).mean(axis=1)
    assert np.linalg.norm(centre - (0.0, 3.0), axis=1).max() < 0.6
    turns = np.diff(np.arctan2(CHAIN.goal_layouts[:, 9::2], CHAIN.goal_layouts[:, 8::2]), axis=1)
    off = np.abs(np.abs(np.angle(np.exp(1j * turns))) - np.pi / 2)
    assert off.max() < 0.263 - 2 * hindsight.JOINT_TOLERANCE  # joints may be 15 degrees off
    np.testing.assert_array_equal(Layouts(TASK).goal_layouts, BOXES.goal_layouts)


def test_the_bodies_of_a_joint_turn_against_each_other_in_any_order_of_the_joints() -> None:
    lines = (paths.CONFIG / "art_manip.yaml").read_text().splitlines(keepends=True)
    at = [k for k, line in enumerate(lines) if "{parent: " in line]
    assert len(at) == 3
    lines[at[0]], lines[at[2]] = lines[at[2]], lines[at[0]]
    reordered = _core.Config.from_text("".join(lines)).task
    assert [joint[:2] for joint in reordered.joints] == [(3, 4), (2, 3), (1, 2)]
    for task in (CHAIN_TASK, reordered):
        np.testing.assert_array_equal(hindsight._sides(task), [0, 1, -1, 1, -1])


def test_a_goal_state_is_robust_if_it_holds_a_little_further_on() -> None:
    states = np.stack([TASK.goal_state(1, k) for k in range(50)])
    still = np.zeros(TASK.bodies)
    assert 0 < len(hindsight.robust_goal_states(TASK, states, TOLERANCE, still)) < 50
    assert len(hindsight.robust_goal_states(TASK, states, 4.0, still)) == 0


def test_layouts_know_the_angles_of_loose_bodies_that_a_goal_asks_for() -> None:
    task = _core.Config.from_file(paths.CONFIG / "push_t.yaml").task
    layouts = Layouts(task)
    assert layouts.size == 4 and 0.0 < layouts.tolerance < TOLERANCE
    assert layouts.turns == hindsight.ANGLE_TOLERANCE * layouts.tolerance / TOLERANCE
    target = np.array([0, 0, np.sqrt(0.5), np.sqrt(0.5)])
    assert np.abs(layouts.goal_layouts - target).max() < 0.2
    goal = task.goal_state(1)
    turned, aside = goal.copy(), goal.copy()
    turned[1, 2] += 1.01 * layouts.turns[0]
    aside[1, 0] += 1.01 * layouts.tolerance
    here, there, off = layouts.of(task.observation(np.stack([goal, turned, aside])))
    assert layouts.near(here, here)
    assert not layouts.near(here, there) and not layouts.near(here, off)


def moved_within(layouts: Layouts, task: _core.Task, count: int) -> np.ndarray:
    """States near each layout, of objects that all have angles. [layouts, count, bodies, 3]

    Each object is moved and turned at random, by up to the tolerances.
    """
    movable = [body for body in range(1, task.bodies) if not task.fixed[body]]
    objects, rng = len(movable), np.random.default_rng(1)
    goals = np.float64(layouts.goal_layouts)
    states = np.tile(task.start, (len(goals), count, 1, 1))
    turned = goals[:, 2 * objects :].reshape(-1, objects, 2)
    states[:, :, movable, :2] = task.position_unit * goals[:, None, : 2 * objects].reshape(
        -1, 1, objects, 2
    )
    states[:, :, movable, 2] = np.arctan2(turned[..., 1], turned[..., 0])[:, None]
    shape = (len(goals), count, objects)
    way, angle = (
        0.999 * layouts.tolerance * np.sqrt(rng.random(shape)),
        2 * np.pi * rng.random(shape),
    )
    states[:, :, movable, 0] += way * np.cos(angle)
    states[:, :, movable, 1] += way * np.sin(angle)
    states[:, :, movable, 2] += 0.999 * layouts.turns * rng.uniform(-1, 1, shape)
    return states


def test_who_reaches_a_layout_of_boxes_that_touch_nearly_always_succeeds(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each box moves on its own; so gaps open by up to twice the tolerance."""
    monkeypatch.setattr(hindsight, "FIRST_DRAWS", 60)  # each takes 20 ms
    monkeypatch.setattr(hindsight, "MAX_DRAWS", 60)
    task = _core.Config.from_file(paths.CONFIG / "pack.yaml").task
    layouts = Layouts(task)
    assert layouts.size == 12  # three boxes, whose angles the goal asks for
    assert len(layouts.goal_layouts) > 30
    states = moved_within(layouts, task, 100)
    reached = layouts.of(task.observation(states.reshape(-1, task.bodies, 3)))
    assert layouts.near(reached, np.repeat(layouts.goal_layouts, 100, axis=0)).all()
    assert task.succeeded(states.reshape(-1, task.bodies, 3)).mean() > 0.99


class Counted:
    """A task that counts the goal states that are drawn of it."""

    def __init__(self, task: _core.Task) -> None:
        self.task, self.draws = task, 0

    def __getattr__(self, name: str) -> Any:
        return getattr(self.task, name)

    def goal_state(self, seed: int, index: int) -> np.ndarray | None:
        self.draws += 1
        return self.task.goal_state(seed, index)


@pytest.mark.parametrize(("most", "draws"), [(50, 200), (100, 400), (MAX_LAYOUTS, 2800)])
def test_goal_states_are_drawn_until_enough_are_robust(
    monkeypatch: pytest.MonkeyPatch, most: int, draws: int
) -> None:
    """Of Sorting's 37 % are. The layouts are those of the first robust draws, however many."""
    monkeypatch.setattr(hindsight, "MAX_LAYOUTS", most)
    task = Counted(_core.Config.from_file(paths.CONFIG / "sorting.yaml").task)
    layouts = Layouts(task)
    assert len(layouts.goal_layouts) == most and task.draws == draws
    states = np.stack([task.task.goal_state(hindsight.LAYOUT_SEED, k) for k in range(draws)])
    robust = hindsight.robust_goal_states(task.task, states, TOLERANCE, np.zeros(task.bodies))
    expected = layouts.of(task.observation(robust[:most]))
    np.testing.assert_array_equal(layouts.goal_layouts, expected)


def test_fixed_bodies_stay_where_goal_states_are_tried_for_robustness() -> None:
    """The drawer is to be 1.7 to 2.2 m out of its cabinet, which does not come along."""
    task = _core.Config.from_file(paths.CONFIG / "drawer.yaml").task
    states = np.stack([task.goal_state(1, k) for k in range(50)])
    still = np.zeros(task.bodies)
    assert len(hindsight.robust_goal_states(task, states, 0.26 * task.metre, still)) == 0
    assert len(hindsight.robust_goal_states(task, states, 0.05 * task.metre, still)) > 0


def test_the_nearest_layout_has_the_shortest_way_of_all_objects() -> None:
    starts = np.stack([TASK.jittered_start(1.0, 3, k) for k in range(5)])
    found = BOXES.nearest(TASK.observation(starts))
    among = np.array([7, 100, 200])
    of_few = BOXES.nearest(TASK.observation(starts), among)
    for start, one, other in zip(starts, found, of_few, strict=True):
        ways = [
            sum(np.hypot(*(UNIT * goal[2 * k : 2 * k + 2] - start[k + 1, :2])) for k in range(3))
            for goal in BOXES.goal_layouts
        ]
        np.testing.assert_array_equal(one, BOXES.goal_layouts[np.argmin(ways)])
        k = among[np.argmin([ways[k] for k in among])]
        np.testing.assert_array_equal(other, BOXES.goal_layouts[k])


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
