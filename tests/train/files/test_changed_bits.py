"""Changes of files that are read back: a single bit, stretches of bytes, what is in an archive.

A changed file is refused with its name, or what is read is as it was. Files of others have no
digest, so that bytes of any kind reach the readers behind it: they are refused or read, and a small
file never takes much memory.
"""

import struct
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from changes import changed
from rtg import _core
from rtg.errors import UserError
from rtg.files import best_episode, checkpoint, dataset, own_data, run_folder, versions
from rtg.learn import networks, policy_file
from rtg.learn.training_log import TrainingLog
from rtg.run import effective_config
from rtg.run.results import learning_curve
from samples import random_transitions
from training_runs import TINY

CONFIG = _core.Config.from_file(TINY)
TASK = CONFIG.task
FLIPS = 1000
CHANGES = 150  # of each file
ROOM = 64e6  # bytes that a reader may take beside four times the file


class Kind(NamedTuple):
    """How a file of the run folder is written and read back."""

    write: Callable[[Path], object]
    read: Callable[[Path], object]


def write_policy(path: Path) -> None:
    network = networks.make(CONFIG.train.network, TASK.observation_size, TASK.headings)
    policy_file.write(path, TASK, CONFIG.train, network.state_dict())


def write_transitions(path: Path) -> None:
    dataset.write(path, random_transitions(20), dataset.origin_of(CONFIG))


def write_progress(path: Path) -> None:
    log = TrainingLog(path.parent)
    for k in range(1, 4):
        log.add({"interactions": 500 * k, "success_rate": k / 7, "cpu_s": 2.5 * k})


JSON = Kind(
    lambda path: run_folder.write_json(path, {"a": [0.5, 1e-9], "ä": {"b": None}, "c": "d" * 64}),
    run_folder.read_json,
)
KINDS = {
    "model.pt": Kind(write_policy, lambda path: policy_file.read(path, TASK)),
    "state.pt": Kind(
        lambda path: checkpoint.write(path, {"replay": {"reward": np.zeros(99)}, "count": 3}),
        checkpoint.read,
    ),
    "best_episode.npz": Kind(
        lambda path: best_episode.write(path.parent, np.ones((9, 4, 3)), True),
        lambda path: best_episode.read(path.parent, 4),
    ),
    "transitions.npz": Kind(write_transitions, dataset.read),
    "versions.json": Kind(lambda path: versions.write(path.parent, "box2d", {}), JSON.read),
    "config.yaml": Kind(
        lambda path: run_folder.write_config(path, CONFIG.yaml), effective_config.load_written
    ),
    "progress.csv": Kind(write_progress, learning_curve),
    "summary.json": JSON,
    "generation.json": Kind(
        lambda path: run_folder.write_json(path, {"nodes": [[1, 2]]}, indent=None), JSON.read
    ),
}


