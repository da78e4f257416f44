"""When a run goes on, nothing may change that decides its transitions or its checkpoint."""

import re

import pytest
from rtg import cli, paths
from rtg.errors import UserError
from rtg.files import locks
from rtg.learn import settings
from rtg.run import effective_config
from rtg.run.plan import make_plan
from rtg.run.run_args import Override, parse

TINY = paths.CONFIG / "tests" / "tiny.yaml"
CHANGES = {
    "seed": (["--seed", "9"], "--resume: run.seed must stay 1 as in "),
    "search": (["--set", "search.breadth=9"], "--resume: search.breadth must stay 16 as in "),
    "generator": (["--generator", "rrbs"], "--resume: search.generator must stay naive as in "),
    "transitions": (["--transitions", "9"], "--resume: search.transitions must stay 2000 as in "),
    "physics": (["--set", "physics.sub_steps=9"], "--resume: physics.sub_steps must stay 10 as "),
    "forward": (["--set", "forward.engine=newton"], "--resume: forward.engine must stay box2d as "),
    "reverse": (["--set", "reverse.preset=paper"], "--resume: reverse."),
    "method": (["--method", "ddqn_random"], "--resume: search."),
    "task setting": (["--set", "task.horizon=9"], "--resume: task.horizon must stay 60 as in "),
    "task": (
        ["--set", "task=gathering_hard"],
        "--set task=gathering_hard: key 'task': 'gathering_hard' is not a mapping",
    ),
    "one of two": (["--workers", "1", "--seed", "9"], "--resume: run.seed must stay 1 as in "),
    "named task": (["gathering"], "gathering: --resume goes on with the task of "),
}


@pytest.fixture
def folder(tmp_path):
    """Makes the folder that of a stopped run."""
    (tmp_path / "config.yaml").write_text(effective_config.load(TINY).yaml)
    (tmp_path / ".lock").touch()
    return tmp_path


@pytest.mark.parametrize("name", CHANGES)
def test_a_change_of_the_transitions_is_refused_and_leaves_the_run_alone(name, folder, capsys):
    words, message = CHANGES[name]
    before = (folder / "config.yaml").read_bytes()
    assert cli.main([*words, "--resume", "--out", str(folder)]) == 2
    assert capsys.readouterr().err.startswith(f"rtg: {message}")
    assert sorted(path.name for path in folder.iterdir()) == [".lock", "config.yaml"]
    assert (folder / "config.yaml").read_bytes() == before


def test_a_run_at_work_is_refused_and_left_alone(folder, capsys):
    before = (folder / "config.yaml").read_bytes()
    with locks.exclusive_lock(folder, "nobody"):
        assert cli.main(["--resume", "--out", str(folder), "--interactions", "9"]) == 2
    assert (
        capsys.readouterr().err
        == f"rtg: --out: {folder}: another run uses this folder; legal: another folder, or wait\n"
    )
    assert (folder / "config.yaml").read_bytes() == before


def test_a_run_of_another_version_is_refused_and_left_alone(folder, capsys):
    """Its default of a setting that is not in the file was another one, perhaps."""
    file = folder / "config.yaml"
    file.write_text(re.sub(r"\n  breadth: .*", "", file.read_text()))
    before = file.read_bytes()
    assert cli.main(["--resume", "--out", str(folder)]) == 2
    assert capsys.readouterr().err.startswith(f"rtg: {file}: has no line 'breadth: 10'")
    assert file.read_bytes() == before


CHECKPOINT_SETTINGS = {
    "learner": "cloning",
    "interact": "False",
    "offline": "False",
    "hindsight": "4",
    "curriculum": "0.5",
    "network": "plain",
    "symmetry": "False",
    "train_frequency": "8",
    "buffer": "9999",
    "discount": "0.5",
}


@pytest.mark.parametrize("name", CHECKPOINT_SETTINGS)
@pytest.mark.parametrize("more", [[], ["--no-train"]])
def test_what_a_checkpoint_is_bound_to_is_refused_and_leaves_the_run_alone(
    name, more, folder, capsys
):
    if name == "learner":  # to clone needs that
        alone = [Override("", "train.interact=false")]
        (folder / "config.yaml").write_text(effective_config.load(TINY, alone).yaml)
    (folder / "checkpoint").mkdir()
    (folder / "checkpoint" / "state.pt").write_bytes(b"of a learner")
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    words = ["--set", f"train.{name}={CHECKPOINT_SETTINGS[name].lower()}", *more]
    assert cli.main([*words, "--resume", "--out", str(folder)]) == 2
    words = capsys.readouterr().err
    assert words.startswith(f"rtg: --resume: train.{name} must stay ")
    assert "must stay True" not in words
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == before


def test_without_a_checkpoint_the_learner_may_become_another(folder):
    words = ["--set", "train.preset=paper", "--resume", "--in-process", "--out", str(folder)]
    assert make_plan(parse(words)).config.train.network == "plain"


def test_the_settings_a_checkpoint_is_bound_to_are_those_of_the_test():
    assert set(settings.CHECKPOINT_SETTINGS) == set(CHECKPOINT_SETTINGS)


def test_the_learner_and_the_processes_may_change_and_equal_values_are_no_change(folder):
    words = "--resume --in-process --workers 1 --interactions 900 --seed 1 --set search.breadth=16"
    plan = make_plan(parse([*words.split(), "--out", str(folder)]))
    assert plan.resume and plan.interactions == 900
    written = effective_config.load(folder / "config.yaml")
    assert written.json == plan.config.json
    assert written.run.workers == 1 and written.train.interactions == 900


def test_messages_to_record_need_a_process_graph(folder, capsys):
    words = ["--resume", "--in-process", "--set", "run.record=true", "--out", str(folder)]
    assert cli.main(words) == 2
    assert capsys.readouterr().err.startswith(
        "rtg: --set run.record=true: key 'run.record': is true, but with run.in_process "
    )


def test_a_run_that_goes_on_without_lcm_says_what_it_leaves_out_and_can_be_resumed(
    folder, monkeypatch
):
    monkeypatch.setattr("rtg.run.plan.defect", lambda url: "multicast: no such device")
    words = ["--resume", "--set", "run.record=true", "--out", str(folder)]
    plan = make_plan(parse(words))
    assert plan.in_process and "lcm.log is not recorded: there are no messages" in plan.notes
    assert make_plan(parse(["--resume", "--out", str(folder)])).in_process


def test_a_recorded_run_may_have_settings_that_are_gone(folder):
    file = folder / "config.yaml"
    lines = file.read_text().splitlines()
    lines.insert(lines.index("reverse:") + 1, "  softenings: 2  # of an earlier version")
    file.write_text("\n".join(lines))
    with pytest.raises(UserError, match="softenings"):
        effective_config.load(file)
    assert effective_config.load_recorded(file).yaml == effective_config.load(TINY).yaml


def test_a_recorded_run_must_be_legal_otherwise(folder):
    file = folder / "config.yaml"
    file.write_text(file.read_text().replace("  breadth: 16", "  breadth: many"))
    with pytest.raises(UserError, match="breadth"):
        effective_config.load_recorded(file)
