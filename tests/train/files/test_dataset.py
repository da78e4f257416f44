import io
import os
import pickle
import time
import zipfile
from pathlib import Path

import numpy as np
import pytest
from rtg import _core, paths
from rtg.errors import UserError
from rtg.files import dataset, versions
from rtg.files.dataset import DatasetError, Origin, Transitions
from samples import random_transitions

TASK = _core.Config.from_file(paths.CONFIG / "gathering.yaml").task
ORIGIN = Origin(TASK.content, seed=3, revision="abc-modified")


@pytest.fixture
def transitions() -> Transitions:
    return random_transitions(50)


def saved(path: Path, transitions: Transitions, **changes: object) -> Path:
    chains = dataset.chains(transitions)._asdict() if len(transitions.poses.shape) == 3 else {}
    arrays = {**transitions._asdict(), **chains, **ORIGIN._asdict(), **changes}
    np.savez(path, **{name: array for name, array in arrays.items() if array is not None})
    return path


def test_round_trip_is_exact(tmp_path: Path, transitions: Transitions) -> None:
    path = tmp_path / "transitions.npz"
    dataset.write(path, transitions, ORIGIN)
    back, origin = dataset.read_with_origin(path, TASK)
    assert origin == ORIGIN
    for wrote, got in zip(transitions, back, strict=True):
        assert wrote.dtype == got.dtype
        np.testing.assert_array_equal(wrote, got)
    assert os.listdir(tmp_path) == ["transitions.npz"]


def test_equal_data_gives_equal_bytes(
    tmp_path: Path, transitions: Transitions, monkeypatch: pytest.MonkeyPatch
) -> None:
    dataset.write(tmp_path / "a.npz", transitions, ORIGIN)
    monkeypatch.setattr(time, "time", lambda: 2_000_000_000.0)
    dataset.write(tmp_path / "b.npz", transitions, ORIGIN)
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_numpy_reads_the_file(tmp_path: Path, transitions: Transitions) -> None:
    dataset.write(tmp_path / "a.npz", transitions, ORIGIN)
    with np.load(tmp_path / "a.npz") as archive:
        columns = [*Transitions._fields, "episode", "step", "truncated"]
        assert list(archive) == [*columns, "task", "seed", "revision"]
        assert int(archive["seed"]) == 3 and str(archive["revision"]) == "abc-modified"


def test_empty_set_round_trips(tmp_path: Path, transitions: Transitions) -> None:
    empty = Transitions(*(array[:0] for array in transitions))
    dataset.write(tmp_path / "a.npz", empty, ORIGIN)
    assert len(dataset.read(tmp_path / "a.npz").action) == 0


def test_concatenate_keeps_order(transitions: Transitions) -> None:
    halves = [
        Transitions(*(a[:20] for a in transitions)),
        Transitions(*(a[20:] for a in transitions)),
    ]
    for whole, joined in zip(transitions, dataset.concatenate(halves), strict=True):
        np.testing.assert_array_equal(whole, joined)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"reward": None}, "array 'reward' is missing; legal: poses, action,"),
        ({"action": np.zeros(50)}, "'action' has type float64; legal: int32"),
        ({"action": np.zeros(49, np.int32)}, "'poses' has shape [50, 4, 3]; legal: [N, bodies, 3]"),
        ({"poses": np.zeros((50, 4, 2))}, "'poses' has shape [50, 4, 2]; legal: [N, bodies, 3]"),
        ({"next_poses": np.zeros((50, 5, 3))}, "'poses' and 'next_poses' differ in shape"),
        ({"poses": np.full((50, 4, 3), np.nan)}, "'poses' has values that are not finite"),
        ({"reward": np.full(50, 0.5, np.float32)}, "'reward' has other values than 0 and 1"),
        ({"terminated": np.ones(50, bool)}, "'terminated' differs from reward == 1"),
        ({"action": np.full(50, -1, np.int32)}, "'action' has negative values"),
        ({"action": np.full(50, 48, np.int32)}, "has action 48; legal: 0 to 47"),
        ({"source": np.full(50, 4, np.int8)}, "'source' has illegal values; legal: 0 to 3"),
        ({"episode": None}, "array 'episode' is missing; legal: poses, action,"),
        ({"episode": np.zeros(50, np.int32)}, "'episode' is not that of these rows"),
        ({"step": np.ones(50, np.int32)}, "'step' is not that of these rows"),
        ({"truncated": np.zeros(50, bool)}, "'truncated' is not that of these rows"),
        ({"seed": np.zeros(50, np.int64)}, "'seed' has shape [50]; legal: []"),
        ({"seed": 0.5}, "'seed' has type float64; legal: int64"),
        ({"revision": 1}, "'revision' has type int64; legal: str"),
        ({"task": 5}, f"has transitions of another task (5); legal: {TASK.content}, which is"),
    ],
)
def test_wrong_arrays_are_named(
    tmp_path: Path, transitions: Transitions, changes: dict[str, object], message: str
) -> None:
    path = saved(tmp_path / "bad.npz", transitions, **changes)
    with pytest.raises(DatasetError) as error:
        dataset.read(path, TASK)
    assert str(error.value).startswith(f"{path}: {message}")


