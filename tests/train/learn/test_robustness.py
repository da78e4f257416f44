"""A policy under variants of its task."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rtg import _core, paths
from rtg.compare import report_robustness
from rtg.errors import UserError
from rtg.learn import robustness
from rtg.learn.robustness import Variant, evaluate_variant

FILE = paths.CONFIG / "gathering.yaml"
CONFIG = _core.Config.from_file(FILE)


def groups(task: str) -> list[str]:
    config = _core.Config.from_file(paths.CONFIG / f"{task}.yaml")
    return list(dict.fromkeys(v.group for v in robustness.variants(config)))


def test_the_variants_are_of_starts_noise_and_physics() -> None:
    physics = ["noise of poses", "friction", "mass of objects", "stride", "coasting", "simulator"]
    fixed = ["as trained", "robot", "objects moved", "objects turned"]
    assert groups("gathering") == [*fixed, *physics]
    assert groups("art_manip") == [*fixed[:3], *physics], "a chain does not turn alone"
    assert groups("push_t") == [*fixed[:3], *physics], "it starts at any angle already"


RANGES = {  # of the first box, the same with all objects up to 0.5 m off, and up to 0.25 rad
    "{x: [-4, -3], y: [1, 7.8], theta: 0.2}": (
        {"x": [-4.5, -2.5], "y": [0.8, 8], "theta": [0.2, 0.2]},  # not beyond the arena
        {"x": [-4, -3], "y": [1, 7.8], "theta": [-0.05, 0.45]},
    ),
    "{in: {disc: {centre: [-4, 2], radius: 1}}, theta: [-3, 3]}": (
        {"in": {"disc": {"centre": [-4, 2], "radius": 1.5}}, "theta": [-3, 3]},
        {"in": {"disc": {"centre": [-4, 2], "radius": 1}}, "theta": [-3.142, 3.142]},
    ),
    "{in: {polygon: [[-5, 1], [-3, 1], [-3, 3], [-5, 4]]}}": (
        {
            "in": {"polygon": [[-5.5, 0.5], [-2.5, 0.5], [-2.5, 3.309], [-5.5, 4.809]]},
            "theta": [-3.142, 3.142],
        },
        None,  # it starts at any angle already
    ),
}


def starts_of(variant: Variant) -> dict[int, Any]:
    """Returns the starts that a variant has settings of, to 0.001, by body."""
    found = {}
    for setting in variant.settings:
        if match := re.fullmatch(r"task\.bodies\.(\d)\.start=(.*)", setting):
            start = json.loads(match[2], parse_float=lambda x: round(float(x), 3))
            found[int(match[1])] = start
    return found


@pytest.mark.parametrize("start", RANGES)
def test_objects_go_beyond_their_ranges_beside_objects_with_places(
    start: str, tmp_path: Path
) -> None:
    file = tmp_path / "mixed.yaml"
    file.write_text(FILE.read_text().replace("start: [-3.0, 1.13, 0.2]", f"start: {start}"))
    found = {v[:2]: v for v in robustness.variants(_core.Config.from_file(file))}
    moved = found["objects moved", "by up to 0.5 m"]
    turned = starts_of(found["objects turned", "by up to 0.25 rad"])
    assert {2, 3} <= turned.keys()
    assert moved.settings[:2] == ("task.start_jitter=0.5", "train.randomise=false")
    assert (starts_of(moved), turned.get(1)) == ({1: RANGES[start][0]}, RANGES[start][1])
    assert reasons(file) == {}


def test_a_robot_that_starts_in_a_range_starts_elsewhere_in_the_arena() -> None:
    config = _core.Config.from_file(paths.CONFIG / "insert.yaml")
    (robot,) = (v for v in robustness.variants(config) if v.group == "robot")
    changed = _core.Config.from_file(paths.CONFIG / "insert.yaml", list(robot.settings))
    y = [changed.task.jittered_start(0.1, 1, k)[0, 1] / changed.task.metre for k in range(50)]
    assert max(y) > -4.0 + 2.0 and min(y) >= -8.0


ONTO = Variant("objects moved", "onto the robot", ("task.bodies.1.start=[0, -5, 0]",))
WHY = "not possible: task.bodies.1.start: overlaps 'robot'"


def reasons(file: Path) -> dict[str, str | None]:
    """Returns why settings of variants are refused, by the variant's group and label."""
    config = _core.Config.from_file(file)
    found = {}
    for variant in robustness.variants(config):
        try:
            _core.Config.from_file(file, list(variant.settings))
        except _core.ConfigError:
            row = evaluate_variant(file, config, values_of([]), variant, 1)
            found[f"{variant.group} {variant.label}"] = row.reason
    return found


