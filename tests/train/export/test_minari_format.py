"""Minari's data sets: written, loaded with Minari, and played in the environment they name."""

import os

import gymnasium
import numpy as np
import pytest
from exported import run_folder
from rtg.errors import UserError
from rtg.export import minari_format, run_data, target
from rtg.files import dataset

minari = pytest.importorskip("minari", reason="the extra `minari` is not installed")
pytest.importorskip("h5py", reason="the extra `minari` is not installed")


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    return run_data.read(run_folder(tmp_path_factory.mktemp("runs") / "run"))


@pytest.fixture
def home(tmp_path, monkeypatch):
    """The folder of Minari's data sets."""
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    return tmp_path


def test_plans_are_episodes_that_their_environment_repeats_to_the_bit(data, home):
    words = minari_format.write(data, "plans", "rtg/mine-v0", None, None)
    found = minari.load_dataset("rtg/mine-v0")
    env = found.recover_environment()
    assert env.spec.id == "RTG/Gathering-v0"
    successes = 0
    for episode in found.iterate_episodes():
        observation, _ = env.reset(options={"poses": episode.infos["poses"][0]})
        for step, action in enumerate(episode.actions):
            assert np.array_equal(observation, episode.observations[step])
            observation, reward, terminated, _, info = env.step(action)
            assert np.array_equal(info["poses"], episode.infos["poses"][step + 1])
            assert reward == episode.rewards[step]
            assert terminated == episode.terminations[step]
        assert np.array_equal(observation, episode.observations[-1])
        assert episode.truncations.tolist() == [
            *([False] * (len(episode) - 1)),
            not episode.terminations[-1],
        ]
        successes += episode.terminations[-1]
    assert found.total_episodes > 20 and successes > 0
    assert max(len(episode) for episode in found.iterate_episodes()) > 1
    assert words.splitlines() == [
        f"rtg/mine-v0: {found.total_episodes} episodes, {successes} of them succeed, none of them "
        f"begins at a start of the task, {found.total_steps:,} steps",
        str(home / "rtg" / "mine-v0"),
    ]


def test_the_metadata_say_what_it_is_and_where_it_comes_from(data, home):
    minari_format.write(data, "plans", "mine-v0", None, 3)
    found = minari.load_dataset("mine-v0")
    known = found.storage.metadata
    assert found.total_episodes == 3 and known["rtg_episodes"] == "plans"
    assert "plans found in the data, replayed in the simulator" in known["description"]
    assert known["rtg_task"] == str(data.config.task.content)
    assert (known["rtg_seed"], known["rtg_revision"]) == (3, data.origin.revision)
    assert known["rtg_transitions_sha256"] == data.sha256


def test_no_stored_transition_is_lost(data, home):
    minari_format.write(data, "transitions", "all-v0", None, None)
    found = minari.load_dataset("all-v0")
    rows = data.transitions
    assert found.storage.metadata["rtg_episodes"] == "transitions"
    assert found.total_steps == len(rows.action)
    assert found.total_episodes == dataset.chains(rows).episode.max() + 1
    stored = {
        (before.tobytes(), int(action), after.tobytes(), bool(success), int(source))
        for before, action, after, success, source in zip(
            rows.poses, rows.action, rows.next_poses, rows.terminated, rows.source, strict=True
        )
    }
    loaded = set()
    for episode in found.iterate_episodes():
        poses, source = episode.infos["poses"], episode.infos["source"]
        assert source[0] == -1
        for k, action in enumerate(episode.actions):
            success = bool(episode.terminations[k])
            loaded.add(
                (poses[k].tobytes(), int(action), poses[k + 1].tobytes(), success, source[k + 1])
            )
    assert loaded == stored and len(stored) == len(rows.action)


def test_another_folder_is_left_as_it_was_found(data, tmp_path, home):
    minari_format.write(data, "plans", "mine-v0", tmp_path / "there", 1)
    assert (tmp_path / "there" / "mine-v0" / "data" / "main_data.hdf5").is_file()
    assert os.environ["MINARI_DATASETS_PATH"] == str(home)


def test_a_task_of_ones_own_is_in_the_data_set_itself(tmp_path, home):
    run = run_folder(tmp_path / "run", "task.horizon=7")
    data = run_data.read(run)
    minari_format.write(data, "plans", "own-v0", None, 1)
    (run / "config.yaml").unlink()
    env = minari.load_dataset("own-v0").recover_environment()
    assert env.spec.id == "RTG/Task-v0"
    task = env.unwrapped.task
    assert (task.horizon, task.content) == (7, data.config.task.content)
    assert isinstance(gymnasium.make(env.spec).unwrapped, type(env.unwrapped))


@pytest.mark.parametrize("id", ["", "a b-v0", "a/b", "../x-v0"])
def test_what_is_no_id_is_refused(data, home, id):
    with pytest.raises(UserError, match=r"not an id of Minari; legal: NAME-v0"):
        minari_format.write(data, "plans", id, None, 1)


def test_a_data_set_is_not_written_over(data, home):
    minari_format.write(data, "plans", "mine-v0", None, 1)
    with pytest.raises(UserError, match=r"--id mine-v0: .* exists already; legal: another id"):
        minari_format.write(data, "plans", "mine-v0", None, 1)


def test_what_cannot_be_written_whole_is_not_there(data, home, monkeypatch):
    def fails(config):
        raise OSError("no space left")

    monkeypatch.setattr(minari_format, "environment_of", fails)
    with pytest.raises(UserError, match="mine-v0: no space left; legal: a folder to write to"):
        minari_format.write(data, "plans", "mine-v0", None, 1)
    assert not (home / "mine-v0").exists()


def test_a_killed_export_leaves_no_data_set_and_is_no_obstacle(data, home, monkeypatch):
    """What is killed cleans nothing up."""
    with monkeypatch.context() as killed:
        killed.setattr(target.shutil, "rmtree", lambda *_, **__: None)
        killed.setattr(minari_format, "_metadata", lambda *_: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            minari_format.write(data, "plans", "rtg/mine-v0", None, 1)
    assert (home / "rtg/.mine-v0.part/rtg/mine-v0/data/main_data.hdf5").is_file()
    assert not (home / "rtg/mine-v0").exists() and minari.list_local_datasets() == {}
    minari_format.write(data, "plans", "rtg/mine-v0", None, 1)
    assert list(minari.list_local_datasets()) == ["rtg/mine-v0"]
    assert minari.namespace.list_local_namespaces() == ["rtg"]
    assert not (home / "rtg/.mine-v0.part").exists()


def test_what_another_export_writes_is_left_to_it(data, home):
    with target.held(home / "mine-v0"):
        (home / "mine-v0").mkdir()
        with pytest.raises(UserError, match="mine-v0: another export writes it"):
            minari_format.write(data, "plans", "mine-v0", None, 1)
        assert (home / "mine-v0").is_dir()
        minari_format.write(data, "plans", "other-v0", None, 1)
    assert list(minari.list_local_datasets()) == ["other-v0"]


def test_data_without_a_plan_say_so(tmp_path, home):
    run = run_folder(tmp_path / "run", "search.generator=random", "search.transitions=100")
    with pytest.raises(UserError, match=r"the 100 transitions have no plan.*legal: --transitions"):
        minari_format.write(run_data.read(run), "plans", "mine-v0", None, None)
