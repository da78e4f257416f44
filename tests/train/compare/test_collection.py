"""One report on comparisons and single runs."""

import pytest
from comparison_samples import CONFIG, finished, table_row, write_grid
from rtg import _core, cli
from rtg.compare.cells import Cell
from rtg.compare.collection import collect
from rtg.compare.report_files import write_joint_report
from rtg.errors import UserError
from rtg.files.run_folder import read_json, write_json

COURSE = [0.0, 0.5, 1.0]


def comparison(folder, *cells, failed=None):
    """A finished comparison of these cells."""
    for cell in cells:
        finished(folder, cell, COURSE)
    write_grid(folder, cells, failed)
    return folder


def single(folder, method="ddqn_rtg", seed=1, *settings):
    """A finished run by itself."""
    finished(folder.parent, Cell("x", method, (), seed), COURSE)
    (folder.parent / f"x/{method}/seed-{seed}").rename(folder)
    values = [f"run.method={method}", f"run.seed={seed}", "train.interactions=15000", *settings]
    (folder / "config.yaml").write_text(_core.Config.from_file(CONFIG, values).yaml)
    return folder


def naive(seed):
    return Cell("gathering", "ddqn_naive", (), seed)


def names(collection):
    return [run.cell.name for run in collection.comparison.results]


def test_runs_of_several_folders_stand_in_one_table(tmp_path, capsys):
    one = comparison(tmp_path / "one", naive(1), naive(2))
    alone = single(tmp_path / "alone")
    out = tmp_path / "out"
    (one / "remarks.md").write_text("Of the first.")
    assert cli.main(["plot", str(one), str(alone), "--out", str(out)]) == 0
    assert capsys.readouterr().out == f"report: {out}/report.md\n"
    page = (out / "report.md").read_text()
    assert table_row(page, "ddqn_naive")[0] == "1-2" and table_row(page, "ddqn_rtg")[0] == "1"
    assert f"    ./run.sh reproduce gathering\n    (a single run: {alone})\n" in page
    assert "Of the first." in page
    assert {path.name for path in out.iterdir()} >= {"runs.csv", "film_gathering.gif"}


def test_a_single_run_has_a_report_where_one_is_asked_for(tmp_path):
    alone = single(tmp_path / "alone")
    assert cli.main(["plot", str(alone), "--out", str(tmp_path / "out")]) == 0
    assert table_row((tmp_path / "out/report.md").read_text(), "ddqn_rtg")[0] == "1"


def test_several_folders_need_a_place_for_their_report(tmp_path, capsys):
    assert cli.main(["plot", str(tmp_path), str(tmp_path)]) == 2
    assert capsys.readouterr().err.startswith("rtg: --out: is missing; legal: --out DIR")


def test_rows_with_the_same_label_are_told_apart_by_their_settings(tmp_path):
    runs = [single(tmp_path / "a", "ddqn_rtg", 1), single(tmp_path / "b", "ddqn_rtg", 2)]
    other = single(tmp_path / "c", "ddqn_rtg", 1, "train.batch=8")
    assert names(collect(runs)) == [f"gathering/ddqn_rtg/seed-{seed}" for seed in (1, 2)]
    found = names(collect([*runs, other]))
    assert found == [
        "gathering/ddqn_rtg@train.batch=128/seed-1",
        "gathering/ddqn_rtg@train.batch=128/seed-2",
        "gathering/ddqn_rtg@train.batch=8/seed-1",
    ]


def given(run, name, sha256, *, transitions=600):
    """Makes a run one of own data."""
    data = {"format": "npz", "name": name, "sha256": sha256}
    found = read_json(run / "versions.json")
    write_json(run / "versions.json", {**found, "generator": {"data": data}})
    data = {**data, "transitions": transitions, "successes": 9}
    summary = read_json(run / "summary.json")
    write_json(run / "summary.json", {**summary, "data": data})
    return run