def test_a_missing_engine_of_a_variant_is_a_reason_and_one_of_the_run_an_error(
    tmp_path: Path,
) -> None:
    file = tmp_path / "config.yaml"
    config = _core.Config.from_file(paths.CONFIG / "gathering.yaml", ["forward.engine=none:Own"])
    file.write_text(config.yaml)
    values = values_of([])
    other = Variant("simulator", "x", ("forward.engine=none:Other",))
    reason = evaluate_variant(file, config, values, other, 2).reason
    assert reason is not None and "there is no module none" in reason
    with pytest.raises(UserError, match="there is no module none"):
        evaluate_variant(file, config, values, Variant("as trained", ""), 2)


@pytest.mark.parametrize("task", paths.task_names())
def test_the_settings_of_all_variants_are_legal(task: str) -> None:
    assert reasons(paths.CONFIG / f"{task}.yaml") == {}


def test_a_variant_that_is_refused_says_why() -> None:
    assert evaluate_variant(FILE, CONFIG, values_of([]), ONTO, 4) == (ONTO, None, None, WHY)
    narrow = ("task.bodies.1.start={x: [-1.43, 1.43], y: -5, theta: 0}",)  # around the robot
    row = evaluate_variant(FILE, CONFIG, values_of([]), Variant("", "", narrow), 4)
    assert row.reason == (
        "not possible: task.start_jitter: "
        "with objects shifted by up to 0.1 m too few starts are legal ..."
    )


GOALS = {  # goal, and the objects that may turn
    "[{kind: still, stays: 0.3}, {kind: box, disc: {centre: [0, 0], radius: 2}}]": [2, 3],
    "[{kind: '*', stays: 1.0, not: true}]": [],
}


@pytest.mark.parametrize("goal", GOALS)
def test_objects_that_are_to_stay_start_in_no_ranges(goal: str, tmp_path: Path) -> None:
    text = FILE.read_text().replace("box1, kind: box", "box1, kind: still")
    file = tmp_path / "stays.yaml"
    disc = "    - {disc: {centre: [0.0, 0.0], radius: 2.0}}\n"
    file.write_text(text.replace("goal:\n" + disc, f"goal: {goal}\n"))
    assert reasons(file) == {}
    found = robustness.variants(_core.Config.from_file(file))
    turned = {s.split("=")[0] for v in found if v.group == "objects turned" for s in v.settings}
    assert turned == {f"task.bodies.{k}.start" for k in GOALS[goal]}


def values_of(seen: list[np.ndarray]):
    def values(observation: np.ndarray) -> np.ndarray:
        seen.append(observation)
        return np.zeros((len(observation), CONFIG.task.actions))

    return values


def test_the_policy_sees_the_units_of_its_own_task_and_noise_where_it_is_asked_for() -> None:
    plain, noisy, longer = [], [], []
    for seen, variant in (
        (plain, Variant("", "")),
        (noisy, Variant("", "", noise=0.1)),
        (longer, Variant("", "", ("task.push.strides=[2.5]",))),
    ):
        row = evaluate_variant(FILE, CONFIG, values_of(seen), variant, 4)
        assert row.success == 0.0 and row.length == CONFIG.task.horizon
    np.testing.assert_array_equal(plain[0], longer[0])
    off = (noisy[0] - plain[0])[:, :2] * CONFIG.task.position_unit
    assert 0.02 < np.abs(off).mean() < 0.3


def trained(folder: Path, *settings: str) -> Path:
    """Writes the configuration and a policy of a run into the folder."""
    from rtg.learn import networks, policy_file

    config = _core.Config.from_file(FILE, list(settings))
    task, train = config.task, config.train
    (folder / "config.yaml").write_text(config.yaml)
    layout = 6 if train.hindsight else 0  # x, y of three boxes
    network = networks.make("headings", task.observation_size + layout, task.headings)
    policy_file.write(folder / "model.pt", task, train, network.state_dict())
    return folder


