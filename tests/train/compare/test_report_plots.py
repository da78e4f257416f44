"""Checks what the pictures of a comparison show."""

import itertools
import statistics

import matplotlib.pyplot as plt
import numpy as np
import pytest
from comparison_samples import finished, write_grid
from rtg.compare import report_plots
from rtg.compare.cells import Cell, read_grid
from rtg.compare.methods import METHODS
from rtg.compare.report_plots import split_names
from rtg.compare.run_results import read_comparison
from rtg.files import checked_table, replay_gaps


def comparison(folder, courses):
    """courses: by cell."""
    for cell, course in courses.items():
        finished(folder, cell, course)
    write_grid(folder, list(courses))
    return read_comparison(folder, read_grid(folder))


def test_a_line_is_the_mean_of_the_seeds_of_which_one_may_have_ended_early(tmp_path, figures):
    cells = {
        Cell("gathering", "ddqn_rtg", (), 1): [0.2, 0.9],
        Cell("gathering", "ddqn_rtg", (), 2): [0.0, 0.5, 0.7],
        Cell("gathering", "dqn", (), 1): [0.0, 0.1],
    }
    report_plots.curves(tmp_path / "curves.png", comparison(tmp_path, cells), "gathering")
    axis = figures[0].axes[0]
    lines = [line for line in axis.get_lines() if line.get_marker() != "o"]
    assert [line.get_xdata().tolist() for line in lines] == [[5.0, 10.0], [5.0, 10.0, 15.0]]
    assert np.allclose(lines[0].get_ydata(), [0.0, 0.1])
    assert np.allclose(lines[1].get_ydata(), [0.1, 0.7, 0.8])
    assert len(axis.collections) == 1, "a single seed has no spread"
    words = [text.get_text() for text in figures[0].legends[0].get_texts()]
    assert words == ["dqn: 0.10 (1)", "ddqn_rtg: 0.80 (2)"]
    assert lines[0].get_color() != lines[1].get_color()
    dots = [line.get_ydata()[-1] for line in axis.get_lines() if line.get_marker() == "o"]
    assert np.allclose(dots, [0.1, 0.8]), "where the legend says"


def test_lines_that_hide_each_other_at_zero_are_named(tmp_path, figures):
    cells = {
        Cell("gathering", "dqn", (), 1): [0.0, 0.0],
        Cell("gathering", "her", (), 1): [0.0, 0.0],
        Cell("gathering", "ddqn_rtg", (), 1): [0.0, 0.5],
    }
    report_plots.curves(tmp_path / "curves.png", comparison(tmp_path, cells), "gathering")
    assert figures[0].axes[0].get_xlabel() == "always 0: dqn, her"


def test_long_names_stay_within_the_picture_and_are_broken_between_settings(tmp_path, figures):
    settings = ("train.interactions=400", "train.eval_every=200", "search.transitions=2000")
    cells = {
        Cell("gathering", method, (setting, *settings), 1): [0.0, 0.0]
        for method in ("dqn", "her")
        for setting in ("train.batch=16", "train.batch=32")
    }
    report_plots.curves(tmp_path / "curves.png", comparison(tmp_path, cells), "gathering")
    (figure,) = figures
    (legend,) = figure.legends
    figure.draw_without_rendering()
    assert legend.get_window_extent().width <= figure.bbox.width
    hidden = figure.axes[0].xaxis.label
    for text in (hidden, *legend.get_texts()):
        words = text.get_text().split()
        assert {word.strip("@,:") for word in words} >= set(settings)


def test_the_band_is_the_sample_deviation_from_where_all_seeds_have_a_value(tmp_path, figures):
    cells = [Cell("gathering", "ddqn_rtg", (), seed) for seed in (1, 2, 3)]
    for cell, course in zip(
        cells, ([0.1, 0.4, 0.2], [0.3, 0.4, 0.5], [0.2, 0.7, 0.2]), strict=True
    ):
        finished(tmp_path, cell, course)
    log = tmp_path / cells[1].name / "progress.csv"  # no training episode had ended by then
    rows = checked_table.plain(log.read_text()).splitlines()
    at = rows[0].split(",").index("rollout_success")
    first = rows[1].split(",")
    first[at] = ""
    log.write_text("\n".join([rows[0], ",".join(first), *rows[2:]]) + "\n")
    write_grid(tmp_path, cells)
    shown = read_comparison(tmp_path, read_grid(tmp_path))
    report_plots.curves(tmp_path / "curves.png", shown, "gathering")
    greedy, rollouts = figures[0].axes[:2]
    assert [line.get_xdata().tolist()[0] for line in (greedy.lines[0], rollouts.lines[0])] == [
        5,
        10,
    ]
    band = greedy.collections[0].get_paths()[0].vertices
    for x, values in ((5.0, [0.1, 0.3, 0.2]), (10.0, [0.4, 0.4, 0.7]), (15.0, [0.2, 0.5, 0.2])):
        mean, deviation = statistics.fmean(values), statistics.stdev(values)
        edges = sorted({round(y, 6) for at, y in band if at == x})
        assert np.allclose([edges[0], edges[-1]], [mean - deviation, mean + deviation])