def test_runs_of_own_data_are_named_by_it(tmp_path):
    own = given(single(tmp_path / "own"), "my data.npz", 64 * "a")
    found = single(tmp_path / "found", "ddqn_rtg", 1, "search.transitions=7")
    page = write_joint_report([own, found], tmp_path / "out").read_text()
    assert table_row(page, "ddqn_rtg@data=my-data.npz")[0] == "1"
    assert table_row(page, "ddqn_rtg")[0] == "1"
    assert (
        "- data of `ddqn_rtg@data=my-data.npz`: 600 transitions of my data.npz (SHA-256 "
        "aaaaaaaaaaaa…), 9 of which succeed" in page
    )


@pytest.mark.parametrize("name", ["mine.npz", None])
def test_data_sets_of_one_name_are_told_apart(name, tmp_path):
    runs = [given(single(tmp_path / one), name, 64 * one) for one in "ab"]
    assert names(collect(runs)) == [
        f"gathering/ddqn_rtg@data={name or 'arrays'}@data.sha256={12 * one}/seed-1" for one in "ab"
    ]


def test_a_run_that_only_generated_is_no_unfinished_one(tmp_path):
    alone = single(tmp_path / "alone")
    summary = read_json(alone / "summary.json")
    write_json(alone / "summary.json", {**summary, "interactions": None, "success_rate": None})
    page = write_joint_report([alone], tmp_path / "out").read_text()
    assert table_row(page, "ddqn_rtg")[:2] == ["1 generation only", "–"]
    (alone / "training_state.json").write_text("{}")  # it goes on with --resume
    page = write_joint_report([alone], tmp_path / "out").read_text()
    assert table_row(page, "ddqn_rtg")[0] == "1 unfinished"


def test_the_rows_of_one_comparison_are_left_as_they_are(tmp_path):
    swept = Cell("gathering", "ddqn_rtg", ("train.batch=8",), 1)
    one = comparison(tmp_path / "one", swept, naive(3), failed={naive(4).name: "no memory"})
    write_grid(one, [swept, naive(3), naive(4)], {naive(4).name: "no memory"})
    found = collect([one, single(tmp_path / "alone", "ddqn")])
    states = {run.cell.name: run.state for run in found.comparison.results}
    assert states == {
        swept.name: "done",
        naive(3).name: "done",
        naive(4).name: "failed",
        "gathering/ddqn/seed-1": "done",
    }
    assert found.grid.failure_by_name == {naive(4).name: "no memory"}


def test_the_same_folder_counts_once(tmp_path):
    one = single(tmp_path / "one")
    assert len(collect([one, one]).comparison.results) == 1


def test_two_runs_of_the_same_kind_are_refused(tmp_path):
    one, other = single(tmp_path / "one"), single(tmp_path / "other")
    with pytest.raises(UserError) as told:
        collect([one, other])
    assert str(told.value) == (
        f"{other}: is gathering/ddqn_rtg/seed-1 with the same settings as {one}; legal: runs that "
        "differ in task, method, settings or seed"
    )


@pytest.mark.parametrize(
    ("method", "setting", "words"),
    [
        ("her", "train.interactions=20000", r"train\.interactions = 15000, .*other is 20000"),
        ("her", "task.horizon=30", r"task\.horizon = 60, .*other is 30"),
    ],
)
def test_methods_that_cannot_be_compared_are_refused(method, setting, words, tmp_path):
    one, other = single(tmp_path / "one"), single(tmp_path / "other", method, 1, setting)
    with pytest.raises(UserError, match=rf"^{one}: was made with {words}; legal: the same, or"):
        collect([one, other])


def test_runs_of_two_tasks_of_one_name_are_refused(tmp_path):
    one = single(tmp_path / "one")
    other = single(tmp_path / "other", "ddqn_rtg", 2, "task.goal.0.disc.radius=2.5")
    with pytest.raises(UserError, match=r"differs from another run of gathering, ddqn_rtg in task"):
        collect([one, other])
