import io
import os
import pickle
import time
import zipfile
from pathlib import Path

import numpy as np
import pytest
from rtg.errors import UserError
from rtg.files import dataset
from rtg.files.dataset import DatasetError, Transitions
from samples import random_transitions


@pytest.fixture
def transitions() -> Transitions:
    return random_transitions(50)


def saved(path: Path, transitions: Transitions, **changes: object) -> Path:
    arrays = {**transitions._asdict(), **changes}
    np.savez(path, **{name: array for name, array in arrays.items() if array is not None})
    return path


def test_round_trip_is_exact(tmp_path: Path, transitions: Transitions) -> None:
    path = tmp_path / "transitions.npz"
    dataset.write(path, transitions)
    back = dataset.read(path, bodies=4, actions=48)
    for wrote, got in zip(transitions, back, strict=True):
        assert wrote.dtype == got.dtype
        np.testing.assert_array_equal(wrote, got)
    assert os.listdir(tmp_path) == ["transitions.npz"]


def test_equal_data_gives_equal_bytes(
    tmp_path: Path, transitions: Transitions, monkeypatch: pytest.MonkeyPatch
) -> None:
    dataset.write(tmp_path / "a.npz", transitions)
    monkeypatch.setattr(time, "time", lambda: 2_000_000_000.0)
    dataset.write(tmp_path / "b.npz", transitions)
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_numpy_reads_the_file(tmp_path: Path, transitions: Transitions) -> None:
    dataset.write(tmp_path / "a.npz", transitions)
    with np.load(tmp_path / "a.npz") as archive:
        assert list(archive) == list(Transitions._fields)


def test_empty_set_round_trips(tmp_path: Path, transitions: Transitions) -> None:
    empty = Transitions(*(array[:0] for array in transitions))
    dataset.write(tmp_path / "a.npz", empty)
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
    ],
)
def test_wrong_arrays_are_named(
    tmp_path: Path, transitions: Transitions, changes: dict[str, object], message: str
) -> None:
    path = saved(tmp_path / "bad.npz", transitions, **changes)
    with pytest.raises(DatasetError) as error:
        dataset.read(path, bodies=4, actions=48)
    assert str(error.value).startswith(f"{path}: {message}")


def test_a_wrong_file_is_bad_input_to_every_command() -> None:
    assert issubclass(DatasetError, UserError)


def test_other_tasks_are_refused(tmp_path: Path, transitions: Transitions) -> None:
    dataset.write(tmp_path / "a.npz", transitions)
    with pytest.raises(DatasetError, match="has 4 bodies; legal: 5"):
        dataset.read(tmp_path / "a.npz", bodies=5)


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
    dataset.write(tmp_path / "a.npz", transitions)
    (tmp_path / "b.npz").write_bytes((tmp_path / "a.npz").read_bytes()[:keep])
    with pytest.raises(DatasetError, match="not a transition file"):
        dataset.read(tmp_path / "b.npz")


def test_a_changed_byte_of_the_directory_is_harmless_or_refused(
    tmp_path: Path, transitions: Transitions
) -> None:
    dataset.write(tmp_path / "a.npz", transitions)
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
