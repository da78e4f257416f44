"""The flags of `reproduce`: which runs they stand for, and what is said about mistakes."""

import pytest
from rtg import _core, paths
from rtg.compare import reproduce_args
from rtg.compare.cells import Cell
from rtg.compare.methods import METHODS, REFERENCE
from rtg.compare.reproduce_args import parse, parse_seeds, parse_sweep
from rtg.errors import UserError


def test_without_flags_all_methods_run_on_all_tasks_with_five_seeds_but_the_planner():
    args = parse([])
    assert len(args.cells) == 3 * (5 * (len(METHODS) - 1) + 1)
    assert [cell.seed for cell in args.cells if cell.method == "planner"] == [1, 1, 1]
    assert list(args.files) == ["gathering", "sorting", "art_manip"]
    assert {cell.seed for cell in args.cells} == {1, 2, 3, 4, 5}
    assert args.out == paths.RUNS / "reproduce"
    assert args.settings == ()


def test_the_methods_are_those_of_the_loader():
    with pytest.raises(_core.ConfigError) as told:
        _core.Config.from_file(paths.CONFIG / "gathering.yaml", ["run.method=none"])
    assert str(told.value).endswith("legal: " + ", ".join(METHODS))
    assert REFERENCE in METHODS


def test_quick_is_small_and_what_the_user_sets_stands_above_it():
    args = parse(["--quick", "--set", "train.interactions=7"])
    assert len(args.cells) == 6 and args.out.name == "reproduce-quick"
    assert args.settings == (*reproduce_args.QUICK_SETTINGS, "train.interactions=7")


def test_a_sweep_is_one_more_axis_of_the_reference_method():
    sweeps = ["--sweep", "train.batch=8,16", "--sweep", "train.network=plain"]
    args = parse(["gathering", "--seeds", "4,2", *sweeps])
    settings = [("train.batch=8", "train.network=plain"), ("train.batch=16", "train.network=plain")]
    cells = [Cell("gathering", REFERENCE, s, seed) for s in settings for seed in (4, 2)]
    assert list(args.cells) == cells
    assert cells[0].name == f"gathering/{REFERENCE}@train.batch=8@train.network=plain/seed-4"


def test_ablations_are_runs_as_they_are_with_each_departure_taken_back_and_as_the_paper():
    args = parse(["sorting", "--ablations", "--seeds", "1", "--set", "train.interactions=9"])
    settings = [cell.settings for cell in args.cells]
    assert {cell.method for cell in args.cells} == {REFERENCE}
    assert settings[0] == () and settings[-1][0] == "train.preset=paper"
    assert ("search.branches=0",) in settings
    assert ("train.batch=512",) in settings and ("train.network=plain",) in settings
    assert ("train.target_sync=250", "train.target_rate=1.0") in settings
    assert not any("eval_every" in word for words in settings[:-1] for word in words)
    assert args.command == (
        "./run.sh reproduce sorting --methods ddqn_rtg --seeds 1 --ablations "
        "--set train.interactions=9"
    )
    assert parse(args.command.split()[2:]).cells == args.cells


def test_the_command_of_the_report_has_all_that_decides_the_results_and_no_more():
    words = (
        "gathering --out /tmp/x --jobs 3 --seeds 2 --set train.batch=9 "
        "--sweep train.network=headings"
    )
    args = parse(words.split())
    assert args.command == (
        "./run.sh reproduce gathering --methods ddqn_rtg --seeds 2 --sweep train.network=headings "
        "--set train.batch=9"
    )
    assert args.command_line == f"./run.sh reproduce {words}"
    assert parse(args.command.split()[2:]).cells == args.cells


@pytest.mark.parametrize(
    ("words", "seeds"), [("3", (1, 2, 3)), ("1,2,7", (1, 2, 7)), ("7,", (7,)), ("2,2,0", (2, 0))]
)
def test_seeds_are_a_number_of_them_or_a_list(words, seeds):
    assert parse_seeds(words) == seeds