def test_of_a_single_evaluation_mean_and_deviation_are_shown(tmp_path, figures):
    cells = [Cell("gathering", "ddqn_rtg", (), seed) for seed in (1, 2, 3)]
    shown = comparison(tmp_path, {cell: [0.2 * cell.seed] for cell in cells})
    report_plots.curves(tmp_path / "curves.png", shown, "gathering")
    greedy = figures[0].axes[0]
    dots = [line for line in greedy.lines if line.get_marker() == "o"]
    assert [line.get_ydata()[-1] for line in dots] == [pytest.approx(0.4)]
    segments = [one.get_segments() for one in greedy.collections if hasattr(one, "get_segments")]
    assert np.allclose(segments, [[[[5.0, 0.2], [5.0, 0.6]]]])


def test_of_many_labels_the_methods_alone_have_curves(tmp_path):
    most = len(METHODS)
    swept = [Cell("gathering", "dqn", (f"train.batch={k}",), 1) for k in range(1, most)]
    cells = [Cell("gathering", "dqn", (), 1), *swept, Cell("sorting", "her", (), 1)]
    few = comparison(tmp_path / "few", {cell: [0.1] for cell in cells[:most]})
    assert len(report_plots.curve_labels(few, "gathering")) == most
    more = [*cells, Cell("gathering", "ddqn", (), 1)]
    many = comparison(tmp_path / "many", {cell: [0.1] for cell in more})
    assert report_plots.curve_labels(many, "gathering") == ["dqn", "ddqn"]


def test_each_method_has_a_colour():
    assert tuple(report_plots._PALETTE) == METHODS
    assert len({colour for colour, _ in report_plots._PALETTE.values()}) == len(METHODS)


def test_success_is_drawn_over_each_mean_cost_of_the_whole_run(tmp_path, figures):
    cells = [Cell("gathering", "ddqn_rtg", (), seed) for seed in (1, 2)]
    planner = Cell("gathering", "planner", (), 1)
    finished(tmp_path, cells[0], [0.2, 0.9], replays=300_000, generate_cpu_s=60.0)
    finished(tmp_path, cells[1], [0.0, 0.5, 0.7], replays=100_000, generate_cpu_s=20.0)
    at = {"interactions": 0, "pushes": 7e6, "cpu_s": 500.0}
    of_none = {"replays": None, "generate_cpu_s": None, "interactions": 0}
    finished(tmp_path, planner, [0.97], every=at, **of_none)
    write_grid(tmp_path, [*cells, planner])
    shown = read_comparison(tmp_path, read_grid(tmp_path))
    report_plots.costs(tmp_path / "costs.png", shown, "gathering")
    lines = [
        {line.get_color(): line for line in axis.get_lines() if line.get_marker() != "o"}
        for axis in figures[0].axes
    ]
    rtg, planned = (report_plots._PALETTE[method][0] for method in ("ddqn_rtg", "planner"))
    over = [axis[rtg].get_xdata().tolist() for axis in lines]
    # The first run ends at 10,000 interactions, where its costs stay.
    assert over == [[5e3, 10e3, 12.5e3], [205e3, 210e3, 212.5e3], [90.0, 140.0, 165.0]]
    assert all(np.allclose(axis[rtg].get_ydata(), [0.1, 0.7, 0.8]) for axis in lines)
    at = [axis[planned].get_xdata().tolist() for axis in lines if planned in axis]
    assert at == [[7e6], [500.0]], "without interactions nothing is drawn over them"
    assert [axis.get_xscale() for axis in figures[0].axes] == ["log"] * 3


@pytest.mark.parametrize("low", [1.0, 2.3, 7.9])
@pytest.mark.parametrize("ratio", [1.1, 1.5, 3.0, 9.0, 30.0, 500.0])
def test_labels_of_costs_are_some_and_do_not_overlap(low, ratio):
    figure, axes = plt.subplots(1, 3, figsize=(12.6, 5.0), layout="constrained", sharey=True)
    axes[0].plot([1e5 * low, 1e5 * low * ratio], [0.0, 1.0])
    report_plots.scale_cost(axes[0])
    figure.draw_without_rendering()
    labels = axes[0].get_xticklabels()
    extents = [label.get_window_extent() for label in labels]
    left, _, right, _ = axes[0].get_window_extent().extents
    shown = [one for one in extents if one.width and left <= (one.x0 + one.x1) / 2 <= right]
    plt.close(figure)
    assert len(shown) >= 2
    assert all(one.x1 < other.x0 for one, other in itertools.pairwise(shown))


