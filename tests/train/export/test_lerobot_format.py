"""LeRobot's data sets: tables, films and metadata, against the episodes and the format's rules."""

import json
from pathlib import Path

import numpy as np
import pytest
from exported import run_folder
from rtg.cli import main
from rtg.errors import UserError
from rtg.export import lerobot_format, run_data
from rtg.pictures.draw import state_image

av = pytest.importorskip("av", reason="the extra `lerobot` is not installed")
pandas = pytest.importorskip("pandas", reason="the extra `lerobot` is not installed")
parquet = pytest.importorskip("pyarrow.parquet", reason="the extra `lerobot` is not installed")

EPISODES = 6
FILE = "chunk-000/file-000"
IMAGES = "observation.images.scene"


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    return run_data.read(run_folder(tmp_path_factory.mktemp("runs") / "run"))


@pytest.fixture(scope="module")
def folder(data, tmp_path_factory):
    path = tmp_path_factory.mktemp("lerobot") / "out"
    lerobot_format.write(data, path, EPISODES)
    return path


@pytest.fixture(scope="module")
def episodes(data):
    return run_data.plans(data, EPISODES)


@pytest.fixture(scope="module")
def info(folder):
    return json.loads((folder / "meta" / "info.json").read_text())


def test_a_frame_is_a_state_and_the_push_from_there(data, folder, episodes):
    table = parquet.read_table(folder / "data" / f"{FILE}.parquet").to_pydict()
    states = np.concatenate([episode.poses[:-1] for episode in episodes])
    actions = np.concatenate([episode.action for episode in episodes])
    observations = data.config.task.observation(states)
    assert np.array_equal(np.array(table["observation.state"], np.float32), observations)
    assert table["push"] == actions.tolist()
    angles = 2.0 * np.pi * actions / data.config.task.headings
    ways = 2.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)  # [m]
    np.testing.assert_allclose(table["action"], ways, atol=1e-6)
    lengths = [len(episode.action) for episode in episodes]
    frames = np.concatenate([np.arange(length) for length in lengths])
    assert table["frame_index"] == frames.tolist()
    assert table["timestamp"] == (frames / 4).tolist()
    assert table["episode_index"] == np.repeat(np.arange(EPISODES), lengths).tolist()
    assert table["index"] == list(range(sum(lengths)))
    ends = np.cumsum(lengths) - 1
    assert np.flatnonzero(table["next.done"]).tolist() == ends.tolist()
    succeed = ends[[episode.success for episode in episodes]].tolist()
    assert np.flatnonzero(table["next.success"]).tolist() == succeed
    assert np.flatnonzero(table["next.reward"]).tolist() == succeed and succeed


def test_columns_have_the_types_that_the_metadata_promise(folder, info):
    schema = parquet.read_schema(folder / "data" / f"{FILE}.parquet")
    features = {name: f for name, f in info["features"].items() if f["dtype"] != "video"}
    assert schema.names == list(features)
    for name, feature in features.items():
        kind, (size,) = schema.field(name).type, feature["shape"]
        scalar = {"float32": "float", "bool": "bool", "int64": "int64"}[feature["dtype"]]
        expected = scalar if size == 1 else f"fixed_size_list<item: {scalar}>[{size}]"
        assert str(kind).replace("element:", "item:") == expected
        assert feature["names"] is None or len(feature["names"]) == size
        assert "/" not in name


def test_the_film_shows_the_state_of_each_frame(data, folder, episodes, info):
    states = np.concatenate([episode.poses[:-1] for episode in episodes])
    with av.open(str(folder / "videos" / IMAGES / f"{FILE}.mp4")) as film:
        frames = [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]
    assert len(frames) == len(states) and list(frames[0].shape) == info["features"][IMAGES]["shape"]
    task = data.config.task
    drawn = [state_image(task, s[None], pixels=256) for s in states]
    away = np.abs(np.array(frames, int)[:, None] - np.array(drawn, int)[None]).mean(axis=(2, 3, 4))
    assert (np.diag(away) < 3).all()  # of 255, by compression
    other = ~np.eye(len(frames), dtype=bool) & (np.abs(states[:, None] - states).max((2, 3)) > 1)
    assert (away[other] > np.diag(away).max()).all()


def test_the_table_of_episodes_finds_frames_in_tables_and_films(folder, episodes, info):
    rows = parquet.read_table(folder / "meta" / "episodes" / f"{FILE}.parquet").to_pylist()
    assert len(rows) == info["total_episodes"] == EPISODES
    begin = 0
    for number, (row, episode) in enumerate(zip(rows, episodes, strict=True)):
        length = len(episode.action)
        assert (row["episode_index"], row["length"]) == (number, length)
        assert (row["dataset_from_index"], row["dataset_to_index"]) == (begin, begin + length)
        assert row[f"videos/{IMAGES}/from_timestamp"] == begin / 4
        assert row[f"videos/{IMAGES}/to_timestamp"] == (begin + length) / 4
        assert row["tasks"] == ["gathering"]
        for file in ("data", f"videos/{IMAGES}", "meta/episodes"):
            assert (row[f"{file}/chunk_index"], row[f"{file}/file_index"]) == (0, 0)
        begin += length
    assert begin == info["total_frames"]


