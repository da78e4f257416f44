"""The methods: what each stands for, and that each learns, stops and goes on."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from rtg import _core, cli
from rtg.compare.methods import METHODS
from rtg.errors import UserError
from rtg.files import checkpoint
from rtg.files.dataset import Rows
from rtg.learn import device, policy_file, trainer
from rtg.learn.offline_data import NoSource
from rtg.run import effective_config
from rtg.run.run_args import Override
from training_runs import TINY, after_polls, flat, run_folder, training

WITHOUT_DATA = ("dqn", "ddqn", "her", "rcg", "planner")
WITHOUT_INTERACTION = ("cql_rtg", "bc_rtg", "planner")


def values(method: str, *more: str) -> dict:
    return json.loads(_core.Config.from_file(TINY, [f"run.method={method}", *more]).json)


def test_methods_differ_in_these_values_alone() -> None:
    of = {name: values(name) for name in METHODS}
    train, rtg = {name: of[name]["train"] for name in METHODS}, of["ddqn_rtg"]["train"]
    explores = {"epsilon_start": 1.0, "epsilon_end": 0.05, "nearby_share": 0.0}
    unguided = {**rtg, **explores, "contact_share": 0.5}
    alone = {**rtg, "interact": False}
    vanilla = {**unguided, "offline": False}
    assert train == {
        "dqn": {**vanilla, "double_q": False},
        "ddqn": vanilla,
        "ddqn_random": {**unguided, "offline_share": -1.0},
        "ddqn_scatter": {**unguided, "offline_share": 0.25},
        "ddqn_naive": rtg,
        "ddqn_forward": rtg,
        "ddqn_rtg": rtg,
        "ddqn_rtg_dr": {**rtg, "randomise": True},
        "her": {**vanilla, "hindsight": 4, "symmetry": False, "learning_rate": 1e-4},
        "rcg": {**vanilla, "curriculum": 0.9, "learning_rate": 1e-4, "epsilon_start": 0.3},
        "cql_rtg": {**alone, "cql_weight": 1.0},
        "bc_rtg": {**alone, "learner": "cloning", "learning_rate": 1e-4},
        "planner": {**alone, "learner": "planning", "offline": False},
    }
    assert (rtg["epsilon_end"], rtg["epsilon_share"]) == (0.02, 0.2)
    generators = {
        name: of[name]["search"]["generator"] for name in METHODS if name not in WITHOUT_DATA
    }
    assert generators == {
        "ddqn_random": "random",
        "ddqn_scatter": "scatter",
        "ddqn_naive": "naive",
        "ddqn_forward": "forward",
        "ddqn_rtg": "rrbs",
        "ddqn_rtg_dr": "rrbs",
        "cql_rtg": "rrbs",
        "bc_rtg": "rrbs",
    }
    randomised = [name for name in METHODS if of[name]["search"]["randomise"]]
    assert randomised == ["ddqn_rtg_dr"]


def test_the_preset_paper_differs_in_these_values_alone() -> None:
    default, paper = values("ddqn_rtg"), values("ddqn_rtg", "train.preset=paper")
    table_2 = {"batch": 512, "learning_rate": 5e-5, "target_sync": 250, "target_rate": 1.0}
    exploration = {"epsilon_start": 1.0, "epsilon_end": 0.05, "epsilon_share": 0.1}
    uniform = {"offline_share": -1.0, "recent_share": 0.0, "nearby_share": 0.0}
    of_default = "target_acts clipped_double_q clip_targets value_bounds leave_loops symmetry"
    without = {**dict.fromkeys(of_default.split(), False), "averaging_rate": 1.0, "discount": 0.0}
    without["network"] = "plain"
    course = {"start_jitter": 0.0, "eval_every": 10000, "stop_at_success": 0.0}
    changed = {**table_2, **exploration, **uniform, **without, **course, "preset": "paper"}
    default["train"] |= changed
    assert paper == default


def test_settings_stand_above_the_method_and_it_above_presets_and_the_file() -> None:
    assert values("her", "train.hindsight=2")["train"]["hindsight"] == 2
    paper = values("ddqn_random", "train.preset=paper")
    assert paper["search"]["generator"] == "random" and paper["train"]["network"] == "plain"
    without = json.loads(_core.Config.from_file(TINY).json)
    assert (without["run"]["method"], without["search"]["generator"]) == ("ddqn_rtg", "naive")


def test_another_id_is_refused_and_the_legal_ones_are_named(capsys) -> None:
    assert cli.main(["gathering", "--method", "sac"]) == 2
    legal = ", ".join(METHODS)
    wrong = "'sac' is not one of the legal values"
    words = f"rtg: --method sac: key 'run.method': {wrong}; legal: {legal}\n"
    assert capsys.readouterr().err == words


REFUSED = {
    "nothing to do": (
        ["--method", "her", "--no-train"],
        "rtg: --no-train: leaves nothing to do, as run.method her generates no transitions ",
    ),
    "a generator of nothing": (
        ["--method", "her", "--generator", "random"],
        "rtg: --generator random: has no effect, as run.method her generates no transitions ",
    ),
    "transitions of nothing": (
        ["--method", "dqn", "--transitions", "100"],
        "rtg: --transitions 100: has no effect, as run.method dqn generates no transitions ",
    ),
    "no messages": (
        ["--method", "rcg", "--set", "run.record=true"],
        "rtg: --set run.record=true: key 'run.record': is true, but without train.offline there "
        "are no messages to record; legal: false",
    ),
    "no range": (
        ["--method", "ddqn_rtg_dr", "--set", "task.randomisation=0"],
        "rtg: --method ddqn_rtg_dr: run.method ddqn_rtg_dr: key 'task.randomisation': is 0, but "
        "train.randomise is true; legal: more than 0",
    ),
    "a planner with data": (
        ["--method", "planner", "--set", "train.offline=true"],
        "rtg: --set train.offline=true: key 'train.learner': planning neither "
        "interacts nor learns from transitions; legal: planning with train.interact false and "
        "train.offline false",
    ),
    "nothing to learn from": (
        ["--method", "cql_rtg", "--set", "train.offline=false"],
        "rtg: --set train.offline=false: key 'train.interact': train.interact "
        "and train.offline are both false, which leaves nothing to learn from; legal: one of the "
        "two true, or train.learner planning",
    ),
    "steps that lead nowhere": (
        ["--method", "bc_rtg", "--set", "search.generator=scatter"],
        "rtg: --set search.generator=scatter: key 'train.learner': cloning "
        "only imitates generated steps that lead to success; legal: cloning with train.interact "
        "false and search.generator one of rrbs, naive\n",
    ),
    "steps into dead ends": (
        ["--method", "bc_rtg", "--set", "search.generator=forward"],
        "rtg: --set search.generator=forward: key 'train.learner': cloning only imitates ",
    ),
    "a clone that interacts": (
        ["--method", "bc_rtg", "--set", "train.interact=true"],
        "rtg: --set train.interact=true: key 'train.learner': cloning only imitates ",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_does_not_go_together_is_refused(name, tmp_path: Path, capsys) -> None:
    words, message = REFUSED[name]
    assert cli.main(["gathering", *words, "--out", str(tmp_path / "run")]) == 2
    assert capsys.readouterr().err.startswith(message)
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize("method", METHODS)
def test_each_method_runs_from_the_flag_to_the_summary(method: str, tmp_path: Path) -> None:
    out = tmp_path / "run"
    more = ["--set", "train.buffer=4000", "--set", "train.hindsight=2"] if method == "her" else []
    small = [
        "--set",
        "search.transitions=800",
        "--set",
        "search.breadth=4",
        "--set",
        "search.depth=3",
    ]
    words = [str(TINY), "--method", method, "--in-process", "--out", str(out), *small, *more]
    assert cli.main(words) == 0
    summary = json.loads((out / "summary.json").read_text())
    interactions = 0 if method in WITHOUT_INTERACTION else 400
    assert (summary["method"], summary["interactions"]) == (method, interactions)
    measured = json.loads((out / "training.json").read_text())
    assert summary["success_rate"] == measured["success_rate"]
    offline = method not in WITHOUT_DATA
    assert summary["offline_transitions"] == (800 if offline else 0)
    assert summary["transitions"] == (800 if offline else None)
    assert summary["mode"] == ("in_process" if offline else None)
    assert (out / "generation.json").exists() == offline
    grows_trees = offline and method not in ("ddqn_random", "ddqn_scatter", "ddqn_forward")
    assert (out / "coverage.png").exists() == grows_trees
    assert (out / "episode.gif").exists() and (out / "learning_curve.png").exists()
    written = effective_config.values(effective_config.load(out / "config.yaml"))
    given = [Override("", setting) for setting in (f"run.method={method}", *more[1::2])]
    assert (
        written["train"].items()
        >= {
            key: effective_config.values(effective_config.load(TINY, given))["train"][key]
            for key in ("offline", "double_q", "hindsight", "curriculum", "randomise")
        }.items()
    )
    assert (out / "model.pt").exists() == (method != "planner")
    if method == "planner":
        return
    task = _core.Config.from_file(out / "config.yaml").task
    values = policy_file.read(out / "model.pt", task)
    assert values(task.observation(task.start[None])).shape == (1, task.actions)


@pytest.mark.parametrize("method", ["ddqn", "her", "rcg"])
@pytest.mark.parametrize("cut", [3, 41])
def test_a_resumed_run_ends_with_the_same_bits(tmp_path: Path, method: str, cut: int) -> None:
    """It is cut off early and between evaluations. The robot begins where it at times pushes a
    box in."""
    behind = ("task.bodies.0.start=[-4.9, 1.13, 0.0]", "task.horizon=6")
    ends = []
    for name, cuts in (("whole", []), ("cut", [cut, 7])):
        folder = run_folder(tmp_path / name, None, f"run.method={method}", *behind)
        for stop in [*map(after_polls, cuts), lambda: False]:
            one = training(folder)
            if one.has_checkpoint():
                one.restore()
            finished = one.run(NoSource(), stop, record=False)
        assert finished and one.interactions == 240
        assert method != "her" or one.model.replay.online.rows["goals"].any()
        ends.append(flat(checkpoint.read(folder / "checkpoint" / "state.pt")))
    same = ends[0] == ends[1]
    assert same and len(ends[0]) > 50  # no diff of bytes


def test_a_stopped_run_without_offline_data_is_resumed_by_its_command(tmp_path: Path) -> None:
    folder = run_folder(tmp_path / "run", None, "run.method=her")
    assert not training(folder).run(NoSource(), after_polls(20), record=False)
    assert cli.main(["--resume", "--out", str(folder)]) == 0
    with (folder / "progress.csv").open() as file:
        assert [row["interactions"] for row in csv.DictReader(file)] == ["80", "160", "240"]


def test_a_checkpoint_keeps_its_method(tmp_path: Path, capsys) -> None:
    folder = run_folder(tmp_path / "run", None, "run.method=ddqn")
    training(folder).save()
    assert cli.main(["--resume", "--out", str(folder), "--method", "dqn"]) == 2
    assert capsys.readouterr().err.startswith("rtg: --resume: run.method must stay ddqn as in ")


def test_a_file_of_a_hindsight_policy_asks_for_the_nearest_layouts(tmp_path: Path) -> None:
    folder = run_folder(tmp_path / "run", None, "run.method=her", "task.horizon=5")
    one = training(folder)
    assert one.run(NoSource(), lambda: False, record=False)
    one.finish()
    values = policy_file.read(folder / "model.pt", one.task)
    seen = one.task.observation(np.stack([one.task.jittered_start(1.0, 5, k) for k in range(50)]))
    np.testing.assert_array_equal(values(seen), one.model.values(seen))


def test_domain_randomisation_is_judged_where_it_is_trained(tmp_path: Path, rows: Rows) -> None:
    """This holds for the final evaluation, too."""
    wanted = ("run.method=ddqn_rtg_dr", "train.interactions=4", "train.eval_episodes=30")
    folder = run_folder(tmp_path / "run", rows, *wanted)
    assert trainer.main([str(folder), "--no-stream"]) == 0
    task = _core.Config.from_file(folder / "config.yaml").task
    with np.load(folder / "best_episode.npz") as best:
        moved = np.abs(best["poses"][0] - task.start)[1:, :2].max()
    assert task.start_jitter < moved <= task.randomisation == 0.5


def test_the_device_is_a_gpu_where_there_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    for seen in (False, True):
        monkeypatch.setattr("torch.cuda.is_available", lambda seen=seen: seen)
        assert device.chosen("auto") == ("cuda" if seen else "cpu")
        assert device.chosen("cpu") == "cpu"
    assert device.chosen("cuda") == "cuda"
    monkeypatch.setattr("torch.cuda.is_available", lambda: False)
    with pytest.raises(
        UserError, match=r"train\.device: is cuda, but PyTorch finds no CUDA device;"
    ):
        device.chosen("cuda")


def test_a_device_that_is_not_there_is_refused_before_anything_starts(
    tmp_path: Path, capsys, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("torch.cuda.is_available", lambda: False)
    words = [str(TINY), "--set", "train.device=cuda", "--out", str(tmp_path / "run")]
    assert cli.main(words) == 2
    assert capsys.readouterr().err.startswith(
        "rtg: train.device: is cuda, but PyTorch finds no CUDA"
    )
    assert not (tmp_path / "run").exists()
