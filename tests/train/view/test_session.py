"""What a recording of a run holds, read back from its file."""

import os
import re

import numpy as np
import pytest

pytest.importorskip("rerun", reason="the extra view is not installed")

import rerun.chunk
from recordings import lines, read
from rtg.errors import RunError, UserError
from rtg.files import locks
from rtg.files.dataset import SOURCES
from rtg.pictures.draw import KIND_PALETTE, ROBOT, objects, outline
from rtg.view import view
from rtg.view.session import Session
from view_runs import GENERATION, LEARNING, PUSHES, TASK, episode, finished, generated

END = GENERATION + LEARNING[-1]


@pytest.fixture(scope="module")
def recorded(tmp_path_factory, rows):
    folder = tmp_path_factory.mktemp("view")
    file = folder / "run.rrd"
    view.save(finished(folder / "run", rows), file, lambda words: None)
    return read(file)


def colour(packed):
    return tuple(packed.to_bytes(4, "big")[:3])


def test_every_body_is_filled_with_the_colour_of_the_pictures(recorded):
    for body, name in enumerate(TASK.names):
        (mesh,) = (one for one in recorded[f"scene/bodies/{name}"] if one.time is None)
        shown = {colour(one) for one in mesh.values["vertex_colors"]}
        assert shown == {ROBOT if body == 0 else KIND_PALETTE[0]}
        (edge,) = recorded[f"scene/bodies/{name}/edge"]
        ring = np.array(edge.values["strips"][0])[:-1, :2]
        assert np.allclose(ring, TASK.outlines[body][0], atol=1e-5)


def test_the_best_episode_plays_at_the_end(recorded):
    moved = [one for one in recorded["scene/bodies/robot"] if one.time is not None]
    played = moved[-4 * PUSHES - 1 :]
    assert played[0].time >= END
    places = np.array([one.values["translation"][0] for one in played])
    assert np.allclose(places[::4, :2], episode()[:, 0, :2], atol=1e-5)
    assert recorded["caption"][-1].values["labels"] == ["best episode: success after 3 pushes"]


def test_plans_of_the_data_play_before(recorded):
    captions = [one.values["labels"][0] for one in recorded["caption"]]
    assert captions[0] == "nominal start"
    plans = [words for words in captions if words.startswith("plan of the data, ")]
    assert len(plans) > 2 and plans[0] == "plan of the data, 2 pushes"


def test_the_trees_hold_each_move_of_a_step_once(recorded, rows):
    steps = rows.source == SOURCES.index("tree")
    for body in objects(TASK):
        before, after = (poses[steps, body, :2] for poses in (rows.poses, rows.next_poses))
        moved = np.linalg.norm(after - before, axis=1) > 0.05
        expected = np.concatenate([before, after], axis=1)[moved]
        shown = lines(recorded[f"trees/{TASK.names[body]}"])[:, :, :2].reshape(-1, 4)
        assert len(expected) > 20
        assert np.allclose(*(np.sort(one, axis=0) for one in (expected, shown)), atol=1e-5)


def test_the_trees_grow_while_the_run_generates(recorded):
    times = [one.time for one in recorded["trees/box1"]]
    assert len(times) > 10 and times[0] < 0.3 * GENERATION and times[-1] <= GENERATION


def test_deep_steps_have_other_colours_and_lie_higher(recorded):
    heights = {}
    for one in recorded["trees/box1"]:
        strips, colours = one.values["strips"], one.values["colors"]
        for strip, packed in zip(strips, colours, strict=True):
            heights.setdefault(colour(packed), set()).add(round(strip[0][2], 4))
    assert (68, 1, 84) in heights  # the first colour of viridis: one step to success
    assert len(heights) > 3 and all(len(found) == 1 for found in heights.values())
    assert min(heights.values()) == heights[68, 1, 84]


def test_the_learning_curve_is_that_of_the_file(recorded):
    greedy = [one for one in recorded["learning/success_rate"] if one.time is not None]
    assert [one.time for one in greedy] == pytest.approx([GENERATION + t for t in LEARNING])
    assert [one.values["scalars"] for one in greedy] == [[0.4], [0.8]]
    rollouts = [one.values.get("scalars") for one in recorded["learning/rollout_success"]]
    assert rollouts[-2:] == [[0.3], [0.6]]


def test_the_learning_curve_has_a_time_line_of_interactions(tmp_path, rows):
    file = tmp_path / "run.rrd"
    view.save(finished(tmp_path / "run", rows), file, lambda words: None)
    chunks = [c for c in rerun.chunk.RrdReader(file).stream().to_chunks() if not c.is_static]
    lines = {chunk.entity_path: set(chunk.timeline_names) for chunk in chunks}
    assert lines["/learning/success_rate"] == {"time", "interactions"}
    assert {path for path, names in lines.items() if names != {"time"}} == {
        "/learning/success_rate",
        "/learning/rollout_success",
    }


def test_the_histogram_counts_all_gaps(recorded):
    last = recorded["replay_gap"][-1].values
    counts, centres = (np.array(last[name][0]["buffer"]) for name in ("values", "abscissa"))
    assert counts.sum() == 100
    assert centres[counts > 0].min() > -3.1 and centres[counts > 0].max() < -0.9