def test_statistics_of_episodes_add_up_to_those_of_the_set(folder, info):
    rows = parquet.read_table(folder / "meta" / "episodes" / f"{FILE}.parquet").to_pylist()
    whole = json.loads((folder / "meta" / "stats.json").read_text())
    assert set(whole) == set(info["features"])
    for name, figures in whole.items():
        of = {key: np.array([row[f"stats/{name}/{key}"] for row in rows]) for key in figures}
        weight = of["count"].reshape(-1, *[1] * (of["mean"].ndim - 1)) / figures["count"][0]
        assert figures["count"] == [info["total_frames"]]
        np.testing.assert_allclose(figures["min"], of["min"].min(axis=0))
        np.testing.assert_allclose(figures["max"], of["max"].max(axis=0))
        np.testing.assert_allclose(figures["mean"], (weight * of["mean"]).sum(axis=0), atol=1e-9)
    assert np.shape(whole[IMAGES]["mean"]) == (3, 1, 1)


def test_tasks_are_indexed_by_their_words(folder, info):
    tasks = pandas.read_parquet(folder / "meta" / "tasks.parquet")
    assert tasks.index.tolist() == ["gathering"] and tasks["task_index"].tolist() == [0]
    assert info["total_tasks"] == 1 and info["codebase_version"] == "v3.0"
    assert info["splits"] == {"train": f"0:{EPISODES}"}


def test_paths_of_the_metadata_are_those_of_the_files(folder, info):
    place = {"chunk_index": 0, "file_index": 0}
    assert (folder / info["data_path"].format(**place)).is_file()
    assert (folder / info["video_path"].format(video_key=IMAGES, **place)).is_file()


def test_many_episodes_are_divided_among_files(data, tmp_path, monkeypatch):
    monkeypatch.setattr(lerobot_format, "_PER_FILE", 4)
    lerobot_format.write(data, tmp_path / "out", EPISODES)
    meta = tmp_path / "out" / "meta" / "episodes" / f"{FILE}.parquet"
    rows = parquet.read_table(meta).to_pylist()
    assert [row["data/file_index"] for row in rows] == [0, 0, 0, 0, 1, 1]
    assert rows[4][f"videos/{IMAGES}/from_timestamp"] == 0.0
    second = parquet.read_table(tmp_path / "out" / "data" / "chunk-000" / "file-001.parquet")
    assert second["index"][0].as_py() == rows[4]["dataset_from_index"] > 0
    with av.open(str(tmp_path / f"out/videos/{IMAGES}/chunk-000/file-001.mp4")) as film:
        assert sum(1 for _ in film.decode(video=0)) == rows[4]["length"] + rows[5]["length"]


def test_a_folder_is_not_written_over_and_a_failure_leaves_none(data, tmp_path, monkeypatch):
    (tmp_path / "there").mkdir()
    with pytest.raises(UserError, match="there exists already; legal: a new folder"):
        lerobot_format.write(data, tmp_path / "there", 1)
    with pytest.raises(UserError, match="--out: / exists already; legal: a new folder"):
        lerobot_format.write(data, Path("/"), 1)

    def fails(*_):
        raise ValueError("cause")

    monkeypatch.setattr(lerobot_format, "_write_metadata", fails)
    with pytest.raises(ValueError, match="cause"):
        lerobot_format.write(data, tmp_path / "out", 1)
    assert names(tmp_path) == ["there"]


def names(folder):
    """The names of all but locks."""
    return sorted(path.name for path in folder.iterdir() if path.suffix != ".lock")


def test_two_exports_to_one_folder_do_not_meet(data, tmp_path, monkeypatch):
    """The second begins when the first has written all but its metadata."""
    finish = lerobot_format._write_metadata
    refused = []

    def also_begin(*first):
        monkeypatch.setattr(lerobot_format, "_write_metadata", finish)
        with pytest.raises(UserError, match="out: another export writes it") as told:
            lerobot_format.write(data, tmp_path / "out", 1)
        refused.append(told)
        lerobot_format.write(data, tmp_path / "other", 1)
        finish(*first)

    monkeypatch.setattr(lerobot_format, "_write_metadata", also_begin)
    lerobot_format.write(data, tmp_path / "out", 2)
    assert len(refused) == 1 and names(tmp_path) == ["other", "out"]
    for name, count in (("out", 2), ("other", 1)):
        known = json.loads((tmp_path / name / "meta" / "info.json").read_text())
        table = parquet.read_table(tmp_path / name / "data" / f"{FILE}.parquet")
        assert known["total_episodes"] == count and known["total_frames"] == len(table)


def test_what_a_killed_export_left_is_no_obstacle(data, tmp_path):
    (tmp_path / ".out.part" / "meta").mkdir(parents=True)
    (tmp_path / ".out.part" / "meta" / "info.json").write_text("{")
    (tmp_path / ".out.lock").touch()
    lerobot_format.write(data, tmp_path / "out", 1)
    assert names(tmp_path) == ["out"]
    assert json.loads((tmp_path / "out/meta/info.json").read_text())["total_episodes"] == 1


def test_the_command_writes_it_into_the_run(tmp_path, capsys):
    run = run_folder(tmp_path / "run")
    assert main(["export", "lerobot", str(run), "--episodes", "1"]) == 0
    words = "1 episodes, 1 of them succeed, none of them begins at a start of the task, "
    assert capsys.readouterr().out.startswith(words)
    known = json.loads((run / "lerobot" / "meta" / "rtg.json").read_text())
    assert known["rtg_seed"] == 3 and len(known["rtg_transitions_sha256"]) == 64
    assert main(["export", "lerobot", str(run), "--transitions"]) == 2
    assert "--transitions: is for minari, as LeRobot wants episodes" in capsys.readouterr().err