def test_a_wrong_file_is_bad_input_to_every_command() -> None:
    assert issubclass(DatasetError, UserError)


def test_other_tasks_are_refused(tmp_path: Path, transitions: Transitions) -> None:
    other = _core.Config.from_file(paths.CONFIG / "sorting.yaml").task
    dataset.write(tmp_path / "a.npz", transitions, ORIGIN)
    with pytest.raises(
        DatasetError, match=r"has transitions of another task .* which is 'sorting'"
    ):
        dataset.read(tmp_path / "a.npz", other)
    dataset.write(tmp_path / "b.npz", random_transitions(50, bodies=5), ORIGIN)
    with pytest.raises(DatasetError, match="has 5 bodies; legal: 4"):
        dataset.read(tmp_path / "b.npz", TASK)


def test_a_set_that_was_changed_since_it_was_sealed_is_refused(
    tmp_path: Path, transitions: Transitions
) -> None:
    path, beside = tmp_path / "a.npz", tmp_path / "b.npz"
    for file in (path, beside):
        dataset.write(file, transitions, ORIGIN)
    versions.seal(path)
    dataset.read(path)
    dataset.write(path, transitions, ORIGIN._replace(seed=4))
    with pytest.raises(UserError) as error:
        dataset.read(path)
    assert str(error.value).startswith(f"{path}: was changed since the run wrote it")
    dataset.read(beside)  # which nobody sealed


class Bomb:
    def __reduce__(self) -> tuple[object, tuple[str]]:
        return os.mkdir, ("exploded",)


def test_pickles_are_never_run(
    tmp_path: Path, transitions: Transitions, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with np.errstate(all="ignore"):
        path = saved(tmp_path / "bad.npz", transitions, poses=np.array([Bomb()], dtype=object))
    with pytest.raises(DatasetError, match="not a transition file"):
        dataset.read(path)
    (tmp_path / "raw.npz").write_bytes(pickle.dumps(Bomb()))
    with pytest.raises(DatasetError, match="not a transition file"):
        dataset.read(tmp_path / "raw.npz")
    assert not (tmp_path / "exploded").exists()


@pytest.mark.parametrize("keep", [0, 1, 100, 5000])
def test_truncated_files_are_refused(tmp_path: Path, transitions: Transitions, keep: int) -> None:
    dataset.write(tmp_path / "a.npz", transitions, ORIGIN)
    (tmp_path / "b.npz").write_bytes((tmp_path / "a.npz").read_bytes()[:keep])
    with pytest.raises(DatasetError, match="not a transition file"):
        dataset.read(tmp_path / "b.npz")


def test_a_changed_byte_of_the_directory_is_harmless_or_refused(
    tmp_path: Path, transitions: Transitions
) -> None:
    dataset.write(tmp_path / "a.npz", transitions, ORIGIN)
    whole = (tmp_path / "a.npz").read_bytes()
    refused = 0
    for at in range(whole.rindex(b"PK\x01\x02"), len(whole)):
        (tmp_path / "b.npz").write_bytes(whole[:at] + bytes([whole[at] ^ 0xFF]) + whole[at + 1 :])
        try:
            dataset.read(tmp_path / "b.npz")
        except DatasetError:
            refused += 1
    assert refused > 10


def test_header_that_promises_too_much_is_refused(tmp_path: Path, transitions: Transitions) -> None:
    header = io.BytesIO()
    shape = {"descr": "<f8", "fortran_order": False, "shape": (10**12, 4, 3)}
    np.lib.format.write_array_header_1_0(header, shape)
    with zipfile.ZipFile(tmp_path / "bad.npz", "w") as archive:
        archive.writestr("poses.npy", header.getvalue())
    with pytest.raises(DatasetError, match="not a transition file"):
        dataset.read(tmp_path / "bad.npz")
