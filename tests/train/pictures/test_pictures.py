"""Checks what is drawn, and where."""

import itertools
import math
from pathlib import Path
from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image
from rtg import _core, paths
from rtg.pictures import plots, task_picture
from rtg.pictures.draw import (
    FAINT,
    GOAL,
    KIND_PALETTE,
    PAPER,
    ROBOT,
    WALL,
    Canvas,
    arena_window,
    below_caption,
    blend_with_paper,
    draw_joints,
    episode_window,
    kind_colours,
    outline,
    state_image,
)
from rtg.pictures.episode_pictures import film, interpolate, key, strip

TASK = _core.Config.from_file(paths.CONFIG / "gathering.yaml").task
START = TASK.start[None]
SOLVED = TASK.start.copy()
SOLVED[1:, :2] = [[-1.0, 0.0], [1.0, 0.0], [0.0, 1.2]]


def pixel(picture, x, y, window):
    """Colour of the pixel at a place of the plane [m]."""
    side = len(picture)
    scale = side / (2 * window.half)
    row, column = (window.half + window.y - y) * scale, (x - window.x + window.half) * scale
    return tuple(picture[int(row), int(column)].tolist())


@pytest.mark.parametrize("window", [arena_window(TASK), episode_window(TASK, START)])
def test_every_body_stands_where_its_pose_says(window):
    picture = state_image(TASK, START, window=window)
    for body, (x, y, _) in enumerate(TASK.start):
        beside = (x + 0.3, y)  # the centre of an object is marked
        assert pixel(picture, *beside, window) == (ROBOT if body == 0 else KIND_PALETTE[0])
    assert pixel(picture, 4.5, 4.0, arena_window(TASK)) == PAPER


def test_bodies_turn_counterclockwise():
    turned = outline(np.array([[1.0, 0.0], [0.0, 2.0]]), np.array([3.0, 4.0, np.pi / 2]))
    np.testing.assert_allclose(turned, [[3.0, 5.0], [1.0, 4.0]], atol=1e-12)


def test_a_caption_lies_on_nothing_and_hides_nothing_of_the_arena():
    window = below_caption(arena_window(TASK))
    for height in (0.95, 1.04):  # of the robot's centre, in units of the arena's
        path = START.copy()
        path[0, 0, :2] = -0.85 * TASK.arena, height * TASK.arena
        picture = state_image(TASK, path, caption="a start")
        empty = state_image(TASK, START, caption="a start")
        assert picture.shape == (360, 360, 3)
        assert np.array_equal(picture[:22], empty[:22]) and (empty[:22] != PAPER).any()
        assert pixel(picture, path[0, 0, 0], 0.98 * TASK.arena, window) == ROBOT
        assert pixel(picture, 0.0, TASK.arena, window) != PAPER, "the frame"


def test_walls_have_a_colour_of_their_own():
    """They take none of those of the objects."""
    task = _core.Config.from_file(paths.CONFIG / "examples" / "door.yaml").task
    assert task.names[1:] == ["wall", "door", "crate"] and task.fixed == [False, True, False, False]
    picture, window = state_image(task, task.start[None]), arena_window(task)
    for body, colour in zip((1, 2, 3), (WALL, KIND_PALETTE[0], KIND_PALETTE[1]), strict=True):
        x, y, _ = task.start[body]
        assert pixel(picture, x - 0.3, y, window) == colour


def test_a_reached_goal_is_stronger():
    window = arena_window(TASK)
    plain, strong = (
        pixel(state_image(TASK, SOLVED[None], reached=reached), 0.0, -1.0, window)
        for reached in (False, True)
    )
    assert sum(strong) < sum(plain) < sum(PAPER)


