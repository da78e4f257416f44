"""The loader on wrong input: exact text with place and legal values."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from rtg import _core, paths

TASK = """\
task:
  name: two_boxes
  bodies:
    - {name: robot, kind: robot, shape: {regular: {sides: 6, radius: 0.8}}, start: [0, -5, 0]}
    - {name: a, kind: box, shape: {box: [1, 1]}, start: [3, 0, 0]}
    - {name: b, kind: box, shape: {box: [1, 1]}, start: [-3, 0, 0]}
  goal:
    - {kind: box, disc: {centre: [0, 0], radius: 2}}
  push: {headings: 8}
search:
  breadth: 4
"""


def blocks(name: str) -> list[list[str]]:
    """The blocks of lines of a data file beside this one; # begins a comment."""
    text = Path(__file__).with_name(name).read_text()
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    return [block.splitlines() for block in "\n".join(lines).strip().split("\n\n")]


def spelt(line: str) -> str:
    return line[2:].replace("\\n", "\n").replace("\\t", "\t")


FILES = blocks("wrong_files.txt")
SETTINGS = blocks("wrong_settings.txt")


def refusal(file: Path, *settings: str) -> str:
    """Returns what is wrong; empty if nothing is."""
    try:
        _core.Config.from_file(file, settings)
    except _core.ConfigError as error:
        return str(error)
    return ""


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("config") / "two_boxes.yaml"
    path.write_text(TASK)
    return path


def test_the_text_behind_the_mistakes_is_legal(file: Path) -> None:
    assert refusal(file) == ""


def test_a_learner_without_transitions_needs_no_room_for_them(file: Path) -> None:
    assert "is too small" in refusal(file, "train.buffer=1000")
    assert refusal(file, "train.buffer=1000", "train.offline=false") == ""


@pytest.mark.parametrize("block", FILES, ids=[b[1] for b in FILES])
def test_a_mistake_in_a_file_is_named_with_its_line(block: list[str], tmp_path: Path) -> None:
    old, new, message = spelt(block[0]), spelt(block[1]), block[2]
    old = TASK if old == "*" else old
    assert TASK.count(old) == 1
    path = tmp_path / "wrong.yaml"
    path.write_text(TASK.replace(old, new))
    assert refusal(path) == f"{path}:{message}".replace("{file}", str(path))


@pytest.mark.parametrize(("setting", "message"), SETTINGS, ids=[s for s, _ in SETTINGS])
def test_a_mistake_in_a_setting_is_named_with_the_flag(
    setting: str, message: str, file: Path
) -> None:
    said = refusal(file, "run.seed=2", setting)
    assert said == f"--set {setting}: {message}".replace("{file}", str(file))


WALLS = """\
    - {name: left, kind: wall, fixed: true, shape: {box: [0.2, 1]}, start: [2.37, 0, 0]}
    - {name: right, kind: wall, fixed: true, shape: {box: [0.2, 1]}, start: [3.63, 0, 0]}
    - {name: above, kind: wall, fixed: true, shape: {box: [1, 0.2]}, start: [3, 0.63, 0]}
    - {name: below, kind: wall, fixed: true, shape: {box: [1, 0.2]}, start: [3, -0.63, 0]}
"""
TOO_FEW = (
    "m too few starts are legal (bodies 0.02 m apart, objects in the arena, goal not met); 'a' was "
    "nearer to 'right' than the clearance in {share}% of the failed tries; legal: at most"
)


def test_the_example_of_the_page_on_tasks_is_legal(tmp_path: Path) -> None:
    page = (paths.ROOT / "docs" / "tasks.md").read_text()
    file = tmp_path / "example.yaml"
    file.write_text(page.split("```yaml\n")[1].split("```")[0])
    assert refusal(file) == ""


