"""A run of a comparison and what is there of it already."""

import re

import pytest
from rtg.compare.cell_run import prepare_runs
from rtg.compare.reproduce_args import parse
from rtg.errors import UserError
from rtg.files.run_folder import write_json
from rtg.run import effective_config, run_args
from training_runs import TINY


@pytest.fixture
def words(tmp_path):
    """Lists the arguments of a comparison with two runs."""
    return [
        str(TINY),
        "--methods",
        "ddqn_naive,ddqn_rtg",
        "--seeds",
        "1",
        "--out",
        str(tmp_path),
        "--set",
        "train.batch=8",
    ]


def begin(run, *overrides):
    """Begins the run as `rtg run` does."""
    run.folder.mkdir(parents=True)
    args = run_args.parse([*run.arguments, *overrides, "--out", str(run.folder)])
    text = effective_config.load(args.file, args.overrides).yaml
    (run.folder / "config.yaml").write_text(text)


def test_a_new_run_begins_and_one_that_has_begun_goes_on(words):
    naive, rtg = prepare_runs(parse(words))
    assert not naive.begun
    command = naive.command()
    assert command[-3:] == ["--resume", "--out", str(naive.folder)]
    assert naive.begun and not rtg.begun
    config = (naive.folder / "config.yaml").read_bytes()
    again, _ = prepare_runs(parse(words))
    assert again.command() == command and (naive.folder / "config.yaml").read_bytes() == config
    assert not naive.done and not rtg.done
    write_json(naive.folder / "summary.json", {"interactions": None})  # of --no-train
    assert not naive.done
    write_json(naive.folder / "summary.json", {"interactions": 400, "success_rate": 0.5})
    assert naive.done
    write_json(naive.folder / "summary.json", {"interactions": 400})
    with pytest.raises(UserError, match=r"summary\.json: has no success_rate; legal: the file as"):
        prepare_runs(parse(words))[0].outcome()


def test_a_run_that_does_not_fit_one_begun_meanwhile_is_refused(words):
    """Both commands found the folder empty."""
    one, _ = prepare_runs(parse(words))
    _, other = prepare_runs(parse([*words, "--set", "train.interactions=9"]))
    one.begin()
    with pytest.raises(UserError, match=r"was made with train\.interactions = \d+, asked for is 9"):
        other.begin()
    assert not other.begun


def test_a_run_keeps_to_one_thread(words):
    command = prepare_runs(parse(words))[0].command()
    assert {"OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1", "MKL_NUM_THREADS=1"} <= set(command)


def test_methods_stand_above_the_file_and_the_settings(words):
    """The file says naive."""
    for run, generator in zip(prepare_runs(parse(words)), ("naive", "rrbs"), strict=True):
        args = run_args.parse(run.arguments)
        config = effective_config.load(args.file, args.overrides)
        assert config.search.generator == generator
        assert config.run.workers == 1 and config.run.in_process
        assert config.train.batch == 8


@pytest.mark.parametrize(
    ("more", "what"),
    [
        (["--set", "train.batch=9"], "train.batch = 8, asked for is 9"),
        (["--set", "search.breadth=9"], "search.breadth = 100, asked for is 9"),
    ],
)
def test_a_run_with_another_configuration_is_refused_and_left_alone(words, more, what):
    run = prepare_runs(parse(words))[0]
    begin(run)
    before = (run.folder / "config.yaml").read_bytes()
    with pytest.raises(UserError) as error:
        prepare_runs(parse([*words, *more]))
    assert str(error.value).startswith(f"{run.folder}: was made with {what}; legal: the same, ")
    assert (run.folder / "config.yaml").read_bytes() == before


def test_a_run_of_a_version_without_one_of_the_settings_is_refused(words):
    """Its value was another then, perhaps."""
    run = prepare_runs(parse(words))[0]
    begin(run)
    file = run.folder / "config.yaml"
    file.write_text(re.sub(r"\n  stop_evaluations: .*", "", file.read_text()))
    with pytest.raises(UserError) as error:
        prepare_runs(parse(words))
    assert str(error.value).startswith(
        f"{file}: has no line 'stop_evaluations: 3': another version of RTG wrote it; legal: "
    )


def test_what_no_run_can_do_is_refused_before_anything_starts(words, tmp_path):
    with pytest.raises(UserError, match=r"key 'train\.buffer': 100 is too small for search\.tr"):
        prepare_runs(parse([*words, "--set", "train.buffer=100"]))
    assert list(tmp_path.iterdir()) == []


def test_seeds_with_another_configuration_are_refused_though_not_asked_for(words):
    begin(prepare_runs(parse(words))[0])
    other = [word if word != "1" else "2," for word in words]
    assert len(prepare_runs(parse(other))) == 2
    with pytest.raises(UserError, match=r"seed-1: was made with train\.batch = 8, asked for"):
        prepare_runs(parse([*other, "--set", "train.batch=9"]))