def test_a_disc_on_a_half_plane_is_seen_in_any_order():
    goal = "task.goal=[{kind: box, disc: {centre: [4, 4], radius: 1}}, "
    goal += "{kind: '*', half_plane: {normal: [-1, 0], offset: 0}}]"
    marks = _core.Config.from_file(paths.CONFIG / "gathering.yaml", [goal]).task.goal_marks
    names = ("kinds", "names", "fixed", "outlines", "joints", "start", "arena")
    names += ("joints_reached", "joint_marks", "body_marks", "centroids")
    shown = {name: getattr(TASK, name) for name in names}
    pictures = [
        state_image(SimpleNamespace(**shown, goal_marks=goal), SOLVED[None])
        for goal in (marks, marks[::-1])
    ]
    assert np.array_equal(*pictures)
    window = arena_window(TASK)
    on_plane = pixel(pictures[0], 7.0, 4.0, window)  # -x <= 0
    assert pixel(pictures[0], 4.0, 4.0, window) != on_plane != PAPER
    assert pixel(pictures[0], -7.0, 4.0, window) == PAPER


def test_a_pin_shows_whether_its_angle_is_as_asked():
    task = _core.Config.from_file(paths.CONFIG / "art_manip.yaml").task
    poses = np.array(task.start)
    poses[2:, 2] = 1.5  # the first joint is right, the others are not
    canvas = Canvas(arena_window(task), 360)
    draw_joints(canvas, task, poses)
    picture, window = canvas.pixels(), arena_window(task)
    pins = [outline(np.array([[1.2, 0.0]]), poses[k])[0] for k in (1, 2)]
    assert pixel(picture, *pins[0], window) == GOAL
    assert pixel(picture, *pins[1], window) == PAPER


DOOR = paths.CONFIG / "examples" / "door.yaml"


def on_door(task, angle):
    """Returns a place on the door of DOOR at this angle: near its end, on its middle line."""
    pin = outline(np.array([[1.5, 0.0]]), task.start[1])[0]
    return pin + 2.4 * np.array([np.cos(angle), np.sin(angle)])


def test_where_a_joint_is_to_stand_is_shaded_up_to_its_limit():
    goal = "task.goal=[{joint: door, angles: [1.0, 3.0]}]"
    task = _core.Config.from_file(DOOR, [goal, "task.joints.0.limits=[-0.1, 2.0]"]).task
    picture, window = state_image(task, task.start[None]), arena_window(task)
    shade = blend_with_paper(KIND_PALETTE[0], 0.18)
    for angle, colour in ((0.6, PAPER), (1.25, shade), (1.75, shade), (2.4, PAPER)):
        assert pixel(picture, *on_door(task, angle), window) == colour
    ends = [mark.ring for mark in task.joint_marks(task.start[None]) if mark.target]
    assert len(ends) == 2
    for ring in ends:
        edge = pixel(picture, *ring[:2].mean(axis=0), window)
        assert sum(edge) < sum(shade)


def test_where_a_joint_is_to_stand_goes_with_its_parent():
    task = _core.Config.from_file(paths.CONFIG / "art_manip.yaml").task
    poses = task.start.copy()
    poses[:, 0] += 1.0
    before, after = (task.joint_marks(state[None]) for state in (task.start, poses))
    assert len(before) == len(after) == 27
    for one, other in zip(before, after, strict=True):
        assert np.allclose(one.ring + np.array([1.0, 0.0]), other.ring)


def test_the_window_holds_all_that_happens_outside_the_arena_too():
    path = np.stack([TASK.start, TASK.start])
    path[1, 0, :2] = (7.0, 6.0)
    window = episode_window(TASK, path)
    assert abs(7.8 - window.x) < window.half and abs(-5.8 - window.y) < window.half
    path[1, 1, :2] = (-11.0, 6.0)
    window = episode_window(TASK, path)
    assert window.at(-1.0, 0.0)[0] < -11.8 and window.at(1.0, 0.0)[0] > 7.8


FREE = SimpleNamespace(joints=[])


def test_what_joints_connect_moves_together():
    before, after = np.zeros((3, 3)), np.array([[2.0, 0, 0], [0.5, 0, 0], [0.0, 0, 0.4]])
    chain = SimpleNamespace(joints=[(1, 2, [np.zeros(2)])])
    assert interpolate(chain, before, after, 0.5)[2].tolist() == [0.0, 0.0, 0.0]
    assert np.allclose(interpolate(chain, before, after, 0.875)[2], [0.0, 0.0, 0.2])


