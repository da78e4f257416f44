"""Exit status and words of the command, as the user meets them."""

import os
import sys

import numpy as np
import pytest
from PIL import Image
from rtg import cli, paths
from time_limit import run

MISTAKES = {
    "unknown task": (
        ["sortign"],
        "sortign: no task of that name (did you mean 'sorting'?); legal: art_manip, ",
    ),
    "unknown tool": (
        ["reprodcue", "gathering"],
        "reprodcue: no task of that name (did you mean 'reproduce'?); legal: art_manip, ",
    ),
    "unknown flag": (
        ["--wokers", "2"],
        "unrecognized arguments: --wokers; legal: ./run.sh [-h] [--in-proc",
    ),
    "missing file": (
        ["mine.yaml"],
        "mine.yaml: no such task file; legal: art_manip, art_manip_hard, cable, ",
    ),
    "workers no number": (["--workers", "two"], "--workers two: "),
    "workers negative": (["--workers", "-1"], "--workers"),
    "too many workers": (["--workers", "5000"], "--workers 5000: "),
    "generator": (["--generator", "magic"], "--generator magic: "),
    "seed": (["--seed", "1.5"], "--seed 1.5: "),
    "no transitions": (["--transitions", "0"], "--transitions 0: "),
    "no interactions": (["--interactions", "0"], "--interactions 0: "),
    "unknown key": (["--set", "search.bredth=3"], "--set search.bredth=3: "),
    "no key": (["--set", "search.breadth"], "--set search.breadth: "),
    "out of range": (["--set", "search.breadth=0"], "--set search.breadth=0: "),
    "small buffer": (
        ["--set", "train.buffer=5"],
        "--set train.buffer=5: key 'train.buffer': 5 is too small for search.tr",
    ),
    "folder of another kind": (["--out", "/proc/rtg", "--in-process"], "--out: /proc/rtg: "),
    "resume without folder": (["--resume"], "--resume: --out is missing"),
    "check without file": (["check"], "the following arguments are required: FILE.yaml; legal: "),
    "check of two": (
        ["check", "a", "b"],
        "unrecognized arguments: b; legal: ./run.sh check [-h] [",
    ),
    "picture of no known format": (
        ["check", "gathering", "--picture", "a.b"],
        "--picture: a.b: has no known ending; legal: .png, .jpg, .pdf, .svg, .gif",
    ),
    "picture in no folder": (
        ["check", "gathering", "--picture", "/none/a.png"],
        "--picture: /none/a.png: No such file or directory; legal: a file that can be written",
    ),
    "check of a wrong value": (
        ["check", "gathering", "--set", "search.breadth=0"],
        "--set search.breadth=0: key 'search.breadth': 0 is out of range; legal: ",
    ),
    "half a flag of spy": (
        ["spy", "--sec", "1"],
        "unrecognized arguments: --sec; legal: ./run.sh s",
    ),
    "flag of lcm-spy": (["lcm-spy", "-x"], "unrecognized arguments: -x; legal: ./run.sh lcm-spy ["),
    "spy for no time": (["spy", "--seconds", "0"], "--seconds 0: not a legal duration; legal: "),
    "reproduce of nothing": (
        ["reproduce", "sortign"],
        "sortign: no task of that name (did you mean 'sorting'?); legal: art_",
    ),
    "method of a run": (
        ["--method", "ddqn_rgt"],
        "--method ddqn_rgt: key 'run.method': 'ddqn_rgt' is not one of the legal values (did you "
        "mean 'ddqn_rtg'?); legal: dqn, ",
    ),
    "misspelt method": (
        ["reproduce", "--methods", "ddqn_rgt"],
        "--methods ddqn_rgt: no method of that name (did you mean 'ddqn_rtg'?); legal: ",
    ),
    "method": (
        ["reproduce", "--methods", "magic"],
        "--methods magic: no method of that name; legal",
    ),
    "swept value": (
        ["reproduce", "--sweep", "train.offline_share=0.5,9", "--out", "/proc/rtg"],
        "--sweep train.offline_share=9: key 'train.offline_share': 9 is out of range; legal: ",
    ),
    "plot of nothing": (
        ["plot", "tests"],
        "tests: holds neither a comparison (grid.json) nor a run (config.yaml); legal: ",
    ),
    "spy on nothing": (["spy", "sortign"], "sortign: no task of that name"),
    "spy on a folder": (["spy", "tests"], "tests: has no config.yaml; legal: the folder of a run"),
    "plot of no folder": (["plot", "none"], "none: no such folder; legal: the folder of a run"),
    "view of no folder": (["view", "none"], "none: no such folder; legal: the folder of a run"),
    "view of a file": (["view", "run.sh"], "run.sh: is not a folder; legal: the folder of a run"),
    "evaluate of no folder": (
        ["evaluate", "none"],
        "none: no such folder; legal: the folder of a run",
    ),
    "evaluate of no run": (
        ["evaluate", "tests"],
        "tests: has no config.yaml; legal: the folder of a run",
    ),
}


def rtg(*words, **environment):
    env = {**os.environ, "PYTHONPATH": str(paths.ROOT / "train"), **environment}
    return run(sys.executable, "-m", "rtg", *words, cwd=paths.ROOT, env=env)


