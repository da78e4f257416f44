"""A run that goes on, as its bus and its folder tell it."""

import itertools
import os
import time

import numpy as np
import pytest

pytest.importorskip("rerun", reason="the extra view is not installed")

import rerun as rr
from recordings import lines, read
from rtg import _core
from rtg.bus.bus import open_bus
from rtg.bus.node_status import NodeStatus
from rtg.view import follower
from rtg.view.follower import Follower, Heard, why_unheard
from rtg.view.run_events import RunEvents
from rtg.view.run_view import RunView
from training_runs import TINY, run_folder
from view_runs import GENERATION, TASK, generated


def publish(bus, rows, first):
    bus.publish(
        "RTG_TRANSITION",
        "transition_batch_t",
        first=first,
        poses=rows.poses.ravel(),
        next_poses=rows.next_poses.ravel(),
        action=rows.action,
        success=rows.terminated.astype(np.int8),
        source=rows.source,
    )


def tell_progress(bus):
    bus.publish("RTG_PROGRESS", "search_progress_t", phase="tree 2", layer=5, depth=10)


@pytest.fixture
def bus():
    return open_bus("memq://", _core.RunKey.random("a run"))


def follow(folder, bus, file):
    config = _core.Config.from_file(folder / "config.yaml")
    recording = rr.RecordingStream("rtg")
    recording.save(file)
    view = RunView(recording, config, push=0.5)
    following = Follower(folder, view, RunEvents(folder, config), Heard(bus, config))
    return following, recording


def moves(rows, body=2):
    ends = np.concatenate([rows.poses[:, body, :2], rows.next_poses[:, body, :2]], axis=1)
    moved = np.linalg.norm(ends[:, 2:] - ends[:, :2], axis=1) > 0.05
    return ends[(rows.source == 0) & moved]


def test_a_run_is_alive_as_long_as_a_process_tells_its_status(bus, monkeypatch):
    heard = Heard(bus, _core.Config.from_file(TINY))
    NodeStatus(bus, "reverse_worker").tick("solving", 3)
    assert heard.is_alive() and heard.is_alive()
    clock = itertools.count(time.monotonic() + 10.0)  # a second between two looks
    monkeypatch.setattr("rtg.view.follower.time.monotonic", lambda: next(clock))
    assert not heard.is_alive()


@pytest.mark.filterwarnings("ignore:RRD file has no footer")  # read before it is complete
def test_steps_show_as_they_are_heard_and_the_rest_when_the_file_is_there(tmp_path, rows, bus):
    folder = run_folder(tmp_path / "run", None)
    following, recording = follow(folder, bus, tmp_path / "run.rrd")
    for first in (0, 200, 0):  # the same rows again, and those up to 600 get lost
        publish(bus, rows.slice(first, first + 200), first)
    publish(bus, rows.slice(600, 800), 600)
    tell_progress(bus)
    following.step()
    recording.flush()
    early = lines(read(tmp_path / "run.rrd")["trees/box2"])
    assert 0 < len(early) < len(moves(rows.slice(0, 800)))
    whole = generated(tmp_path / "whole", rows)
    for name in ("generation.json", "transitions.npz"):
        os.rename(whole / name, folder / name)
    following.finish()
    recording.flush()
    recording.disconnect()
    found = read(tmp_path / "run.rrd")
    shown = lines(found["trees/box2"])[:, :, :2].reshape(-1, 4)
    assert np.allclose(np.sort(shown, axis=0), np.sort(moves(rows), axis=0), atol=1e-5)
    words = [one.values["text"][0] for one in found["state"]]
    assert any("tree 2, layer 5/10" in text and "600 transitions" in text for text in words)
    assert "2,000 transitions" in words[-1]


def test_the_time_is_that_since_the_run_began(tmp_path, bus):
    folder = run_folder(tmp_path / "run", None)
    before = os.stat(folder / "config.yaml").st_mtime - 100.0
    os.utime(folder / "config.yaml", (before, before))
    following, _ = follow(folder, bus, tmp_path / "run.rrd")
    assert 100.0 <= following.now() < 200.0


def test_the_clock_of_a_run_stopped_long_ago_begins_where_its_files_end(tmp_path, rows, bus):
    folder = generated(tmp_path / "run", rows)
    os.utime(folder / "config.yaml", (1e6, 1e6))
    following, _ = follow(folder, bus, tmp_path / "run.rrd")
    assert GENERATION <= following.now() < GENERATION + 60.0


def test_a_run_is_heard_only_while_it_generates_over_lcm(tmp_path, rows, monkeypatch):
    monkeypatch.setattr(follower, "defect", lambda url: None)

    def why(folder):
        return why_unheard(folder, _core.Config.from_file(folder / "config.yaml"))

    assert why(run_folder(tmp_path / "lcm", None)) is None
    assert why(run_folder(tmp_path / "stored", rows)) == "its transitions are in the folder"
    alone = run_folder(tmp_path / "alone", None, "run.in_process=true")
    assert why(alone).startswith("with --in-process its transitions are seen once all are")
    none = run_folder(tmp_path / "none", None, "run.method=ddqn")
    assert why(none) == "it generates no transitions"
    monkeypatch.setattr(follower, "defect", lambda url: "no route")
    assert why(tmp_path / "lcm").endswith("seen once all are found: no route")


def test_a_run_without_transitions_shows_scene_and_learning(tmp_path, bus):
    folder = run_folder(tmp_path / "run", None, "run.method=ddqn")
    following, recording = follow(folder, bus, tmp_path / "run.rrd")
    following.finish()
    recording.flush()
    recording.disconnect()
    found = read(tmp_path / "run.rrd")
    assert {f"scene/bodies/{name}" for name in TASK.names} <= set(found)
    assert not any(path.startswith(("trees", "legend")) for path in found)
