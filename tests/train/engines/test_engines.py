"""The seam of forward simulators: what a user's class is given, and what becomes of its answers."""

import hashlib
import pickle
from pathlib import Path

import numpy as np
import pytest
import rtg
from rtg import _core, cli
from rtg.engines import EngineError, Scene, identity, simulator
from rtg.errors import UserError
from rtg.files import run_folder, versions
from rtg.run import run_args
from rtg.run.plan import make_plan

HERE = Path(__file__).parent


@pytest.fixture(autouse=True)
def _toys_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(HERE))


def of(engine: str, task: str = "gathering") -> rtg.Task:
    return rtg.load_task(task, [f"forward.engine=toy_engines:{engine}"])


def test_pushes_are_what_the_engine_says_in_single_precision_and_in_the_arena() -> None:
    task = of("Ghost")
    states = np.repeat(task.start()[None], task.actions, 0)
    states[:, 0, :2] = 7.3
    ends, ok = rtg.forward.Forward(task).push(states, np.arange(task.actions))
    assert ok.all() and (ends == np.float32(ends)).all()
    ways = task.core.ways(np.arange(task.actions))
    np.testing.assert_allclose(ends[:, 0, :2], np.clip(7.3 + ways, -8.0, 8.0), atol=1e-6)
    np.testing.assert_allclose(ends[:, 1:], states[:, 1:], atol=1e-6)


def test_a_push_that_cannot_be_simulated_leaves_the_state() -> None:
    task = of("Finicky")
    states = np.repeat(task.start()[None], 48, 0)
    ends, ok = rtg.forward.Forward(task).push(states, np.arange(48))
    assert 0 < ok.sum() < 48
    assert (ends[~ok] == states[~ok]).all() and (ends[ok] != states[ok]).any((1, 2)).all()


def test_no_states_are_pushed_without_asking() -> None:
    task = of("Broken")
    ends, ok = rtg.forward.Forward(task).push(np.zeros((0, 4, 3)), np.zeros(0, np.int64))
    assert ends.shape == (0, 4, 3) and ok.shape == (0,)


def test_a_simulator_can_be_pickled() -> None:
    task = of("Ghost")
    one = simulator(task.config)
    other = pickle.loads(pickle.dumps(one))
    push = task.inner(task.start()[None]), np.array([3])
    assert (one.push(*push)[0] == other.push(*push)[0]).all()


def test_the_identity_is_the_version_or_else_the_source() -> None:
    ours = [Path(rtg.engines.__file__).with_name(name) for name in ("engine.py", "scene.py")]
    files = [HERE / "toy_engines.py", *ours]
    digest = hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()[:12]
    assert identity(of("Ghost").config) == f"toy_engines:Ghost sha256:{digest}"
    assert identity(of("Versioned").config) == "toy_engines:Versioned 1.2"
    slow = ["forward.engine=newton", "forward.friction=0.5"]
    assert identity(rtg.load_task("maze", slow).config) == "newton friction x 0.5"
    for engine in ("NoText", "TwoLines"):
        with pytest.raises(UserError, match="; legal: a text of one line"):
            identity(of(engine).config)


@pytest.mark.parametrize("engine", ["box2d", "newton", "mujoco"])
def test_friction_of_the_forward_simulator_is_as_that_of_all_bodies(engine: str) -> None:
    if engine == "mujoco":
        pytest.importorskip("mujoco", reason="the extra `mujoco` is not installed")
    task = rtg.load_task("gathering", [f"forward.engine={engine}"])
    text = task.config.yaml
    rough = text.replace("friction: 0.5", "friction: 1.5")
    assert rough != text
    scaled = _core.Config.from_text(text, "scaled", ["forward.friction=3"])
    state = task.inner(task.start()[None])
    state[0, 0] = state[0, 1] - [1.4, 0.3, 0.0]
    way = np.array([[1.5, 0.0]])
    ends = [
        simulator(config).push_along(state, way)[0]
        for config in (task.config, scaled, _core.Config.from_text(rough, "rough"))
    ]
    np.testing.assert_allclose(ends[1], ends[2], atol=1e-6)
    assert np.abs(ends[0] - ends[1])[0, 1].max() > 1e-3


