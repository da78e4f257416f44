"""The flags of ./run.sh: what they set, and what is said about mistakes."""

import pytest
from rtg import paths
from rtg.errors import UserError
from rtg.run.run_args import parse


def test_no_flag_means_the_whole_job_on_gathering():
    args = parse([])
    assert args.file == paths.CONFIG / "gathering.yaml"
    assert args.overrides == () and args.out is None
    assert args.train and not args.resume and not args.print_config


def test_flags_become_overrides_after_those_of_set():
    words = "gathering --workers 3 --seed 7 --generator naive --in-process --transitions 100"
    more = "--interactions 200 --set search.breadth=8"
    args = parse([*words.split(), *more.split()])
    assert {override.typed: override.setting for override in args.overrides} == {
        "--set search.breadth=8": "search.breadth=8",
        "--workers 3": "run.workers=3",
        "--generator naive": "search.generator=naive",
        "--transitions 100": "search.transitions=100",
        "--interactions 200": "train.interactions=200",
        "--seed 7": "run.seed=7",
        "--in-process": "run.in_process=true",
    }
    assert args.overrides[0].setting == "search.breadth=8"


def test_a_path_is_a_task_file(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("")
    assert parse([str(file), "--no-train"]).file == file


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ["sortign"],
            "sortign: no task of that name (did you mean 'sorting'?); legal: art_manip, ",
        ),
        (["reprodcue", "gathering"], "reprodcue: no task of that name; legal: art_manip, "),
        ([""], "'': no such task file; legal: art_manip, art_manip_hard, cable, "),
        (["nowhere/mine.yaml"], "nowhere/mine.yaml: no such task file; legal: art_manip, "),
        (["config"], "config: no such task file; legal: art_manip, art_manip_hard, cable, "),
        (["--worker", "3"], "unrecognized arguments: --worker; legal: ./run.sh [-h] "),
        (["gathering", "more"], "unrecognized arguments: more; legal: "),
        (["--seed"], "argument --seed: expected one argument; legal: "),
        (["--resume"], "--resume: --out is missing; legal: "),
        (["--out", ""], "--out: the path is empty; legal: the path of a folder"),
    ],
)
def test_a_mistake_is_named(words, message, monkeypatch):
    monkeypatch.chdir(paths.ROOT)
    with pytest.raises(UserError) as error:
        parse(words)
    assert str(error.value).startswith(message)


def test_what_a_task_may_be_is_named_in_full(monkeypatch):
    monkeypatch.setattr(paths, "task_names", lambda: ["gathering", "other"])
    with pytest.raises(UserError) as error:
        parse(["mine.yaml"])
    legal = "legal: gathering, other, the path of a FILE.yaml, a tool (--help)"
    assert str(error.value) == f"mine.yaml: no such task file; {legal}"


def test_a_run_folder_with_something_in_it_is_not_overwritten(tmp_path):
    assert parse(["--out", str(tmp_path)]).out == tmp_path
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(
        UserError, match="is not empty; legal: a new or an empty folder, or --resume"
    ):
        parse(["--out", str(tmp_path)])
    with pytest.raises(UserError, match=r"notes\.txt is not a folder"):
        parse(["--out", str(tmp_path / "notes.txt")])
    with pytest.raises(UserError, match=r"has no config\.yaml; legal: the folder of a run"):
        parse(["--out", str(tmp_path), "--resume"])


def test_a_run_is_resumed_with_its_own_configuration(tmp_path):
    (tmp_path / "config.yaml").write_text("")
    args = parse(["--out", str(tmp_path), "--resume"])
    assert args.file == tmp_path / "config.yaml" and args.resume