def test_the_state_is_told_in_words(recorded):
    words = recorded["state"][-1].values["text"][0]
    assert "2,000 transitions, 400 of them steps" in words
    assert (
        "replay gap: median 0.01, 90 % below 0.063 [m, where the robot's radius is 0.8 m]" in words
    )
    assert "200 interactions, success 0.80" in words


def test_the_start_of_each_object_is_marked_in_its_panel(recorded):
    (edge,) = recorded["start/box2"]
    ring = np.array(edge.values["strips"][0])[:-1, :2]
    assert np.allclose(ring, outline(TASK.outlines[2][0], TASK.start[2]), atol=1e-5)


def test_a_run_that_goes_on_is_followed(tmp_path, rows):
    folder, file = tmp_path / "run", tmp_path / "run.rrd"
    generated(folder, rows)
    session = Session(folder, lambda words: None)
    session.recording.save(file)
    session.begin(follow=True)
    session.step()
    assert session.is_going_on() and not session.is_over()
    learned = finished(tmp_path / "learned", rows)
    for name in ("progress.csv", "best_episode.npz", "training.json", "summary.json"):
        (learned / name).rename(folder / name)
    assert session.is_over() and not session.is_going_on()
    session.finish()
    session.close()
    found = read(file)
    assert len(lines(found["trees/box1"])) > 20
    assert found["learning/success_rate"][-1].values["scalars"] == [0.8]
    assert found["caption"][-1].values["labels"] == ["best episode: success after 3 pushes"]
    assert found["scene/bodies/box1"][-1].values["translation"][0][:2] == pytest.approx(
        episode()[-1, 1, :2].tolist(), abs=1e-5
    )


def test_of_a_run_that_was_stopped_the_recording_holds_what_is_there(tmp_path, rows):
    folder, file, said = generated(tmp_path / "run", rows), tmp_path / "run.rrd", []
    with locks.exclusive_lock(folder, "the run that stops"):
        pass
    view.save(folder, file, said.append)
    assert said == [
        f"{folder}: the run was not finished (it has no summary.json); this is what is there",
        f"recording: {file}",
    ]
    found = read(file)
    assert len(lines(found["trees/box1"])) > 20
    captions = [one.values["labels"][0] for one in found["caption"]]
    assert any(words.startswith("plan of the data, ") for words in captions)
    assert not any(words.startswith("best episode") for words in captions)


def test_of_a_run_that_holds_no_lock_it_is_only_said_that_there_is_no_news(tmp_path, rows):
    folder, said = generated(tmp_path / "run", rows), []
    for file in folder.iterdir():
        os.utime(file, (1e6, 1e6))
    view.save(folder, tmp_path / "run.rrd", said.append)
    assert re.fullmatch(
        rf"{folder}: no news for \d+ s, and no lock tells whether the run goes on; this is what is "
        "there",
        said[-2],
    )


def test_a_run_that_is_stopped_while_it_is_recorded_ends_the_recording(tmp_path, rows, monkeypatch):
    folder, said, steps = generated(tmp_path / "run", rows), [], []
    held = locks.try_lock(locks.of_run(folder)[0])
    one_step = Session.step

    def step(session):
        one_step(session)
        steps.append(session.is_going_on())
        held.release()

    monkeypatch.setattr(Session, "step", step)
    view.save(folder, tmp_path / "run.rrd", said.append)
    assert steps == [True]
    assert said[-2].startswith(f"{folder}: the run was not finished")


def test_a_folder_of_no_run_is_refused(tmp_path):
    with pytest.raises(UserError, match=r"has no config\.yaml; legal: the folder of a run"):
        Session(tmp_path, lambda words: None)


@pytest.mark.parametrize(
    ("file", "why"),
    [
        ("run.png", "its name does not end in .rrd; legal: FILE.rrd"),
        ("none/run.rrd", "there is no folder TMP/none; legal: FILE.rrd in a folder that exists"),
        ("folder.rrd", "is a folder; legal: FILE.rrd"),
        ("run/config.yaml/run.rrd", "there is no folder TMP/run/config.yaml; legal: FILE.rrd in a"),
        ("/proc/run.rrd", "cannot be written: No such file or directory; legal: a file that can"),
    ],
)
def test_a_recording_needs_a_fitting_name_in_a_folder(tmp_path, rows, file, why):
    (tmp_path / "folder.rrd").mkdir()
    with pytest.raises(UserError) as told:
        view.save(finished(tmp_path / "run", rows), tmp_path / file, lambda words: None)
    expected = f"--save {tmp_path / file}: {why.replace('TMP', str(tmp_path))}"
    assert str(told.value).startswith(expected)


def test_a_recording_that_cannot_be_written_whole_leaves_the_one_before(
    tmp_path, rows, monkeypatch
):
    file = tmp_path / "run.rrd"
    file.write_bytes(b"before")

    def fail(_):
        raise RuntimeError("the writer has ended")

    monkeypatch.setattr(Session, "finish", fail)
    with pytest.raises(RunError, match=f"^--save {file}: the writer has ended"):
        view.save(finished(tmp_path / "run", rows), file, lambda words: None)
    assert file.read_bytes() == b"before"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run", "run.rrd"]
