"""Transitions from Minari data sets, those of others as well."""

import hashlib
import json
import os
import tracemalloc

import gymnasium
import numpy as np
import pytest
from changes import changed
from rtg import _core, paths
from rtg.errors import UserError
from rtg.files import minari_data

minari = pytest.importorskip("minari", reason="the extra `minari` is not installed")
h5py = pytest.importorskip("h5py", reason="the extra `minari` is not installed")

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")  # of authors and links
TASK = _core.Config.from_file(paths.CONFIG / "gathering.yaml").task
ACTIONS = (3, 20, 40)


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path / "minari"))
    return tmp_path / "minari"


def episode(env, seed, **infos):
    """An episode as a collector of Minari stores it; `infos` replace those of the environment."""
    observation, info = env.reset(seed=seed)
    observations, known = [observation], {name: [value] for name, value in info.items()}
    rewards = []
    for action in ACTIONS:
        observation, reward, _, _, info = env.step(action)
        observations.append(observation)
        rewards.append(reward)
        for name, value in info.items():
            known[name].append(value)
    known = {name: np.array(values) for name, values in known.items()} | infos
    return minari.data_collector.EpisodeBuffer(
        observations=np.array(observations),
        actions=np.array(ACTIONS),
        rewards=rewards,
        terminations=[False, False, False],
        truncations=[False, False, True],
        infos={name: values for name, values in known.items() if values is not None},
    )


def made(id, *buffers, env="RTG/Gathering-v0"):
    minari.create_dataset_from_buffers(id, list(buffers), env=gymnasium.make(env))
    return minari_data.folder_of(id)


def test_states_are_those_of_the_infos(home):
    env = gymnasium.make("RTG/Gathering-v0")
    buffers = [episode(env, seed) for seed in (1, 2)]
    folder = made("mine/own-v0", *buffers)
    rows, origin = minari_data.read("mine/own-v0", folder, TASK)
    poses = [buffer.infos["poses"] for buffer in buffers]
    assert np.array_equal(rows.poses, np.concatenate([path[:-1] for path in poses]))
    assert np.array_equal(rows.next_poses, np.concatenate([path[1:] for path in poses]))
    assert rows.action.tolist() == [*ACTIONS, *ACTIONS]
    assert (origin["format"], origin["name"]) == ("minari", "mine/own-v0")
    assert folder == home / "mine" / "own-v0" / "data"
    assert minari_data.folder_of(str(folder)) == folder
    assert minari_data.folder_of(str(folder.parent)) == folder


def test_the_digest_is_over_names_sizes_and_contents_that_are_not_read_whole(tmp_path):
    contents = {"a.hdf5": bytes(range(256)) * 2**17, "deeper/b.json": b"{}"}
    expected = hashlib.sha256()
    for name, content in contents.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(content)
        expected.update(f"{name} {len(content)} ".encode() + content)
    tracemalloc.start()
    found = minari_data._digest(tmp_path)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert found == expected.hexdigest()
    assert most < 2**22 < len(contents["a.hdf5"])  # bytes


def test_the_digest_is_that_of_the_content():
    env = gymnasium.make("RTG/Gathering-v0")
    folder = made("mine-v0", episode(env, 1))
    before = minari_data.read("mine-v0", folder, TASK).origin["sha256"]
    assert before == minari_data.read("mine-v0", folder, TASK).origin["sha256"]
    minari.load_dataset("mine-v0").update_dataset_from_buffer([episode(env, 2)])
    assert before != minari_data.read("mine-v0", folder, TASK).origin["sha256"]


def test_pushes_that_could_not_be_finished_are_left_out():
    env = gymnasium.make("RTG/Gathering-v0")
    folder = made("mine-v0", episode(env, 1, rejected=np.array([False, False, True, False])))
    assert minari_data.read("mine-v0", folder, TASK).rows.action.tolist() == [3, 40]


@pytest.mark.parametrize("poses", [None, np.zeros((4, 3, 3)), np.full((4, 4, 3), np.nan)])
def test_without_poses_it_says_what_is_legal(poses):
    folder = made("mine-v0", episode(gymnasium.make("RTG/Gathering-v0"), 1, poses=poses))
    with pytest.raises(UserError, match=r"has no info 'poses' of shape \[4, 4, 3\]"):
        minari_data.read("mine-v0", folder, TASK)


def test_another_task_is_refused():
    env = gymnasium.make("RTG/PushT-v0")
    folder = made("mine-v0", episode(env, 1), env="RTG/PushT-v0")
    with pytest.raises(UserError, match="mine-v0: is of another task; legal: one of 'gath"):
        minari_data.read("mine-v0", folder, TASK)


def test_an_environment_of_others_is_refused():
    env = gymnasium.make("CartPole-v1")
    observation = env.reset(seed=1)[0]
    buffer = minari.data_collector.EpisodeBuffer(
        observations=np.array([observation, observation]),
        actions=np.array([0]),
        rewards=[1.0],
        terminations=[False],
        truncations=[True],
    )
    folder = made("other-v0", buffer, env="CartPole-v1")
    with pytest.raises(UserError, match="was not made with an environment of RTG"):
        minari_data.read("other-v0", folder, TASK)


def test_the_environment_of_a_stranger_is_not_made(monkeypatch):
    """Its specification may name any function to be called."""
    folder = made("mine-v0", episode(gymnasium.make("RTG/Gathering-v0"), 1))
    monkeypatch.setattr(gymnasium, "make", lambda *_, **__: pytest.fail("was made"))
    assert len(minari_data.read("mine-v0", folder, TASK).rows.action) == 3