@pytest.mark.parametrize("name", KINDS)
def test_a_changed_bit_is_refused_with_the_name_of_the_file(name: str, tmp_path: Path) -> None:
    """One bit of each of equally long parts of the file, all bits of a file that has few."""
    kind, path = KINDS[name], tmp_path / name
    kind.write(path)
    kind.read(path)
    whole = path.read_bytes()
    bounds = np.linspace(0, 8 * len(whole), FLIPS + 1).astype(int)
    draws = np.random.default_rng(0).integers(bounds[:-1], np.maximum(bounds[1:], bounds[:-1] + 1))
    for bit in np.unique(draws):
        changed = bytearray(whole)
        changed[bit // 8] ^= 1 << bit % 8
        path.write_bytes(changed)
        with pytest.raises(UserError, match=f"^{path}: "):
            kind.read(path)


@pytest.mark.parametrize("name", ["summary.json", "generation.json"])
def test_every_bit_of_an_object_counts(name: str, tmp_path: Path) -> None:
    kind, path = KINDS[name], tmp_path / name
    kind.write(path)
    whole = path.read_bytes()
    for bit in range(8 * len(whole)):
        changed = bytearray(whole)
        changed[bit // 8] ^= 1 << bit % 8
        path.write_bytes(changed)
        with pytest.raises(UserError, match=f"^{path}: "):
            kind.read(path)


def test_rows_of_a_table_that_moved_or_went_are_noticed_but_for_the_last(tmp_path: Path) -> None:
    path = tmp_path / "progress.csv"
    write_progress(path)
    head, *rows = path.read_text().splitlines()
    for other in ([rows[0], rows[2]], [rows[1], rows[0], rows[2]], [*rows, rows[2]]):
        path.write_text("\n".join([head, *other]) + "\n")
        with pytest.raises(UserError, match=f"^{path}: "):
            learning_curve(path)
    path.write_text("\n".join([head, *rows[:2]]) + "\n")
    assert learning_curve(path)["interactions"].tolist() == [500, 1000]


def test_tables_of_earlier_versions_have_no_checks(tmp_path: Path) -> None:
    path = tmp_path / "progress.csv"
    path.write_text("interactions,cpu_s\n5,1.5\n10,\n")
    np.testing.assert_array_equal(learning_curve(path)["cpu_s"], [1.5, np.nan])


def test_objects_and_arrays_of_others_have_no_digest(tmp_path: Path) -> None:
    for text, known in {"{}": {}, '{"a": "' + "0" * 63 + '"}': {"a": "0" * 63}}.items():
        (tmp_path / "a.json").write_text(text)
        assert run_folder.read_json(tmp_path / "a.json") == known
    np.savez(tmp_path / best_episode.FILE, poses=np.ones((2, 4, 3)), success=True)
    assert best_episode.read(tmp_path, 4)[1]


def outcome(kind: Kind, path: Path) -> str:
    """Reads `path`. Returns the refusal, which names the file; "" if there was none."""
    tracemalloc.start()
    try:
        kind.read(path)
        return ""
    except UserError as error:
        assert str(error).startswith(f"{path}:")  # a line may follow
        return str(error)
    finally:
        most = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert most < ROOM + 4 * path.stat().st_size


@pytest.mark.parametrize("name", KINDS)
def test_changed_stretches_are_refused(name: str, tmp_path: Path) -> None:
    kind, path = KINDS[name], tmp_path / name
    kind.write(path)
    whole, draws = path.read_bytes(), np.random.default_rng(1)
    for _ in range(CHANGES):
        content = changed(whole, draws)
        path.write_bytes(content)
        assert bool(outcome(kind, path)) == (content.rstrip() != whole.rstrip())


def write_own(path: Path) -> None:
    rows = random_transitions(20)
    np.savez(path, states=rows.poses, actions=rows.action, next_states=rows.next_poses)


OWN = Kind(write_own, lambda path: own_data.read(path, TASK))
ARCHIVES = {name: kind for name, kind in KINDS.items() if name.endswith((".npz", ".pt"))}


def repacked(members: dict[str, bytes], path: Path) -> None:
    """Makes an archive of others, without digest."""
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)


@pytest.mark.parametrize("name", ARCHIVES)
def test_an_archive_that_lost_its_end_is_refused(name: str, tmp_path: Path) -> None:
    kind, path = KINDS[name], tmp_path / name
    kind.write(path)
    whole = path.read_bytes()
    for lost in range(1, 100):  # all of the digest, of 64 bytes, is among it
        path.write_bytes(whole[:-lost])
        assert outcome(kind, path)


@pytest.mark.parametrize("name", [*ARCHIVES, "own.npz"])
def test_archives_of_others_are_read_or_refused(name: str, tmp_path: Path) -> None:
    kind, path = ARCHIVES.get(name, OWN), tmp_path / name
    kind.write(path)
    with zipfile.ZipFile(path) as archive:
        members = {member: archive.read(member) for member in archive.namelist()}
    draws, refused = np.random.default_rng(2), 0
    for _ in range(CHANGES):
        member = str(draws.choice(list(members)))
        head = members[member][:200]  # of an array, its type and shape
        content = changed(head, draws) + members[member][200:]
        repacked({**members, member: content}, path)
        refused += bool(outcome(kind, path))
    assert refused > CHANGES / 20


BYTES = b"\x80\x02cbuiltins\nbytearray\nJ\x00\x00\x00\x08\x85R."  # bytearray(2**27), pickled


@pytest.mark.parametrize("member", ["archive/data.pkl", "archive/DATA.PKL"])
@pytest.mark.parametrize("before", [b"", BYTES])
def test_a_pickle_that_asks_for_memory_gets_none(
    member: str, before: bytes, tmp_path: Path
) -> None:
    path = tmp_path / "state.pt"
    repacked({member: BYTES, "archive/version": b"3\n", "archive/byteorder": b"little"}, path)
    path.write_bytes(before + path.read_bytes())
    with pytest.raises(UserError, match="is damaged or foreign; legal: ") as error:
        checkpoint.read(path)
    assert str(error.value.__cause__) in ("it asks for builtins bytearray", "no archive of PyTorch")


def array_file(kind: str, shape: str) -> bytes:
    """Returns a .npy that tells of an array of that type and shape, and holds nothing of it."""
    words = f"{{'descr': {kind!r}, 'fortran_order': False, 'shape': {shape}}}\n".encode()
    return b"\x93NUMPY\x01\0" + struct.pack("<H", len(words)) + words


@pytest.mark.parametrize("name", ["transitions.npz", "best_episode.npz", "own.npz"])
@pytest.mark.parametrize(
    ("kind", "shape"),
    [
        ("<f8", "(1000000000,)"),
        ("<f8", "(50000000, 7, 3)"),
        ("<f8", "(4294967296, 4294967296)"),
        ("<f8", "(-1,)"),
        ("<U500000000", "()"),
        ("<U0", "(99999999999,)"),
        ("|V0", "(99999999999,)"),
        ("|O", "(2,)"),
        ("|b1", "(1, 0, 99999999999)"),
    ],
)
def test_an_array_that_is_not_there_takes_no_memory(
    name: str, kind: str, shape: str, tmp_path: Path
) -> None:
    reader, path = ARCHIVES.get(name, OWN), tmp_path / name
    reader.write(path)
    with zipfile.ZipFile(path) as archive:
        members = {member: archive.read(member) for member in archive.namelist()}
    for member in members:
        repacked({**members, member: array_file(kind, shape)}, path)
        assert outcome(reader, path)