def test_what_another_engine_says_is_no_data_for_a_run(tmp_path: Path) -> None:
    tiny = str(HERE.parents[2] / "config/tests/tiny.yaml")
    newton, box2d = (str(tmp_path / name) for name in ("newton", "box2d"))
    words = [tiny, "--in-process", "--out"]
    engine = ["--set", "forward.engine=newton"]
    assert cli.main([*words, newton, "--no-train", *engine]) == 0
    with pytest.raises(UserError, match="are of the forward simulator newton, and this run's is "):
        make_plan(run_args.parse([*words, box2d, "--data", newton]))
    assert not Path(box2d).exists()
    between = str(tmp_path / "between")
    make_plan(run_args.parse([*words, between, "--data", newton, *engine]))
    for data in (newton, between):
        with pytest.raises(UserError, match="are of the forward simulator newton, and this run"):
            make_plan(run_args.parse([*words, box2d, "--data", data, "--interactions", "9"]))
    versions_file = Path(between) / versions.FILE
    found = {**run_folder.read_json(versions_file), versions.ENGINE_KEY: "newton 2"}
    run_folder.write_json(versions_file, found)
    with pytest.raises(UserError, match="begun with the forward simulator newton 2, and this is "):
        make_plan(run_args.parse(["--resume", "--out", between]))


@pytest.mark.parametrize(("engine", "error"), [("Leaving", "SystemExit"), ("Ours", "RunError")])
def test_no_error_of_a_push_ends_a_run_without_its_traceback(engine: str, error: str) -> None:
    task = of(engine)
    with pytest.raises(EngineError, match=rf"{error}: no licence\nin the state \[\["):
        rtg.forward.Forward(task).push(task.start()[None], [0])


def test_fixed_bodies_stay_to_the_bit() -> None:
    task = of("Drifting", "drawer")
    states, engine = task.inner(task.start()[None]), simulator(task.config)
    for _ in range(40):
        states, ok = engine.push(states, np.array([0]))
        assert ok.all() and (states[0, 3] == task.core.start[3]).all()


def test_a_failure_has_the_users_traceback_and_the_state() -> None:
    task = of("Broken")
    states = np.repeat(task.start()[None], 3, 0)
    states[1, 0, 0] = 2.5
    with pytest.raises(EngineError) as caught:
        rtg.forward.Forward(task).push(states, [0, 1, 2])
    lines = str(caught.value).splitlines()
    assert lines[0] == "forward.engine toy_engines:Broken failed:"
    assert lines[1] == "Traceback (most recent call last):"
    assert f'File "{HERE / "toy_engines.py"}"' in lines[2]
    assert "ZeroDivisionError: no such place" in lines
    assert lines[-1].startswith("in the state [[2.5, -5.0, 0.0]")
    assert "rtg/engines" not in str(caught.value)


def test_fixed_bodies_that_move_are_an_error() -> None:
    task = of("Wind", "drawer")
    words = r"returned with True fixed bodies that have moved, for the state \[\["
    with pytest.raises(EngineError, match=words):
        rtg.forward.Forward(task).push(task.start()[None], [0])


def test_a_push_after_which_bodies_overlap_is_none() -> None:
    task = of("Ghost")
    beside = task.start()
    beside[0, :2] = beside[1, :2] - [2.5, 0.0]  # the push of 2 m ends within the body
    after, ok = rtg.forward.Forward(task).push(beside[None], [0])
    assert not ok[0]
    np.testing.assert_array_equal(after[0], task.outer(task.inner(beside[None]))[0])


@pytest.mark.parametrize(
    ("engine", "words"),
    [
        ("BrokenTogether", "in a batch of 2 states, but in none of them alone"),
        (
            "Short",
            r"returned arrays \(2, 1, 3\) of float64 and \(2,\) of bool; legal: states \(2, 4",
        ),
        ("Lost", r"returned with True numbers that are not finite for the state \[\["),
    ],
)
def test_other_failures_say_what_they_are(engine: str, words: str) -> None:
    task = of(engine)
    with pytest.raises(EngineError, match=words):
        rtg.forward.Forward(task).push(np.repeat(task.start()[None], 2, 0), [0, 1])