def test_a_body_that_is_to_stay_has_one_place(tmp_path: Path) -> None:
    path = tmp_path / "stays.yaml"
    ranged = TASK.replace("start: [3, 0, 0]", "start: {x: [2, 4], y: 0, theta: 0}")
    path.write_text(ranged.replace("radius: 2}}", "radius: 2}}\n    - {kind: box, stays: 1}"))
    wrong = "'a' starts anywhere in a range; legal: bodies whose start is [x, y, theta]"
    assert refusal(path) == f"{path}:9: key 'task.goal.1.stays': {wrong}"


def test_text_must_be_utf8(file: Path, tmp_path: Path) -> None:
    wrong = "has a byte that is not UTF-8; legal: text in UTF-8"
    path = tmp_path / "latin.yaml"
    path.write_bytes(file.read_bytes() + "# größer\n".encode("latin-1"))
    lines = file.read_bytes().count(b"\n") + 1
    assert refusal(path) == f"{path}:{lines}: {wrong}"


def test_jitters_must_leave_room_for_starts(tmp_path: Path) -> None:
    """Between the walls, box a may move by 0.01 m: of starts within 0.1 m one in 100 is legal."""
    path = tmp_path / "walls.yaml"
    path.write_text(TASK.replace("  goal:\n", WALLS + "  goal:\n"))

    task = "key 'task.start_jitter': with objects shifted by up to "
    too_few = TOO_FEW.format(share=48)
    assert refusal(path) == f"{path}:4: {task}0.1 {too_few} 0.05 m with these bodies"
    wide, too_few = "task.start_jitter=0.2", TOO_FEW.format(share=53)
    assert refusal(path, wide) == f"--set {wide}: {task}0.2 {too_few} 0.05 m with these bodies"
    legal = ["task.start_jitter=0.01", "train.start_jitter=0.01"]
    assert refusal(path, *legal) == ""
    last = "train.start_jitter=0.4"
    assert refusal(path, *legal, last).startswith(
        f"--set {last}: key 'train.start_jitter': with objects shifted by up to 0.4 m"
    )


def test_jitters_must_keep_objects_in_the_arena() -> None:
    """Six boxes moved by up to 10 m are hardly ever all within 7 m."""
    task, wide = paths.CONFIG / "sorting_hard.yaml", "task.randomisation=10"
    assert refusal(task, "task.push.arena=7") == ""
    said = refusal(task, "task.push.arena=7", wide)
    assert said.startswith(f"--set {wide}: key 'task.randomisation': with objects shifted by")


def test_of_several_settings_the_one_that_made_it_wrong_is_named(file: Path) -> None:
    settings = ["search.breadth=3", "task.goal.0.disc.radius=25", "run.seed=2"]
    assert refusal(file, *settings).startswith(
        f"--set {settings[1]}: {file}:8: key 'task.goal': holds "
    )


def test_a_mistake_of_the_file_is_not_blamed_on_a_setting(file: Path, tmp_path: Path) -> None:
    path = tmp_path / "wrong.yaml"
    path.write_text(TASK.replace("radius: 2", "radius: 25"))
    assert refusal(path, "run.seed=2").startswith(f"{path}:8: key 'task.goal': holds ")


def test_a_mistake_that_a_later_setting_mends_is_not_told(file: Path, tmp_path: Path) -> None:
    path = tmp_path / "wrong.yaml"
    path.write_text(TASK.replace("radius: 2", "radius: 25"))
    same_name = "task.bodies.1={name: b, kind: box, shape: {box: [1, 1]}, start: [3, 0, 0]}"
    mend = "task.goal.0.disc.radius=2"
    assert refusal(path, same_name, mend).startswith(f"{path}:6: key 'task.bodies.2.name': ")


def test_there_are_many_mistakes() -> None:
    assert len(FILES) + len(SETTINGS) >= 80


def test_a_file_that_is_none_is_named(tmp_path: Path) -> None:
    legal = "legal: a YAML file with a section 'task'"
    assert refusal(tmp_path / "none.yaml") == f"{tmp_path}/none.yaml: no such file; {legal}"
    assert refusal(tmp_path) == f"{tmp_path}: is a folder; {legal}"


