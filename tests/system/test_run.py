"""The whole command as the user types it, on a configuration that takes seconds."""

import json
import os
import re
import signal
import subprocess
import sys

import network
import numpy as np
import pytest
from living import processes_of, wait_until_all_are_gone
from PIL import Image
from rtg import paths
from rtg.files import dataset
from rtg.files.run_folder import SUMMARY_KEYS

TINY = "config/tests/tiny.yaml"
WHOLE = (TINY,)
NETWORK = paths.ROOT / "tests" / "support" / "private_network.sh"
ENDLESS = (TINY, "--transitions", "20000000", "--set", "train.buffer=20000000")
LONG = (TINY, "--no-train", "--transitions", "20000", "--workers", "1")
PATIENCE = 300.0  # [s]; longer is a hang
COMMON_FILES = {
    "config.yaml",
    "versions.json",
    "summary.json",
    "generation.json",
    "transitions.npz",
    "replay_gap.png",
    "coverage.png",
    "episode.png",
    "episode.gif",
}
TRAINING_FILES = {"progress.csv", "learning_curve.png", "training.json", "model.pt", "stages.png"}


@pytest.fixture(scope="module", autouse=True)
def private_network():
    network.require()


def start(*words):
    return subprocess.Popen(
        [NETWORK, sys.executable, "-m", "rtg.cli", *map(str, words)],
        cwd=paths.ROOT,
        env={**os.environ, "PYTHONPATH": str(paths.ROOT / "train")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def run(*words):
    process = start(*words)
    out, err = process.communicate(timeout=PATIENCE)
    return subprocess.CompletedProcess(words, process.returncode, out, err)


@pytest.fixture(scope="module")
def in_process(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run") / "in_process"
    return folder, run(*WHOLE, "--in-process", "--out", folder)


@pytest.fixture(scope="module")
def over_lcm(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run") / "over_lcm"
    return folder, run(*WHOLE, "--out", folder, "--set", "run.record=true")


@pytest.fixture(params=["in_process", "over_lcm"])
def whole_run(request):
    return request.getfixturevalue(request.param)


def test_a_page_names_everything_in_a_run_folder(whole_run):
    page = (paths.ROOT / "docs" / "run_folder.md").read_text()
    folder, done = whole_run
    assert done.returncode == 0, done.stderr
    names = {path.name + "/" * path.is_dir() for path in folder.iterdir()}
    assert {name for name in names if f"`{name}`" not in page} == set()


def test_a_run_ends_well_and_leaves_every_file(whole_run):
    folder, done = whole_run
    assert done.returncode == 0, done.stderr
    found = {path.name for path in folder.iterdir() if path.stat().st_size > 0}
    assert found >= COMMON_FILES | TRAINING_FILES
    assert "Traceback" not in "".join(log.read_text() for log in (folder / "logs").iterdir())


def test_the_output_of_a_piped_run_is_plain_lines(whole_run):
    folder, done = whole_run
    assert "\x1b" not in done.stdout and "\r" not in done.stdout
    assert done.stderr == ""
    lines = done.stdout.splitlines()
    stamped = [re.match(r"\[ *\d+\.\d s\] ", line) is not None for line in lines]
    last_words = stamped.index(False)
    assert last_words > 0 and not any(stamped[last_words:])
    assert lines[last_words].startswith("2,000 transitions in ")
    assert lines[-1] == f"results: {folder}"


def test_the_summary_is_whole_and_agrees_with_the_files(whole_run):
    folder, _ = whole_run
    summary = json.loads((folder / "summary.json").read_text())
    unknown = [key for key in SUMMARY_KEYS if summary[key] is None]
    assert unknown == ["start_depth"]  # the trees of so few transitions reach no start
    data = dataset.read(folder / "transitions.npz")
    assert summary["transitions"] == len(data.action) == 2000
    moved = np.abs(data.next_poses - data.poses)[:, 1:, :2]
    moved = np.hypot(moved[..., 0], moved[..., 1]) > 0.05
    assert summary["contact_share"] == pytest.approx(moved.any(axis=1).mean(), abs=1e-3)
    assert summary["multi_body_share"] == pytest.approx((moved.sum(axis=1) > 1).mean(), abs=1e-3)
    assert summary["interactions"] == 400


def test_every_key_of_a_summary_is_explained(whole_run):
    page = (paths.ROOT / "train/SUMMARY.md").read_text()
    summary = json.loads((whole_run[0] / "summary.json").read_text())
    assert [key for key in summary if f"`{key}`" not in page] == []


def test_the_pictures_are_pictures(whole_run):
    folder, _ = whole_run
    for name in ("replay_gap.png", "coverage.png", "learning_curve.png", "episode.png"):
        with Image.open(folder / name) as picture:
            assert len(picture.convert("RGB").getcolors(1 << 24)) > 50, name
    with Image.open(folder / "episode.gif") as film:
        assert film.n_frames > 60


def test_the_process_graph_and_one_process_store_the_same_bytes(in_process, over_lcm):
    one, many = (folder / "transitions.npz" for folder, _ in (in_process, over_lcm))
    assert one.read_bytes() == many.read_bytes()


def test_a_run_is_recorded_when_asked(over_lcm):
    log = (over_lcm[0] / "lcm.log").read_bytes()
    for channel in (b"RTG_TRANSITION", b"RTG_REVERSE_JOB", b"RTG_PROGRESS", b"RTG_STATUS"):
        assert channel in log


def test_the_written_configuration_makes_the_same_run(in_process, tmp_path):
    folder, _ = in_process
    again = tmp_path / "again"
    done = run(folder / "config.yaml", "--no-train", "--out", again)
    assert done.returncode == 0, done.stderr
    assert (again / "config.yaml").read_text() == (folder / "config.yaml").read_text()
    with np.load(again / "best_episode.npz") as best:  # of the data
        assert len(best["poses"]) > 1
        assert best["success"]
    assert (again / "transitions.npz").read_bytes() == (folder / "transitions.npz").read_bytes()
    assert {path.name for path in again.iterdir()} >= COMMON_FILES


@pytest.mark.parametrize("mode", [(), ("--in-process",)], ids=["over_lcm", "in_process"])
def test_a_search_that_falls_short_has_results_and_says_so_once(tmp_path, mode):
    folder = tmp_path / "run"
    keys = ("depth", "breadth", "plans_per_node")
    short = [word for key in keys for word in ("--set", f"search.{key}=1")]
    done = run(TINY, *short, "--no-train", *mode, "--out", folder)
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    assert re.match(r"rtg: the search \(naive\) found \d+ transitions of the 2000 asked for ", line)
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["defects"] == [line.removeprefix("rtg: ")]


def kill(folder, program):
    """Sends SIGKILL to the processes of a run whose words contain `program`; there must be one."""
    victims = [pid for pid, words in processes_of(folder).items() if program in words]
    assert victims
    for pid in victims:
        os.kill(pid, signal.SIGKILL)


def wait_for_line(process, words):
    for line in process.stdout:
        if words in line:
            return
    pytest.fail(f"the run ended without saying '{words}': {process.stderr.read()}")


@pytest.mark.parametrize(
    "mode", [(), ("--in-process", "--no-train")], ids=["over_lcm", "in_process"]
)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_a_run_and_all_of_its_processes(tmp_path, mode, number):
    folder = tmp_path / "run"
    process = start(*ENDLESS, *mode, "--out", folder)
    wait_for_line(process, ", layer ")
    process.send_signal(number)
    _, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 1
    flags = "--resume --no-train" if mode else "--resume"
    assert err == f"rtg: stopped; to go on: ./run.sh {flags} --out {folder}\n"
    assert processes_of(folder) == {}


def test_killing_the_command_kills_all_of_its_processes(tmp_path):
    folder = tmp_path / "run"
    process = start(*ENDLESS, "--out", folder)
    wait_for_line(process, ", layer ")
    # the command, graph.sh, server, two workers, coordinator, trainer
    assert len(processes_of(folder)) == 7
    process.kill()
    process.communicate(timeout=PATIENCE)
    wait_until_all_are_gone(folder, PATIENCE)


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """Returns the transitions of LONG."""
    folder = tmp_path_factory.mktemp("run") / "undisturbed"
    assert run(*LONG, "--in-process", "--out", folder).returncode == 0
    return (folder / "transitions.npz").read_bytes()


@pytest.mark.parametrize(
    ("program", "name", "key", "counts"),
    [
        ("rtg_reverse_worker", "reverse_worker_0", "worker_restarts", lambda count: count == 1),
        ("rtg_beam_coordinator", "beam_coordinator", "units_from_journal", lambda count: count > 0),
    ],
    ids=["worker", "coordinator"],
)
def test_a_killed_program_is_started_again_and_changes_nothing(
    tmp_path, undisturbed, program, name, key, counts
):
    folder = tmp_path / "disturbed"
    process = start(*LONG, "--out", folder)
    wait_for_line(process, ", layer ")
    kill(folder, program)
    out, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, err
    assert f"{name} was killed by SIGKILL, started again" in out
    assert counts(json.loads((folder / "summary.json").read_text())[key])
    assert (folder / "transitions.npz").read_bytes() == undisturbed


@pytest.mark.parametrize("mode", [(), ("--in-process",)], ids=["over_lcm", "in_process"])
def test_a_generation_killed_with_its_command_goes_on(tmp_path, undisturbed, mode):
    folder = tmp_path / "disturbed"
    process = start(*LONG, *mode, "--out", folder)
    wait_for_line(process, ", layer ")
    for pid in processes_of(folder):
        os.kill(pid, signal.SIGKILL)
    process.communicate(timeout=PATIENCE)
    wait_until_all_are_gone(folder, PATIENCE)
    done = run("--resume", "--no-train", "--out", folder)
    assert done.returncode == 0, done.stderr
    assert json.loads((folder / "summary.json").read_text())["units_from_journal"] > 0
    assert (folder / "transitions.npz").read_bytes() == undisturbed
    assert not (folder / "generation.journal").exists()


def test_without_trainer_the_run_ends(tmp_path):
    folder = tmp_path / "run"
    process = start(*ENDLESS, "--out", folder)
    wait_for_line(process, ", layer ")
    kill(folder, "rtg.learn.trainer")
    _, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 1
    assert "was killed by SIGKILL" in err.splitlines()[0]
    assert processes_of(folder) == {}


def test_a_stopped_run_goes_on_where_it_was(in_process, tmp_path):
    folder = tmp_path / "run"
    process = start(*WHOLE, "--in-process", "--out", folder)
    wait_for_line(process, "interactions")
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 1, err
    done = run("--resume", "--out", folder)
    assert done.returncode == 0, done.stderr
    assert "the transitions are there already" in done.stdout
    assert best_episode(folder).tolist() == best_episode(in_process[0]).tolist()
    again = run("--resume", "--out", folder)
    assert again.returncode == 0, again.stderr
    assert "nothing is left to learn: " in again.stdout


def best_episode(folder):
    with np.load(folder / "best_episode.npz") as file:
        return file["poses"]