def test_a_sweep_shows_every_run_and_who_never_got_there(tmp_path, figures):
    cells = {
        Cell("gathering", "ddqn_rtg", (), 1): [0.5, 0.97],
        Cell("gathering", "ddqn_rtg", ("train.batch=8",), 1): [0.5, 0.96],
        Cell("gathering", "ddqn_rtg", ("train.batch=16",), 1): [0.5, 0.6],
        Cell("gathering", "ddqn_rtg", ("train.batch=16",), 2): [0.95, 0.96, 0.8],
        Cell("gathering", "dqn", (), 1): [0.0, 0.0],
    }
    report_plots.sweep(tmp_path / "sweep.png", comparison(tmp_path, cells), "gathering")
    success, reached = figures[0].axes
    dots = [line.get_xdata().tolist() for line in success.get_lines() if line.get_marker() == "o"]
    assert dots == [[0.97], [0.96], [0.6, 0.8]]
    dots = [line.get_xdata().tolist() for line in reached.get_lines() if line.get_marker() == "o"]
    assert dots == [[10.0], [10.0], [5.0]]
    assert [text.get_text() for text in reached.texts] == ["1 never"]
    names = [tick.get_text() for tick in success.get_yticklabels()]
    assert names == ["ddqn_rtg as it is", "train.batch=8", "train.batch=16"]


def test_who_never_got_there_stands_beside_the_dots_and_alone_without_numbers(tmp_path, figures):
    for curve in ([0.95, 0.96, 0.8], [0.5, 0.8]):
        cells = {Cell("gathering", "ddqn_rtg", ("train.batch=8",), 1): [0.5, 0.6]}
        cells[Cell("gathering", "ddqn_rtg", ("train.batch=8",), 2)] = curve
        shown = comparison(tmp_path / str(curve[0]), cells)
        report_plots.sweep(tmp_path / "sweep.png", shown, "gathering")
    some, none = (figure.axes[1] for figure in figures)
    some.figure.draw_without_rendering()
    (dots,) = (line for line in some.get_lines() if line.get_marker() == "o")
    (words,) = some.texts
    last = some.transData.transform((dots.get_xdata().max(), 0.0))[0]
    assert last + 5 < words.get_window_extent().x0
    assert len(none.get_xticks()) == 0 < len(some.get_xticks())


def test_swept_values_of_two_methods_are_told_apart(tmp_path, figures):
    cells = {
        Cell("gathering", method, ("train.batch=8", "train.clip_targets=true"), 1): [0.5]
        for method in ("dqn", "ddqn_rtg")
    }
    report_plots.sweep(tmp_path / "sweep.png", comparison(tmp_path, cells), "gathering")
    names = [tick.get_text() for tick in figures[0].axes[0].get_yticklabels()]
    swept = "train.batch=8\ntrain.clip_targets=true"
    assert names == [f"dqn\n{swept}", f"ddqn_rtg\n{swept}"]


def test_gaps_have_a_histogram_per_task_over_all_its_runs(tmp_path, figures):
    cells = {
        Cell("gathering", "ddqn_rtg", (), 1): [0.5],
        Cell("gathering", "ddqn_rtg", (), 2): [0.5],
        Cell("sorting", "ddqn_rtg", (), 1): [0.5],
    }
    runs = comparison(tmp_path, cells)
    of_tasks = {task: runs.done(task, "ddqn_rtg") for task in runs.tasks}
    report_plots.replay_gaps(tmp_path / "gaps.png", of_tasks)
    heights = [sum(bar.get_height() for bar in axis.patches) for axis in figures[0].axes]
    assert heights == [1000, 500]
    assert figures[0].axes[0].get_title(loc="left") == "gathering: 1,000 simulated reverse steps"


def test_the_axis_of_gaps_holds_those_of_every_task(tmp_path, figures):
    cells = {Cell(task, "ddqn_rtg", (), 1): [0.5] for task in ("gathering", "sorting")}
    runs = comparison(tmp_path, cells)
    of_tasks = {task: runs.done(task, "ddqn_rtg") for task in runs.tasks}
    counts = of_tasks["gathering"][0].summary["replay_gap_counts"]
    counts[:] = [0] * (len(counts) - 1) + [7]
    report_plots.replay_gaps(tmp_path / "gaps.png", of_tasks)
    assert figures[0].axes[-1].get_xlim()[1] >= replay_gaps.EDGES[-1]


def test_labels_are_drawn_without_what_they_share():
    labels = ["ddqn_rtg@train.batch=16", "ddqn_rtg@train.batch=128"]
    assert split_names(labels) == ("ddqn_rtg, train.batch", ["16", "128"])
    assert split_names(["ddqn", "ddqn_rtg"]) == ("", ["ddqn", "ddqn_rtg"])