def test_a_run_killed_as_it_began_begins_again(words):
    run = prepare_runs(parse(words))[0]
    run.folder.mkdir(parents=True)
    (run.folder / ".config.yaml.123").write_text("ta")
    again = prepare_runs(parse(words))[0]
    again.begin()
    assert again.begun and not (run.folder / ".config.yaml.123").exists()


def test_a_run_that_has_begun_takes_transitions_over_too(words, monkeypatch):
    """It was killed between the one and the other."""
    found = []
    monkeypatch.setattr("rtg.run.shared_transitions.find", lambda *place: found.append(place))
    run = prepare_runs(parse(words))[0]
    begin(run)
    assert "--resume" in run.command()
    assert found == [(run.generation_key, run.folder.parents[1], "seed-1")]


def test_a_file_where_a_run_belongs_is_refused(words):
    run = prepare_runs(parse(words))[0]
    run.folder.parent.mkdir(parents=True)
    run.folder.write_text("mine")
    with pytest.raises(
        UserError, match="neither empty nor the folder of a run; legal: a new or an empty --out"
    ):
        prepare_runs(parse(words))


@pytest.mark.parametrize(
    ("more", "what"),
    [
        ("train.interactions=9", r"train\.interactions = \d+, asked for is 9"),
        ("task.horizon=9", r"task\.horizon = \d+, asked for is 9"),
        ("physics.damping=0.3", r"physics\.damping = [\d.]+, asked for is 0\.3"),
        ("train.eval_every=9", r"train\.eval_every = \d+, asked for is 9"),
        ("search.transitions=9999", r"search\.transitions = \d+, asked for is 9999"),
        ("train.preset=paper", r"train\.eval_every = \d+, asked for is 10000"),
    ],
)
def test_methods_that_cannot_be_compared_are_refused(words, more, what):
    naive, rtg = prepare_runs(parse(words))
    begin(naive)
    alone = [word.replace("ddqn_naive,", "") for word in words]
    prepare_runs(parse([*alone, "--set", "train.learning_rate=0.5"]))
    for run in prepare_runs(parse([*alone, "--sweep", more])):
        begin(run)
    prepare_runs(parse([*alone, "--set", "train.learning_rate=0.5"]))
    with pytest.raises(UserError, match=f"ddqn_naive/seed-1: was made with {what}; legal: "):
        prepare_runs(parse([*alone, "--set", more]))
    with pytest.raises(UserError, match=f"ddqn_naive/seed-1: was made with {what}; legal: "):
        prepare_runs(parse([*alone, "--sweep", "train.network=plain", "--set", more]))
    assert not rtg.begun


def test_runs_without_data_may_stand_beside_any_number_of_transitions(words):
    without, _ = prepare_runs(parse([word.replace("ddqn_naive", "dqn") for word in words]))
    begin(without)
    alone = [word.replace("ddqn_naive,", "") for word in words]
    prepare_runs(parse([*alone, "--set", "search.transitions=9999"]))


@pytest.mark.parametrize(
    "sweep", ["task.push.stride=1.5,2.0", "task.goal.0.disc.radius=2.0,2.5", "task.horizon=30,60"]
)
def test_a_sweep_of_the_task_goes_on(words, sweep):
    alone = [word.replace("ddqn_naive,", "") for word in words]
    for run in prepare_runs(parse([*alone, "--sweep", sweep])):
        begin(run)
    runs = prepare_runs(parse([*alone, "--sweep", sweep]))
    assert len(runs) == 2 and all(run.begun for run in runs)


def test_a_folder_of_another_kind_is_refused(words):
    run = prepare_runs(parse(words))[0]
    run.folder.mkdir(parents=True)
    (run.folder / "notes.txt").write_text("mine")
    with pytest.raises(
        UserError, match="neither empty nor the folder of a run; legal: a new or an empty --out"
    ):
        prepare_runs(parse(words))


def test_wrong_values_are_named_by_the_flag_that_they_came_with(words):
    for flag, setting in (("--set", "train.batch=0"), ("--sweep", "train.offline_share=0.5,3")):
        key, value = setting.split("=")
        with pytest.raises(UserError) as error:
            prepare_runs(parse([*words, flag, setting]))
        assert str(error.value).startswith(f"{flag} {key}={value.split(',')[-1]}: ")


def test_values_that_make_the_same_run_are_refused(words):
    with pytest.raises(
        UserError, match=r"=0\.50/seed-1: has the same settings as .*=0\.5/seed-1; legal"
    ):
        prepare_runs(parse([*words, "--sweep", "train.offline_share=0.5,0.50"]))