@pytest.mark.parametrize(
    ("config", "why"),
    [
        ("nowhere.yaml", "nowhere.yaml: no such task file; legal: "),
        ("task:\n  name: a", "text:2: key .task.bodies.: is missing"),
        (["gathering"], r"config is \['gathering'\]; legal: config= with the name of a task"),
        ("x" * 5000, "no task of that name"),
    ],
)
def test_an_environment_whose_specification_has_no_task_is_refused(config, why):
    folder = made("mine-v0", episode(gymnasium.make("RTG/Gathering-v0"), 1))
    metadata = json.loads((folder / "metadata.json").read_text())
    spec = json.loads(metadata["env_spec"])
    spec["kwargs"]["config"] = config
    (folder / "metadata.json").write_text(json.dumps({**metadata, "env_spec": json.dumps(spec)}))
    with pytest.raises(UserError, match=rf"^mine-v0: its environment has no task \(.*{why}"):
        minari_data.read("mine-v0", folder, TASK)


@pytest.mark.parametrize(
    ("key", "values"),
    [("rejected", np.zeros(4, np.int64)), ("rejected", np.zeros(3, bool)), ("source", np.ones(4))],
)
def test_infos_of_another_type_or_length_are_refused(key, values):
    folder = made("mine-v0", episode(gymnasium.make("RTG/Gathering-v0"), 1, **{key: values}))
    with pytest.raises(UserError, match=f"episode 0 has info '{key}' of .*; legal: "):
        minari_data.read("mine-v0", folder, TASK)


def test_a_damaged_data_set_is_refused():
    folder = made("mine-v0", episode(gymnasium.make("RTG/Gathering-v0"), 1))
    (folder / "main_data.hdf5").write_bytes(b"nothing")
    with pytest.raises(UserError, match="mine-v0: is not a data set of Minari, or damaged"):
        minari_data.read("mine-v0", folder, TASK)


def test_what_is_no_data_set_has_no_folder(tmp_path):
    assert minari_data.folder_of(str(tmp_path)) is None
    assert minari_data.folder_of("no/such-v0") is None


def test_a_data_set_with_changed_bytes_is_read_or_refused(home):
    env = gymnasium.make("RTG/Gathering-v0")
    folder = made("mine/own-v0", episode(env, 1))
    draws = np.random.default_rng(0)
    for name in ("main_data.hdf5", "metadata.json"):
        whole, refused = (folder / name).read_bytes(), 0
        for _ in range(50):
            (folder / name).write_bytes(changed(whole, draws))
            tracemalloc.start()
            try:
                minari_data.read("mine/own-v0", folder, TASK)
            except UserError as error:
                assert str(error).startswith("mine/own-v0: ")
                refused += 1
            most = tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()
            assert most < 64e6 + 4 * len(whole)
        (folder / name).write_bytes(whole)
        assert refused > 10


def test_a_fifo_is_refused_as_it_would_never_begin():
    folder = made("mine-v0", episode(gymnasium.make("RTG/Gathering-v0"), 1))
    (folder / "main_data.hdf5").unlink()
    os.mkfifo(folder / "main_data.hdf5")
    with pytest.raises(UserError, match=r"mine-v0: .*Is no regular file.*; legal: "):
        minari_data.read("mine-v0", folder, TASK)


def unwritten(infos):
    infos.create_dataset("poses", (60_000_000, 4, 3), "f8", chunks=(1000, 4, 3))


def linked(infos):
    os.mkfifo("fifo")
    infos["poses"] = h5py.ExternalLink("fifo", "/")


def elsewhere(infos):
    infos.create_dataset("poses", (4, 4, 3), "f8", external=[("fifo", 0, h5py.h5f.UNLIMITED)])


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (unwritten, "it would take more than four times its size"),
        (linked, "episode_0/infos/poses is a link"),
        (elsewhere, "episode_0/infos/poses has no numbers in the file"),
    ],
)
def test_poses_that_are_not_in_the_file_are_refused(change, why, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = made("mine-v0", episode(gymnasium.make("RTG/Gathering-v0"), 1))
    with h5py.File(folder / "main_data.hdf5", "a") as file:
        del file["episode_0/infos/poses"]
        change(file["episode_0/infos"])
    with pytest.raises(UserError, match=f"mine-v0: .*{why}.*; legal: "):
        minari_data.read("mine-v0", folder, TASK)


def test_what_is_not_needed_is_not_read():
    folder = made("mine-v0", episode(gymnasium.make("RTG/Gathering-v0"), 1))
    with h5py.File(folder / "main_data.hdf5", "a") as file:
        file["episode_0/infos"].create_dataset("huge", (4, 10**12), chunks=(1, 1000))
    assert len(minari_data.read("mine-v0", folder, TASK).rows.action) == 3


def test_an_environment_of_a_stranger_is_not_made_without_its_spaces(monkeypatch):
    """Minari would make it to learn of its spaces."""
    folder = made("mine-v0", episode(gymnasium.make("RTG/Gathering-v0"), 1))
    metadata = json.loads((folder / "metadata.json").read_text())
    del metadata["action_space"]
    (folder / "metadata.json").write_text(json.dumps(metadata))
    monkeypatch.setattr(gymnasium, "make", lambda *_, **__: pytest.fail("was made"))
    assert len(minari_data.read("mine-v0", folder, TASK).rows.action) == 3
