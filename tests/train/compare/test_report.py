"""The report of a comparison whose figures are made up."""

import csv
import json
import re
import shutil

import pytest
from comparison_samples import finished, table_row, write_grid
from PIL import Image
from rtg import cli
from rtg.compare import report_files
from rtg.compare.cells import Cell, Grid
from rtg.compare.report_files import write_report
from rtg.errors import UserError
from rtg.files import checked_table
from rtg.files.run_folder import write_json

GOOD, BAD = [0.2, 0.8, 0.96], [0.0, 0.5, 0.6, 0.7]
SWEPT = "train.offline_share=-1"
CELLS = [
    *(
        Cell("gathering", method, (), seed)
        for method in ("ddqn_rtg", "ddqn_naive")
        for seed in (1, 2)
    ),
    Cell("gathering", "her", (), 1),
    Cell("gathering", "ddqn_rtg", (SWEPT,), 1),
    Cell("sorting", "ddqn_rtg", (), 1),
    Cell("sorting", "rcg", (), 1),
]
BY_METHOD = [CELLS[k] for k in (2, 3, 0, 1, 5, 4, 6, 7)]  # as tables show them


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("comparison")
    for cell in CELLS[:4]:
        finished(path, cell, GOOD if cell.method == "ddqn_rtg" else BAD, offline_transitions=7)
    finished(path, CELLS[3 + 2], BAD, defects=["3 transitions lost"])
    (path / CELLS[4].name).mkdir(parents=True)  # failed
    (path / CELLS[6].name).mkdir(parents=True)  # unfinished
    how = "ended with exit status 1; the end of its log:\nTraceback\nMemoryError"
    write_grid(path, CELLS[::-1], {CELLS[4].name: f"{CELLS[4].name} {how}"})
    write_report(path, path)
    return path


@pytest.fixture(scope="module")
def page(folder):
    return (folder / "report.md").read_text()


def test_a_row_has_the_figures_of_its_seeds(page):
    to_95 = ["15 ± 0", "315 ± 0", "210 ± 0"]  # interactions, pushes and CPU seconds of all
    good = ["1-2", "0.960 ± 0.000", "21.6 ± 0.0", "0.86 ± 0.00", "0.20 ± 0.00", "10 ± 0", *to_95]
    assert table_row(page, "ddqn_rtg") == good
    bad = ["1-2", "0.700 ± 0.000", "32.0 ± 0.0", "0.63 ± 0.00", "0.00 ± 0.00", "20 ± 0"]
    assert table_row(page, "ddqn_naive") == [*bad, "never", "never", "never"]


def test_a_row_of_the_second_table_has_what_the_runs_cost(page):
    generated = ["120 ± 0", "300 ± 0", "60 ± 0", "50 ± 0"]
    learned, whole = ["15 ± 0", "90 ± 0", "100 ± 0"], ["315 ± 0", "210 ± 0"]
    costs = table_row(page, "ddqn_rtg", "generation: pushes")
    assert costs == ["1-2", *generated, *learned, *whole]


def test_the_data_and_what_q_makes_of_them_have_a_row(page):
    lines = page.split("## Data")[1].splitlines()
    row = next(line for line in lines if line.startswith("| gathering | `ddqn_rtg` |"))
    data = "120 ± 0 | 24 ± 0 | 96 ± 0 | 4.9 ± 0.0 | 0.50 ± 0.00 | 12 ± 0"
    assert f"| {data} | 0.0060 ± 0.0000 |" in row
    assert row.endswith("| 0.75 ± 0.00 | 0.020 ± 0.000 | 0.070 ± 0.000 |")