def test_where_the_runs_are_carried_out_is_no_part_of_the_command_of_the_report():
    options = ["mem_gb=0.5", "slurm_partition=cpu", "slurm_additional_parameters={}"]
    words = [word for option in options for word in ("--executor-option", option)]
    args = parse(["gathering", "--executor", "submitit", *words])
    assert args.executor == "submitit" and args.jobs == reproduce_args.MAX_JOBS
    found = {"mem_gb": 0.5, "slurm_partition": "cpu", "slurm_additional_parameters": {}}
    assert args.executor_options == found
    assert args.command == parse(["gathering"]).command


def test_the_values_of_a_sweep_may_be_negative():
    assert parse_sweep("train.offline_share=0.5,-1") == (
        "train.offline_share=0.5",
        "train.offline_share=-1",
    )


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ["--set", "run.seed=3"],
            "--set run.seed=3: reproduce sets this key itself; legal: --seeds",
        ),
        (
            ["gatherin"],
            "gatherin: no task of that name (did you mean 'gathering'?); legal: art_manip, ",
        ),
        (["gathering", "--methods", "magic"], "--methods magic: no method of that name; legal: "),
        (["--methods", ""], "--methods : no method of that name; legal: "),
        (
            ["--seeds", "0"],
            "--seeds 0: not a legal number; legal: a number from 1 to 1000, or a list 1,2,3",
        ),
        (
            ["--seeds", "1001"],
            "--seeds 1001: not a legal number; legal: a number from 1 to 1000, or a list 1,2,3",
        ),
        (
            ["--seeds", ""],
            "--seeds '': not a legal number; legal: a number from 1 to 1000, or a list 1,2,3",
        ),
        (["--seeds", "1,x"], "--seeds x: not a legal number; legal: a list 1,2,3"),
        (["--seeds", ","], "--seeds '': not a legal number; legal: a list 1,2,3"),
        (["--jobs", "0"], "--jobs 0: not a legal number; legal: a number from 1 to 1000"),
        (["--jobs", ""], "--jobs '': not a legal number; legal: a number from 1 to 1000"),
        (
            ["--sweep", "train.batch=8", "--sweep", "train.batch=9"],
            "--sweep train.batch: is given twice; legal: once, train.batch=V1,V2",
        ),
        (
            ["--executor", "moon"],
            "argument --executor: invalid choice: 'moon' (choose from ",
        ),
        (
            ["--executor-option", "cluster=local"],
            "--executor-option cluster=local: is none of --executor local; legal: KEY=VALUE of",
        ),
        (
            ["--executor", "ray", "--executor-option", "num_cpus"],
            "--executor-option num_cpus: is none of --executor ray; legal: KEY=VALUE of",
        ),
        (["--jobs", "-1"], "--jobs -1: not a legal number; legal: a number from 1 to 1000"),
        (["--out", ""], "--out: the path is empty; legal: the path of a folder"),
        (["--sweep", "train.batch"], "--sweep train.batch: not a legal axis; legal: KEY=V1,V2, "),
        (
            ["--sweep", "train.batch=1,"],
            "--sweep train.batch=1,: not a legal axis; legal: KEY=V1,V2, ",
        ),
        (
            ["--sweep", "train.batch=1,a/b"],
            "--sweep train.batch=1,a/b: not a legal axis; legal: KEY=V1,V2, ",
        ),
        (
            ["--ablations", "--sweep", "train.batch=1,2"],
            "--ablations: cannot be combined with --sweep; legal: one",
        ),
        (["--sweep", "run.seed=1,2"], "--sweep run.seed=1,2: run.seed cannot be swept; legal: "),
        (["--in-process"], "unrecognized arguments: --in-process; legal: ./run.sh reproduce [-h]"),
    ],
)
def test_a_mistake_is_named(words, message):
    with pytest.raises(UserError) as error:
        parse(words)
    assert str(error.value).startswith(message)


def test_two_tasks_need_two_names(tmp_path):
    (tmp_path / "gathering.yaml").write_text("")
    with pytest.raises(
        UserError, match="gathering is named twice; legal: tasks with different file names"
    ):
        parse(["gathering", str(tmp_path / "gathering.yaml")])