def test_a_chain_moves_together_whatever_the_order_of_its_joints():
    before, after = np.zeros((5, 3)), np.zeros((5, 3))
    after[0, 0], after[1, 0], after[2:, 2] = 2.0, 0.5, 0.4
    for joints in ([(1, 2), (2, 3), (3, 4)], [(3, 4), (2, 3), (1, 2)]):
        chain = SimpleNamespace(joints=[(*pair, [np.zeros(2)]) for pair in joints])
        late = interpolate(chain, before, after, 0.875)
        assert np.allclose(late[1:], after[1:] / 2)


def test_an_object_waits_for_the_robot_and_then_goes_along():
    before, after = np.zeros((2, 3)), np.array([[2.0, 0.0, 0.0], [0.5, 0.0, 0.4]])
    early = interpolate(FREE, before, after, 0.5)
    assert early.tolist() == [[1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]
    late = interpolate(FREE, before, after, 0.875)
    assert np.allclose(late, [[1.75, 0.0, 0.0], [0.25, 0.0, 0.2]])
    assert np.allclose(interpolate(FREE, before, after, 1.0), after)


def test_a_strip_has_ten_states_at_most_the_first_and_the_last_among_them(tmp_path):
    file = tmp_path / "strip.png"
    for states, rows, columns in ((1, 1, 1), (3, 1, 3), (7, 2, 5), (61, 2, 5)):
        strip(file, TASK, np.repeat(START, states, axis=0), success=False, title="an episode")
        with Image.open(file) as picture:
            width, height = picture.size
            assert width == 302 * columns - 2
            assert 302 * rows + 40 < height < 302 * rows + 60  # words above, the key below
            if columns > 1:
                assert picture.getpixel((300, height - 40)) == FAINT  # between two tiles


@pytest.mark.parametrize("letters", [10, 40])
def test_the_title_of_an_episode_stands_above_it_and_fits(tmp_path, letters):
    strip(tmp_path / "strip.png", TASK, START, success=False, title="m" * letters)
    with Image.open(tmp_path / "strip.png") as picture:
        band = np.asarray(picture)[:27]
    inked = np.flatnonzero((band != PAPER).any(axis=(0, 2)))
    assert inked[0] < 12 and 100 < inked[-1] < 296


@pytest.mark.parametrize(("steps", "frames"), [(1, 10), (10, 82), (60, 122)])
def test_a_film_shows_every_push_and_rests_at_both_ends(tmp_path, steps, frames):
    path = np.repeat(START, steps + 1, axis=0)
    path[:, 0, 0] = np.linspace(-6.0, 6.0, steps + 1)
    film(tmp_path / "film.gif", TASK, path, success=True, title="an episode")
    with Image.open(tmp_path / "film.gif") as picture:
        assert picture.n_frames == frames
        assert picture.width == 360 < picture.height - 40  # words above, the key below
        rests = []
        for frame in (0, 1, frames - 1):
            picture.seek(frame)
            rests.append(picture.info["duration"])
    assert rests[0] > 10 * rests[1] and rests[2] > 10 * rests[1]


def test_curves_with_gaps_and_empty_samples_can_be_drawn(tmp_path):
    nan = float("nan")
    curve = {
        "interactions": np.array([0.0, 100.0, 200.0]),
        "success_rate": np.array([nan, 0.0, 0.5]),
        "episode_length_mean": np.array([nan, 60.0, 40.0]),
        "episode_return_mean": np.array([nan, 0.0, 0.1]),
        "rollout_success": np.array([nan, nan, nan]),
    }
    plots.learning_curve(tmp_path / "curve.png", "a run", curve, "interactions")
    report = {"replay_gaps": [0.0, 0.02], "replay_gap_median": 0.01, "replay_gap_p90": 0.02}
    plots.replay_gap(tmp_path / "gap.png", "a run", report)
    none = np.zeros((0, 4, 3))
    plots.coverage(tmp_path / "coverage.png", "a run", TASK, none, np.zeros(0), none, {})
    for file in tmp_path.iterdir():
        with Image.open(file) as picture:
            assert len(picture.convert("RGB").getcolors(1 << 24)) > 20


def test_the_coverage_of_a_body_bears_its_name(figures):
    plots.coverage(Path("coverage.png"), "a run", TASK, START, np.zeros(1), START, {})
    titles = [axis.get_title(loc="left") for axis in figures[0].axes]
    assert titles[:3] == ["box1", "box2", "box3"]


def test_each_dot_of_the_coverage_has_the_colour_of_its_depth(figures):
    poses = np.repeat(START, 3, axis=0)
    poses[:, :, 0] = np.array([1.0, 2.0, 3.0])[:, None]
    plots.coverage(Path("coverage.png"), "a run", TASK, poses, np.array([7.0, 3.0, 5.0]), START, {})
    for axis in figures[0].axes[:3]:
        (dots,) = (one for one in axis.collections if one.get_array() is not None)
        found = dict(zip(dots.get_offsets()[:, 0], dots.get_array(), strict=True))
        assert found == {1.0: 7.0, 2.0: 3.0, 3.0: 5.0}
        assert list(dots.get_array()) == [3.0, 5.0, 7.0]  # the deepest are drawn last


def test_each_start_that_a_tree_grew_towards_has_a_cross(figures):
    starts = np.repeat(START, 2, axis=0)
    starts[1, 1:, 0] += 0.5
    plots.coverage(Path("coverage.png"), "a run", TASK, START, np.zeros(1), starts, {})
    for body, axis in enumerate(figures[0].axes[:3], start=1):
        (crosses,) = (one for one in axis.collections if one.get_array() is None)
        assert np.array_equal(crosses.get_offsets(), starts[:, body, :2])
    assert "crosses: " in figures[0].get_supxlabel()


def test_the_region_in_which_an_object_starts_is_in_its_panel_alone(figures):
    ring = np.array([[1.0, 2.0], [3.0, 2.0], [3.0, 4.0]])
    plots.coverage(Path("coverage.png"), "a run", TASK, START, np.zeros(1), START, {2: ring})
    dashed = [
        [line.get_xydata() for line in axis.get_lines() if line.is_dashed()]
        for axis in figures[0].axes[:3]
    ]
    assert dashed[0] == dashed[2] == [] and np.array_equal(dashed[1][0][[0, 1, 2]], ring)
    assert "dashed: where the centre" in figures[0].get_supxlabel()
    plots.coverage(Path("coverage.png"), "a run", TASK, START, np.zeros(1), START, {})
    assert "dashed" not in figures[1].get_supxlabel()


DISC = "disc: {centre: [1, 1], radius: 0.5}"
POSE = "pose: [0, 0, 0], within: [0.1, 0.2]"
AREA, OUTLINE = "goal of the centre", "outline that the object is to have"
AVOIDED = "in red, what it is to avoid"


@pytest.mark.parametrize(
    ("goal", "words"),
    [
        (f"{{{DISC}}}", [AREA]),
        ("{covers: {at: [0, 0, 0], share: 0.9}}", [OUTLINE]),
        (f"{{{POSE}}}, {{{DISC}, not: true}}", [AREA, OUTLINE, AVOIDED]),
        (f"{{{DISC}, not: true}}, {{angle: [1, 2]}}", [AVOIDED]),
        ("{angle: [1, 2]}", []),
    ],
)
def test_the_coverage_says_what_its_marks_mean(figures, goal, words):
    task = _core.Config.from_file(paths.CONFIG / "push_t.yaml", [f"task.goal=[{goal}]"]).task
    start = task.start[None]
    plots.coverage(Path("coverage.png"), "a run", task, start, np.zeros(1), start, {})
    said = figures[0].get_supxlabel()
    assert [word for word in (AREA, OUTLINE, AVOIDED) if word in said] == words
    assert ("shaded: " in said) == bool(words)


@pytest.mark.parametrize(("rollouts", "shown"), [(0.5, 2), (float("nan"), 1)])
def test_a_single_evaluation_is_a_dot_and_what_is_not_measured_is_not_in_the_legend(
    figures, rollouts, shown
):
    columns = ["interactions", "success_rate", "episode_length_mean", "episode_return_mean"]
    curve = {name: np.array([0.3]) for name in columns}
    curve["rollout_success"] = np.array([rollouts])
    plots.learning_curve(Path("curve.png"), "a run", curve, "interactions")
    lines = figures[0].axes[0].get_lines()
    assert len(lines) == len(figures[0].legends[0].get_texts()) == shown
    assert all(line.get_marker() == "o" for line in lines)


def test_curves_that_coincide_are_both_seen(figures):
    columns = ["interactions", "success_rate", "episode_length_mean", "episode_return_mean"]
    curve = {name: np.zeros(2) for name in [*columns, "rollout_success"]}
    plots.learning_curve(Path("curve.png"), "a run", curve, "interactions")
    below, above = sorted(figures[0].axes[0].get_lines(), key=lambda line: line.get_zorder())
    assert above.get_zorder() > below.get_zorder()
    assert below.get_linewidth() > 2.0 * above.get_linewidth()


def test_few_gaps_are_counted_in_whole_steps(figures):
    report = {"replay_gaps": [0.01] * 13, "replay_gap_median": 0.01, "replay_gap_p90": 0.01}
    plots.replay_gap(Path("gap.png"), "a run", report)
    ticks = figures[0].axes[0].get_yticks()
    assert np.array_equal(ticks, ticks.round())


def test_the_legend_of_the_curves_covers_none_of_them(figures):
    columns = ["interactions", "success_rate", "episode_length_mean", "episode_return_mean"]
    curve = {name: np.linspace(0.0, 1.0, 5) for name in [*columns, "rollout_success"]}
    plots.learning_curve(Path("curve.png"), "a run", curve, "interactions")
    (figure,) = figures
    figure.draw_without_rendering()
    legend = figure.legends[0].get_window_extent()
    assert len(figure.legends[0].get_texts()) == 2
    assert not any(legend.overlaps(axis.get_window_extent()) for axis in figure.axes)


@pytest.mark.parametrize("count", [3, 14, 15, 16, 17, 40])
def test_a_headline_fits_into_its_file(tmp_path, count):
    with plots.style():
        figure = plt.figure(figsize=(9.6, 1.0), layout="constrained")
        plots.headline(figure, "starts; " * count)
        plots.save(figure, tmp_path / "a.png")
    with Image.open(tmp_path / "a.png") as picture:
        shown = np.asarray(picture.convert("RGB"))
    inked = np.flatnonzero((shown != PAPER).any(axis=(0, 2)))
    assert shown.shape[1] == 1248 and 0 < inked[0] < 20 and 100 < inked[-1] < 1245


def test_the_legend_of_gaps_hides_neither_line(figures):
    report = {"replay_gaps": [0.0002] * 13, "replay_gap_median": 0.0002, "replay_gap_p90": 0.01}
    plots.replay_gap(Path("gap.png"), "a run", report)
    (axis,) = figures[0].axes
    figures[0].draw_without_rendering()
    legend = axis.get_legend().get_window_extent()
    tops = [line.get_window_extent().y1 for line in axis.get_lines()]
    assert len(tops) == 2 and max(tops) < legend.y0


def of_kinds(*kinds):
    """Gathering with its boxes of these kinds."""
    kinds = [f"task.bodies.{k}.kind={kind}" for k, kind in enumerate(kinds, 1)]
    goal = "task.goal=[{kind: '*', disc: {centre: [0, 0], radius: 2}}]"
    return _core.Config.from_file(paths.CONFIG / "gathering.yaml", [*kinds, goal]).task


def test_a_kind_with_the_name_of_a_colour_has_it():
    colours = kind_colours(of_kinds("red", "blue", "crate"))
    red, green, blue = colours["red"]
    assert red > green + 60 and red > blue + 60
    assert colours["blue"][2] > max(colours["blue"][:2]) + 60
    assert colours["crate"] == KIND_PALETTE[0]


@pytest.mark.parametrize("kinds", [("orange", "box", "crate"), ("box", "teal", "red")])
def test_kinds_can_be_told_apart_from_those_with_the_name_of_a_colour(kinds):
    colours = list(kind_colours(of_kinds(*kinds)).values())
    for one, other in itertools.combinations(colours, 2):
        assert math.dist(one, other) > 75.0


def test_the_key_has_a_swatch_per_kind_and_fits():
    for kinds in (("red", "blue", "crate"), ["m" * 39 + k for k in "abc"]):
        task = of_kinds(*kinds)
        band = key(task, 300)
        inked = np.flatnonzero((band != PAPER).any(axis=(0, 2)))
        assert band.shape[1] == 300 and 60 < inked[-1] < 298
        for colour in kind_colours(task).values():
            assert (np.abs(band.astype(int) - colour).sum(axis=2) < 30).sum() >= 4
    assert band.shape[0] == 3 * len(key(of_kinds("red", "red", "red"), 300)), "a line for each"


def test_the_film_has_the_key_below_its_states(tmp_path):
    task = of_kinds("red", "blue", "crate")
    film(tmp_path / "film.gif", task, np.repeat(START, 2, axis=0), success=False, title="one")
    with Image.open(tmp_path / "film.gif") as picture:
        shown = np.asarray(picture.convert("RGB"))[-20:].astype(int)
    for colour in kind_colours(task).values():
        assert (np.abs(shown - colour).sum(axis=2) < 30).any()


class NoGoal:
    """A task whose second goal state cannot be drawn."""

    def __init__(self, task):
        self._task = task

    def __getattr__(self, name):
        return getattr(self._task, name)

    def goal_state(self, seed, index):
        return None if index == 1 else self._task.goal_state(seed, index)

    def why_no_goal_state(self, seed, index):
        return "task.goal.0 did not hold in 93% of the failed tries"


def test_the_picture_of_a_task_says_which_term_left_a_goal_state_out(tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(task_picture, "write_sheet", lambda *args: drawn.append(args))
    config = SimpleNamespace(task=NoGoal(TASK), evaluation_jitter=0.1)
    task_picture.draw(tmp_path / "task.png", config)
    ((*_, tiles, _, title),) = drawn
    assert [tile.caption for tile in tiles].count("a goal state") == 3
    assert title.endswith("; no goal state 2: task.goal.0 did not hold in 93% of the failed tries")
    assert TASK.why_no_goal_state(1, 0) == ""


def test_the_picture_of_a_task_says_who_is_to_avoid_what_is_red(tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(task_picture, "write_sheet", lambda *args: drawn.append(args))
    avoided = f"{{{DISC}, not: true}}, {{kind: t, {DISC}, not: true}}"
    goal = f"task.goal=[{avoided}, {{{POSE}}}]"
    task_picture.draw(
        tmp_path / "task.png", _core.Config.from_file(paths.CONFIG / "push_t.yaml", [goal])
    )
    assert drawn[0][-1].endswith("; red: to be avoided by any object or by 't'")


def test_sheets_as_pdf_and_svg_are_drawn_by_vectors(tmp_path):
    config = _core.Config.from_file(paths.CONFIG / "art_manip.yaml")
    task_picture.draw(tmp_path / "task.pdf", config)
    assert b"/Subtype /Image" not in (tmp_path / "task.pdf").read_bytes()
    task_picture.draw(tmp_path / "task.svg", config)
    text = (tmp_path / "task.svg").read_text()
    red, green, blue = kind_colours(config.task)["link"]
    assert f"#{red:02x}{green:02x}{blue:02x}" in text and "<image" not in text
    assert text.count('id="axes_') == 8


def test_angles_and_distances_of_the_goal_are_drawn_around_bodies():
    task = _core.Config.from_file(paths.CONFIG / "pack.yaml").task
    picture, window = state_image(task, task.start[None]), arena_window(task)
    x, y, _ = task.start[1]
    radius = 0.6 * math.sqrt(2.0)
    assert pixel(picture, x + 1.3 * radius, y, window) != PAPER, "the angle that is asked for"
    assert pixel(picture, x, y + 1.3 * radius, window) == PAPER
    assert pixel(picture, 0.0, 6.95, window) != PAPER, "the band along the wall"
    assert pixel(picture, 0.0, 6.7, window) == PAPER