@pytest.mark.parametrize(
    ("engine", "error", "words"),
    [
        ("toy_engines:Unmade", EngineError, "RuntimeError: no licence\nwhen it was made"),
        ("toy_engines:Missing", UserError, "the module toy_engines has no Missing; legal: a class"),
        ("toy_engines:NoEngine", UserError, "has no method push; legal: a class as"),
        ("no_such.module:Engine", UserError, "there is no module no_such; legal: one on the path"),
    ],
)
def test_an_engine_that_cannot_be_made(engine: str, error: type, words: str) -> None:
    config = rtg.load_task("gathering", [f"forward.engine={engine}"]).config
    with pytest.raises(error, match=words):
        simulator(config)


@pytest.mark.parametrize("engine", ["bax2d", "a:b:c", ":Engine", "module:2x"])
def test_a_name_of_no_engine_is_refused(engine: str) -> None:
    with pytest.raises(ValueError, match=r"is no engine.*legal: box2d, newton, mujoco, or module:"):
        rtg.load_task("gathering", [f"forward.engine={engine}"])


@pytest.mark.parametrize("task", ["gathering", "push_t", "art_manip", "drawer"])
def test_a_scene_is_in_metres_and_kilograms(task: str) -> None:
    loaded = rtg.load_task(task)
    scene = Scene(loaded.config)
    assert [body.name for body in scene.bodies] == loaded.bodies
    robot = scene.bodies[0]
    points = np.concatenate([part.vertices for part in robot.parts])
    reach = np.linalg.norm(points, axis=1).max() + robot.parts[0].radius
    assert reach == pytest.approx(scene.size)
    for joint in scene.joints:
        ends = []
        for body, (x, y) in ((joint.parent, joint.on_parent), (joint.child, joint.on_child)):
            left, up, theta = scene.start[body]
            c, s = np.cos(theta), np.sin(theta)
            ends.append(np.array([left + c * x - s * y, up + s * x + c * y]))
        x, y = joint.axis
        held = np.array([[-y, x]]) if joint.type == "prismatic" else np.eye(2)
        np.testing.assert_allclose(held @ (ends[1] - ends[0]), 0.0, atol=1e-6)


@pytest.mark.parametrize(("engine", "status"), [("Unmade", 1), ("NoEngine", 2)])
def test_a_run_whose_engine_cannot_be_made_leaves_no_folder(
    tmp_path: Path, engine: str, status: int
) -> None:
    setting = ["--set", f"forward.engine=toy_engines:{engine}"]
    assert cli.main(["gathering", *setting, "--out", str(tmp_path / "run")]) == status
    assert not (tmp_path / "run").exists()


def test_check_makes_the_engine_and_names_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["check", "gathering", "--set", "forward.engine=toy_engines:Versioned"]) == 0
    assert "\nforward simulator: toy_engines:Versioned 1.2\n" in capsys.readouterr().out
    assert cli.main(["check", "gathering", "--set", "forward.engine=toy_engines:NoEngine"]) == 2


def failing_run(engine: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> tuple[str, str]:
    """Returns output and errors of a run with a toy engine, which ends with status 1."""
    words = ["gathering", "--in-process", "--no-train", "--transitions", "300"]
    setting = ["--set", f"forward.engine=toy_engines:{engine}"]
    assert cli.main([*words, *setting, "--out", str(folder)]) == 1
    out, err = capsys.readouterr()
    return out, err


def test_a_run_whose_engine_simulates_nothing_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    told, _ = failing_run("Helpless", tmp_path / "run", capsys)
    assert "bottleneck: forward simulator: it could not simulate " in told


def test_a_run_with_a_broken_engine_ends_with_its_traceback(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _, told = failing_run("Broken", tmp_path / "run", capsys)
    assert "ZeroDivisionError: no such place" in told and "in the state [[" in told