def test_the_episode_shown_is_a_success_if_any_method_has_one(tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(report_files, "_draw_episode", lambda out, task, one: drawn.append(one))
    cells = [CELLS[0], CELLS[2]]
    for cell, success in zip(cells, (0.2, 0.9), strict=True):
        finished(tmp_path, cell, [success])
    write_grid(tmp_path, cells)
    write_report(tmp_path, tmp_path)
    assert [(one.label, one.success) for one in drawn] == [("ddqn_naive", True)]


def test_a_bar_that_some_seeds_never_reach_says_how_many_do(tmp_path):
    cells = [Cell("gathering", "ddqn_rtg", (), seed) for seed in (1, 2, 3)]
    for cell, course in zip(cells, (GOOD, BAD, [0.95]), strict=True):
        finished(tmp_path, cell, course)
    write_grid(tmp_path, cells)
    page = write_report(tmp_path, tmp_path).read_text()
    reached = ["10 ± 7", "310 ± 7", "160 ± 71"]
    assert table_row(page, "ddqn_rtg")[-3:] == [f"{value} (2 of 3)" for value in reached]


def test_runs_without_a_result_say_why(page):
    assert table_row(page, "her")[:2] == ["1 failed", "–"]
    assert table_row(page, "ddqn_rtg", "## sorting")[:2] == ["1 unfinished", "–"]
    assert table_row(page, "rcg", "## sorting")[:2] == ["1 not run", "–"]
    assert table_row(page, "rcg")[:2] == ["not run", "–"]
    of_task = page.split("## sorting")[1].split("\n## ")[0]
    assert "| `her` | not run |" in of_task and f"`ddqn_rtg@{SWEPT}`" not in of_task
    missing = "`dqn`, `ddqn`, `ddqn_random`, `ddqn_scatter`, `ddqn_forward`, `ddqn_rtg_dr`, "
    assert f"Not run: {missing}`cql_rtg`, `bc_rtg`, `planner`." in page
    assert "- `gathering/her/seed-1` failed: ended with exit status 1: MemoryError" in page
    assert f"- `gathering/ddqn_rtg@{SWEPT}/seed-1`: 3 transitions lost" in page


def test_all_tasks_are_pooled_and_compared_with_the_reference(page):
    pooled = "## All tasks together"
    same = "0.960 [0.960, 0.960]"
    assert table_row(page, "ddqn_rtg", pooled) == ["1", same, same, "0.960", "2 of 2", "–"]
    assert table_row(page, "ddqn_naive", pooled)[-1] == "0.000 [0.000, 0.000]"


def test_remarks_beside_the_runs_are_part_of_the_report(folder, page, tmp_path):
    assert "## Remarks" not in page
    runs = shutil.copytree(folder, tmp_path / "runs")
    (runs / "remarks.md").write_text("The robot was tired.\n")
    report = write_report(runs, tmp_path / "out").read_text()
    assert "\n\n## Remarks\n\nThe robot was tired.\n" in report


def test_the_third_of_a_run_that_ended_before_is_its_final_success(tmp_path):
    """The evaluations that ended it went well, perhaps by chance."""
    cells = [Cell("gathering", "ddqn_rtg", (), seed) for seed in (1, 2, 3)]
    for cell, budget in zip(cells, (30_000, 44_999, 45_000), strict=True):
        finished(tmp_path, cell, GOOD, budget=budget, success_rate=0.9)
    write_grid(tmp_path, cells)
    write_report(tmp_path, tmp_path)
    with (tmp_path / "runs.csv").open() as file:
        assert [run["success_at_third"] for run in csv.DictReader(file)] == ["0.8", "0.8", "0.9"]


def test_the_budget_and_the_runs_that_did_not_use_it_up_are_told(tmp_path):
    methods = ("ddqn_rtg", "bc_rtg", "her", "planner")
    cells = [Cell("gathering", method, (), 1) for method in methods]
    for cell, budget in zip(cells, (60_000, 60_000, 15_000, 60_000), strict=True):
        finished(tmp_path, cell, GOOD, budget=budget, final_episodes=20 if budget < 6e4 else 1000)
    write_grid(tmp_path, cells)
    words = " ".join(write_report(tmp_path, tmp_path).read_text().split())
    told = "Budget: 15,000 or 60,000 interactions, an evaluation every 2,500 from 100 starts, the "
    assert told + "final one from 20 or 1,000. 2 of the 3 runs ended before, because" in words


def test_transitions_of_another_commit_are_told(tmp_path):
    cells = [Cell("gathering", "ddqn_rtg", (), seed) for seed in (1, 2)]
    for cell, maker in zip(cells, ("abc", "old"), strict=True):
        finished(tmp_path, cell, GOOD)
        made_with = {"git_revision": "abc", "generator": {"git_revision": maker}}
        made_with["begun_by"] = ["old"] if maker == "old" else []
        write_json(tmp_path / cell.name / "versions.json", made_with)
    write_grid(tmp_path, cells)
    page = write_report(tmp_path, tmp_path).read_text()
    assert "\n  - `abc`: gathering `ddqn_rtg` 1\n" in page
    assert "\n  - `abc`, begun by `old`, transitions by `old`: gathering `ddqn_rtg` 2\n" in page


def test_the_learners_are_named_and_a_run_without_gradient_steps_has_none(tmp_path):
    cells = [Cell("gathering", method, (), 1) for method in ("ddqn_rtg", "ddqn_naive", "planner")]
    cpu = {"gradient_steps": 5}
    for cell, more in zip(cells, (cpu, cpu, {"gradient_steps": 0}), strict=True):
        finished(tmp_path, cell, GOOD, **more)
    write_grid(tmp_path, cells)
    page = write_report(tmp_path, tmp_path).read_text()
    learned = "  - cpu, float32, one core: gathering `ddqn_naive` 1; gathering `ddqn_rtg` 1\n"
    of_planner = "  - none: gathering `planner` 1\n"
    assert f"- learner, not the same for all runs:\n{learned}{of_planner}" in page


def test_the_page_says_where_it_comes_from_and_shows_all_pictures(folder, page):
    assert "    ./run.sh reproduce gathering\n" in page and "- commit: `abc`\n" in page
    shown = set(re.findall(r"\]\((\w+\.(?:png|gif))\)", page))
    assert shown == {path.name for path in folder.iterdir() if path.suffix in {".png", ".gif"}}
    expected = ("costs", "curves", "sweep", "strip")
    assert shown == {
        *(f"{name}_gathering.png" for name in expected),
        "film_gathering.gif",
        "replay_gap.png",
        "profiles.png",
    }
    assert str(folder) not in page


def test_the_pictures_are_pictures(folder):
    for path in folder.glob("*.png"):
        with Image.open(path) as picture:
            assert len(picture.convert("RGB").getcolors(1 << 24)) > 50, path.name


def test_a_run_has_its_figures_for_programs(folder):
    with (folder / "runs.csv").open() as file:
        (run,) = (
            r for r in csv.DictReader(file) if (r["method"], r["seed"]) == ("ddqn_naive", "2")
        )
    figures = {
        "task": "gathering",
        "success_rate": 0.7,
        "episode_length_mean": 32,
        "rollout_success": 0.63,
        "interactions": 20000,
        "success_at_third": 0,
        "interactions_to_70": 20000,
        "interactions_to_95": "",
        "pushes_to_95": "",
        "cpu_s_to_95": "",
        "transitions": 120000,
        "replays": 300000,
        "generate_cpu_s": 60,
        "generate_wall_s": 50,
        "train_cpu_s": 90,
        "train_wall_s": 100,
        "q_rank_correlation": 0.75,
        "whole_pushes": 320000,
        "whole_cpu_s": 260,
        "commit": "abc",
    }
    assert {name: run[name] for name in figures} == {k: str(v) for k, v in figures.items()}


def test_the_tables_for_programs_have_a_row_per_run_and_per_evaluation(folder):
    with (folder / "runs.csv").open() as file:
        runs = list(csv.DictReader(file))
    assert [run["state"] for run in runs].count("done") == 5
    assert {run["whole_pushes"] for run in runs} == {"315000", "320000", ""}
    assert {run["offline_transitions"] for run in runs} == {"7", ""}  # no key of every summary
    assert [(run["task"], run["method"], int(run["seed"])) for run in runs] == [
        (cell.task, cell.label, cell.seed) for cell in BY_METHOD
    ]
    with (folder / "curves.csv").open() as file:
        curves = list(csv.DictReader(file))
    assert len(curves) == 2 * len(GOOD) + 3 * len(BAD)
    of_naive = curves[:2]  # the first ones, as in the table
    assert [row["success_rate"] for row in of_naive] == ["0", "0.5"]
    assert [row["interactions"] for row in of_naive] == ["5000", "10000"]
    assert [row["pushes"] for row in of_naive] == ["305000", "310000"]  # with the generation's
    assert [row["cpu_s"] for row in of_naive] == ["110", "160"]


def test_made_again_all_files_are_the_same(folder, tmp_path):
    write_report(folder, tmp_path / "results")
    for path in (tmp_path / "results").iterdir():
        assert path.read_bytes() == (folder / path.name).read_bytes(), path.name


def assert_named_and_report_stays(runs, path, words):
    before = {p.name: p.read_bytes() for p in runs.iterdir() if p.is_file()}
    with pytest.raises(UserError, match=re.escape(f"{path}:") + f".*{words}"):
        write_report(runs, runs)
    assert {p.name: p.read_bytes() for p in runs.iterdir() if p.is_file()} == before


def test_remarks_that_are_no_text_are_named_and_the_report_before_stays(folder, tmp_path):
    runs = tmp_path / "runs"
    shutil.copytree(folder, runs)
    (runs / "remarks.md").write_bytes(b"\xff\xfe")
    assert_named_and_report_stays(runs, runs / "remarks.md", "legal: text")


def test_a_picture_that_no_run_stands_behind_does_not_stay(folder, tmp_path):
    for name in ("curves_gone.png", "curves_mine.png", "mine.png"):
        (tmp_path / name).write_bytes(b"old")
    (tmp_path / "report.md").write_text("![Learning curves](curves_gone.png) ![](mine.png)")
    write_report(folder, tmp_path)
    assert not (tmp_path / "curves_gone.png").exists()
    assert (tmp_path / "curves_mine.png").exists() and (tmp_path / "mine.png").exists()


def test_small_budgets_are_told(page, tmp_path):
    grid = Grid({}, {})
    grid.add("./run.sh reproduce --quick", CELLS)
    grid.write(tmp_path)
    told = "**Small budgets (`--quick`): "
    assert told in write_report(tmp_path, tmp_path).read_text() and told not in page


def test_a_comparison_without_a_result_has_a_report_too(tmp_path):
    write_grid(tmp_path, CELLS)
    page = write_report(tmp_path, tmp_path).read_text()
    assert table_row(page, "ddqn_rtg")[:2] == ["1-2 not run", "–"]


def test_the_command_writes_the_report_and_names_what_is_no_comparison(folder, tmp_path, capsys):
    assert cli.main(["plot", str(folder), "--out", str(tmp_path / "results")]) == 0
    assert capsys.readouterr().out == f"report: {tmp_path / 'results' / 'report.md'}\n"
    assert cli.main(["plot", str(tmp_path)]) == 2
    assert capsys.readouterr().err.startswith(
        f"rtg: {tmp_path}: holds neither a comparison (grid.json) nor a run (config.yaml)"
    )
    assert cli.main(["plot", str(folder), "--out", ""]) == 2
    assert capsys.readouterr().err == "rtg: --out: the path is empty; legal: the path of a folder\n"
    assert cli.main(["plot", str(folder), "--out", "/proc/rtg"]) == 2
    assert capsys.readouterr().err.startswith("rtg: --out: /proc/rtg: ")


def test_the_command_draws_a_comparison_as_vectors(folder, tmp_path):
    assert cli.main(["plot", str(folder), "--out", str(tmp_path), "--format", "svg"]) == 0
    assert (tmp_path / "curves_gathering.svg").read_text().startswith("<?xml")
    assert (tmp_path / "curves_gathering.png").is_file(), "the page shows it"
    assert "(curves_gathering.png)" in (tmp_path / "report.md").read_text()
    assert cli.main(["plot", str(folder), "--format", "bmp"]) == 2


DAMAGED = {
    "summary.json": ('{"interactions": 5}', "no success_rate; legal: "),
    "versions.json": ("{", "damaged; legal: "),
    "progress.csv": ("interactions,success_rate\n5,much\n", "damaged; legal: "),
    "best_episode.npz": ("PK", "damaged; legal: "),
    "config.yaml": ("task: {", "legal: YAML"),
}


def test_curves_without_costs_are_named(folder, tmp_path):
    """An earlier version left such curves."""
    runs = tmp_path / "runs"
    shutil.copytree(folder, runs)
    path = runs / CELLS[0].name / "progress.csv"
    path.write_text(checked_table.plain(path.read_text()).replace("cpu_s", "other"))
    assert_named_and_report_stays(runs, path, "lacks columns; legal: ")


@pytest.mark.parametrize("name", ["replays", "interactions", "trees", "pushing_iterations_p90"])
def test_a_summary_of_another_kind_is_named(folder, tmp_path, name):
    runs = tmp_path / "runs"
    shutil.copytree(folder, runs)
    path = runs / CELLS[0].name / "summary.json"
    write_json(path, {**json.loads(path.read_text()), name: "many"})
    assert_named_and_report_stays(runs, path, "other fields than it should")


@pytest.mark.parametrize("name", DAMAGED)
def test_a_damaged_file_is_named_and_the_report_before_stays(folder, tmp_path, name):
    runs = tmp_path / "runs"
    shutil.copytree(folder, runs)
    text, words = DAMAGED[name]
    path = runs / CELLS[0].name / name
    path.write_text(text)
    assert_named_and_report_stays(runs, path, words)


def test_replay_gaps_of_another_method_are_drawn_where_the_reference_has_none(tmp_path):
    cells = Cell("gathering", "ddqn", (), 1), Cell("gathering", "ddqn_naive", (), 1)
    finished(tmp_path, cells[0], BAD)
    summary = tmp_path / cells[0].name / "summary.json"
    known = json.loads(summary.read_text())
    del known["replay_gap_counts"]  # nothing was generated
    write_json(summary, known)
    finished(tmp_path, cells[1], BAD)
    write_grid(tmp_path, cells)
    write_report(tmp_path, tmp_path)
    assert (tmp_path / "replay_gap.png").is_file()