def test_a_task_may_lie_in_another_file(file: Path, tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(f"task: {file}\nsearch: {{breadth: 7}}\n")
    text = _core.Config.from_file(path).yaml
    assert "name: two_boxes" in text and "\n  breadth: 7 " in text


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("none.yaml", "no such file; legal: a YAML file with a section 'task'"),
        (
            "mine.yaml",
            "has no mapping 'task'; legal: a mapping, or the path of a YAML file with a section "
            "'task'",
        ),
    ],
)
def test_a_wrong_path_of_a_task_is_named(name: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(f"\ntask: {name}\n")
    assert refusal(path) == f"{path}:2: key 'task': {tmp_path}/{name}: {message}"


def test_check_says_what_it_understood(file: Path) -> None:
    settings = ["search.transitions=500", "search.depth=6", "run.workers=3"]
    settings += ["train.interactions=900", "train.transitions_before_learning=400"]
    said = _core.Config.from_file(file, settings).description
    assert said == Path(__file__).with_name("understood.txt").read_text()


@pytest.mark.parametrize(
    ("discount", "words"),
    [("0", "discount 0.8 (the task's, as train.discount is 0), "), ("0.8", "discount 0.8, ")],
)
def test_check_says_whose_discount_holds(discount: str, words: str, file: Path) -> None:
    assert words in _core.Config.from_file(file, [f"train.discount={discount}"]).description


def test_check_says_which_objects_start_around_their_places() -> None:
    def said(text: str) -> str:
        return _core.Config.from_text(text, "starts").description

    moved = "start within 0.1 m of the layout above"
    one = TASK.replace("[3, 0, 0]", "{x: [3, 4], y: [3, 4]}")
    both = one.replace("[-3, 0, 0]", "{x: [-4, -3], y: [3, 4]}")
    assert f"  objects {moved}" in said(TASK)
    assert f"  objects without a range {moved}" in said(one)
    assert "layout above" not in said(both)


@pytest.mark.parametrize(
    ("start", "words"),
    [
        ("{x: [2, 4], y: 0, theta: 0}", "at x from 2 to 4 m, y = 0 m, 0 deg"),
        (
            "{x: 3, y: [-1, 1], theta: [0, 1.5]}",
            "at x = 3 m, y from -1 to 1 m, from 0 to 85.94 deg",
        ),
        ("{in: {disc: {centre: [3, 0], radius: 1}}}", "within 1 m of (3, 0), any angle"),
    ],
)
def test_check_says_what_a_start_is_drawn_from(start: str, words: str) -> None:
    said = _core.Config.from_text(TASK.replace("[3, 0, 0]", start), "starts").description
    assert f"friction 0.30  {words}\n" in said


def test_check_says_how_far_a_joint_is_to_slide() -> None:
    joint = "{parent: a, child: b, type: prismatic, axis: [1, 0]}"
    text = TASK.replace("  push:", f"  joints: [{joint}]\n  push:")
    text = text.replace(
        "kind: box, disc: {centre: [0, 0], radius: 2}", "joint: b, slides: [1, 1.5]"
    )
    said = _core.Config.from_text(text, "joint").description
    assert "  the joint of 'b' is between 1 and 1.5 m\n" in said


def test_check_says_joints_and_goals_of_a_chain() -> None:
    config = _core.Config.from_file(paths.CONFIG / "art_manip.yaml")
    said = config.description.split("actions\n")[0].splitlines()
    assert said[said.index("joints") :] == [
        "joints",
        "  'link2' on 'link1', from -137 to 137 deg",
        "  'link3' on 'link2', from -137 to 137 deg",
        "  'link4' on 'link3', from -137 to 137 deg",
        "goal, all of",
        "  every joint has an angle from 75 to 105 deg",
        "  the mean centre of all 'link' lies within 1 m of (0, 3)",
    ]


@pytest.mark.parametrize(
    ("condition", "words"),
    [
        ("touching: box", "is at most 0.1 m away from another 'box'"),
        ("touching: wall", "is at most 0.1 m away from a 'wall'"),
        ('apart: "*"', "is at least 0.1 m away from every other object"),
        ("apart: wall", "is at least 0.1 m away from every 'wall'"),
    ],
)
def test_check_says_with_what_objects_are_compared(condition: str, words: str) -> None:
    wall = "    - {name: w, kind: wall, fixed: true, shape: {box: [6, 1]}, start: [0, 2.4, 0]}\n"
    text = TASK.replace("  goal:\n", wall + "  goal:\n")
    term = f"{condition}, gap: 0.1"
    near = "    - {kind: box, disc: {centre: [0, 0], radius: 2}}\n"
    text = text.replace(near, f"{near}    - {{kind: box, {term}}}\n")
    assert f"  every 'box' {words}\n" in _core.Config.from_text(text, "words").description


@pytest.mark.parametrize(
    ("normal", "offset", "words"),
    [
        ("[1, 0]", -2, "x <= -2 m"),
        ("[-1, 0]", -2, "x >= 2 m"),
        ("[0, 1]", -2, "y <= -2 m"),
        ("[0, -1]", -2, "y >= 2 m"),
        ("[-0.6, 0.8]", 1, "-0.6 x +0.8 y <= 1 m"),
    ],
)
def test_check_says_where_a_half_plane_lies(
    file: Path, normal: str, offset: int, words: str
) -> None:
    goal = f"task.goal=[{{kind: box, half_plane: {{normal: {normal}, offset: {offset}}}}}]"
    said = _core.Config.from_file(file, [goal]).description
    assert f"\n  the centre of every 'box' lies at {words}\n" in said


SORTING = {
    "robot": ("robot", [0.0, -6.5, 0.0]),
    "a1": ("a", [1.2, 3.0, 0.1]),
    "a2": ("a", [1.2, -1.0, -0.2]),
    "b1": ("b", [-1.2, 1.0, 0.2]),
    "b2": ("b", [-1.2, -3.0, 0.3]),
}
HARD = {**SORTING, "a3": ("a", [1.2, -5.0, 0.2]), "b3": ("b", [-1.2, 5.0, -0.1])}


@pytest.mark.parametrize(("name", "bodies"), [("sorting", SORTING), ("sorting_hard", HARD)])
def test_sorting_is_laid_out_in_two_columns(name: str, bodies: dict[str, object]) -> None:
    task = json.loads(_core.Config.from_file(paths.CONFIG / f"{name}.yaml").json)["task"]
    found = {body["name"]: (body["kind"], body["start"]) for body in task["bodies"]}
    assert list(found.items()) == list(bodies.items())
    assert task["goal"] == [
        {"kind": "a", "half_plane": {"normal": [1.0, 0.0], "offset": -2.0}},
        {"kind": "b", "half_plane": {"normal": [-1.0, 0.0], "offset": -2.0}},
    ]
    assert (task["discount"], task["randomisation"]) == (0.9, 1.0)


def test_json_holds_the_values_with_their_types(file: Path) -> None:
    config = json.loads(_core.Config.from_file(file, ["run.workers=3", "search.breadth=7"]).json)
    assert list(config) == ["task", "physics", "forward", "reverse", "search", "train", "run"]
    assert config["run"]["workers"] == 3
    assert config["run"]["in_process"] is False
    assert config["run"]["bus"] == "udpm://239.255.76.67:7667?ttl=0"
    assert config["search"]["breadth"] == 7
    assert config["task"]["bodies"][1] == {
        "name": "a",
        "kind": "box",
        "shape": {"box": [1.0, 1.0]},
        "density": 1.0,
        "friction": 0.3,
        "fixed": False,
        "start": [3.0, 0.0, 0.0],
    }
    assert config["task"]["goal"] == [
        {"kind": "box", "disc": {"centre": [0.0, 0.0], "radius": 2.0}}
    ]