def test_the_command_writes_table_picture_and_json(tmp_path: Path) -> None:
    from rtg.compare.evaluate import evaluate
    from rtg.errors import UserError

    with pytest.raises(UserError, match=r"has no config\.yaml"):
        evaluate(tmp_path, 2)
    (tmp_path / "config.yaml").write_text(CONFIG.yaml)
    with pytest.raises(UserError, match=r"has no model\.pt"):
        evaluate(tmp_path, 2)
    text = evaluate(trained(tmp_path), 2)
    rows = json.loads((tmp_path / "evaluation.json").read_text())["rows"]
    variants = robustness.variants(CONFIG)
    assert [row["amount"] for row in rows] == [variant.amount for variant in variants]
    assert len(rows) == len(variants) == text.count("\n| ") - 2  # head and rule
    assert (tmp_path / "evaluation.md").read_text() == text
    assert (tmp_path / "evaluation.png").stat().st_size > 5_000


def test_amounts_are_in_metres_radians_and_factors() -> None:
    found = [v for v in robustness.variants(CONFIG) if v.amount is not None]
    assert {v.group for v in found} == {group for group, *_ in report_robustness.PANELS}
    smaller = _core.Config.from_file(paths.CONFIG / "push_t.yaml")
    assert smaller.task.metre != 1.0
    found += [v for v in robustness.variants(smaller) if v.amount is not None]
    for _, label, _, _, amount in found:
        assert f"{amount:.3g}" == f"{float(re.findall(r'[0-9.]+', label)[0]):.3g}", label


def test_table_json_and_picture_say_why_a_variant_is_not_possible(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from matplotlib.axes import Axes
    from rtg.compare.evaluate import draw_again, evaluate

    monkeypatch.setattr(robustness, "variants", lambda config: [Variant("as trained", ""), ONTO])
    drawn: list[str] = []
    monkeypatch.setattr(Axes, "text", lambda axes, x, y, text, **how: drawn.append(text))
    text = evaluate(trained(tmp_path), 1)
    assert f"| objects moved | onto the robot | {WHY} |  |\n" in text
    rows = json.loads((tmp_path / "evaluation.json").read_text())["rows"]
    assert [row["reason"] for row in rows] == [None, WHY]
    draw_again(tmp_path)
    assert drawn == ["0.00", WHY] * 2


def test_the_table_says_which_policy_it_is_of(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from rtg.compare.evaluate import evaluate

    monkeypatch.setattr(robustness, "variants", lambda config: [Variant("as trained", "")])
    loops = evaluate(trained(tmp_path), 1)
    assert "in a state to which the episode returns, the best one not yet tried there" in loops
    greedy = evaluate(trained(tmp_path, "train.leave_loops=false"), 1)
    assert "\nGreedy policy. 1 held-out starts each.\n" in greedy


def test_the_command_takes_several_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from rtg import cli

    monkeypatch.setattr(robustness, "variants", lambda config: [Variant("as trained", "")])
    runs = [tmp_path / "1", tmp_path / "2"]
    for seed, run in enumerate(runs, start=1):
        run.mkdir()
        trained(run, f"run.seed={seed}")
    assert cli.main(["evaluate", *map(str, runs), "--episodes", "1"]) == 0
    assert re.findall("^# .*", capsys.readouterr().out, re.MULTILINE) == [
        "# gathering, ddqn_rtg, seed 1",
        "# gathering, ddqn_rtg, seed 2",
    ]
    assert all((run / "evaluation.md").is_file() for run in runs)


def test_the_layouts_of_a_hindsight_policy_are_drawn_once_for_all_variants(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from rtg.compare.evaluate import evaluate
    from rtg.learn import policy_file

    made = []

    class Counted(policy_file.Layouts):
        def __init__(self, task: _core.Task) -> None:
            made.append(task)
            super().__init__(task)

    monkeypatch.setattr(policy_file, "Layouts", Counted)
    monkeypatch.setattr(robustness, "variants", lambda config: [Variant("", str(k)) for k in "ab"])
    evaluate(trained(tmp_path, "train.hindsight=4"), 1)
    assert len(made) == 1