def test_output_that_nobody_reads_ends_quietly_with_status_1():
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, "-m", "rtg", "--print-config"]
    done = run(*command, cwd=paths.ROOT, stdout=writer)
    os.close(writer)
    assert (done.returncode, done.stderr) == (1, "")


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_named_and_ends_with_status_2(name):
    words, message = MISTAKES[name]
    done = rtg(*words)
    assert done.stderr.startswith(f"rtg: {message}"), done.stderr
    assert done.stderr.count("\n") <= 3, "more than the user needs"
    assert done.returncode == 2
    assert done.stdout == ""


def test_text_that_is_no_utf8_is_a_mistake(tmp_path):
    file = tmp_path / "latin.yaml"
    file.write_bytes("task: gathering  # größer\n".encode("latin-1"))
    for words, shown in {
        ("check", file): f"{file}:1",
        ("--set", b"task.name=gr\xf6\xdfer"): "task.name=gr\\xf6\\xdfer",
        ("--out", b"runs/\xff"): "runs/\\xff",
    }.items():
        done = rtg(*words)
        assert done.stderr == f"rtg: {shown}: has a byte that is not UTF-8; legal: text in UTF-8\n"
        assert (done.returncode, done.stdout) == (2, "")


@pytest.mark.parametrize("task", ["push_t", "gate", "pack"])
def test_a_task_is_drawn_with_starts_and_goal_states(tmp_path, task):
    done = rtg("check", task, "--picture", tmp_path / "task.png")
    assert (done.returncode, done.stderr) == (0, "")
    picture = np.asarray(Image.open(tmp_path / "task.png"))
    assert picture.shape[1] == 4 * 302 - 2 and picture.shape[0] > 2 * 300
    start, goal = picture[-602:-302, :300], picture[-300:, :300]
    assert start.std() > 5 and not np.array_equal(start, goal)


def test_help_names_every_flag_of_the_contract():
    done = rtg("--help")
    assert done.returncode == 0
    for flag in ("--in-process", "--workers", "--generator", "--transitions", "--interactions"):
        assert flag in done.stdout
    for flag in ("--no-train", "--seed", "--out", "--set", "--print-config", "--resume"):
        assert flag in done.stdout


def test_spy_names_the_remedy_where_nothing_can_be_heard():
    """It runs in a network with no device that is up."""
    program = [sys.executable, "-m", "rtg", "spy", "--seconds", "1"]
    done = run("unshare", "--map-root-user", "--net", *program)
    if "unshare" in done.stderr:
        pytest.skip("this machine forbids network namespaces")
    assert done.returncode == 1 and done.stdout == ""
    assert done.stderr == (
        "rtg: nothing to be heard: multicast group 239.255.76.67 cannot be joined: "
        "No such device. To mend it: "
        "sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo\n"
    )


@pytest.mark.parametrize("tool", ["run", "check", "spy", "lcm-spy", "reproduce", "plot", "view"])
def test_every_tool_has_help(tool):
    done = rtg(tool, "--help")
    assert done.returncode == 0 and done.stderr == ""
    assert done.stdout.startswith(f"usage: ./run.sh {'' if tool == 'run' else tool + ' '}[-h]")


def test_help_does_not_wait_for_heavy_imports():
    program = (
        "import sys; from rtg import cli\n"
        "try: cli.main(['--help'])\n"
        "except SystemExit: pass\n"
        "print(sorted({'torch', 'matplotlib', 'textual', 'rerun', 'lcm'} & set(sys.modules)))"
    )
    done = run(sys.executable, "-c", program, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_a_tool_whose_extra_is_missing_names_it(monkeypatch, capsys, tmp_path):
    (tmp_path / "config.yaml").touch()
    for tool, module in (("spy", "textual"), ("view", "rerun")):
        monkeypatch.setitem(sys.modules, module, None)
        assert cli.main([tool] if tool == "spy" else [tool, str(tmp_path)]) == 2
        error = capsys.readouterr().err
        assert error.startswith(f"rtg: {tool} needs the Python package {module}, which is not")


def test_print_config_reads_back_to_itself(tmp_path):
    first = rtg("--seed", "7", "--set", "search.breadth=9", "--print-config")
    assert first.returncode == 0, first.stderr
    assert "seed: 7" in first.stdout and "breadth: 9" in first.stdout
    file = tmp_path / "again.yaml"
    file.write_text(first.stdout)
    assert rtg(str(file), "--print-config").stdout == first.stdout


def test_check_prints_what_it_understood_and_refuses_a_wrong_file(tmp_path):
    good = rtg("check", "config/gathering.yaml")
    assert good.returncode == 0
    assert good.stdout.startswith("config/gathering.yaml: legal\ntask gathering\n")
    changed = rtg("check", "gathering", "--set", "task.horizon=71")
    assert changed.returncode == 0 and "71 pushes" in changed.stdout
    file = tmp_path / "wrong.yaml"
    file.write_text("task: gathering\nsaerch: {}\n")
    bad = rtg("check", str(file))
    assert bad.returncode == 2 and f"{file}:" in bad.stderr


def test_lcm_spy_names_the_remedy_where_it_cannot_be_shown():
    done = rtg("lcm-spy", DISPLAY="")
    assert done.returncode == 1
    assert "./run.sh spy" in done.stderr
