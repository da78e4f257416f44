"""Transitions of one's own: which are legal, and what a run stores of them."""

import json

import numpy as np
import pytest
import scaled
from rtg import _core, paths
from rtg.errors import UserError
from rtg.files import dataset, own_data, run_folder, versions
from rtg.files.own_data import OwnData
from rtg.files.recorder import Recorder

CONFIG = _core.Config.from_file(paths.CONFIG / "gathering.yaml", ["search.transitions=300"])
TASK = CONFIG.task
ORIGIN = {"format": "npz", "name": "mine.npz", "sha256": "abc"}


@pytest.fixture(scope="module")
def generated():
    """Rows that a search has found, and its report."""
    parts = []
    report = _core.generate(
        CONFIG,
        lambda *columns: parts.append([column.copy() for column in columns]),
        lambda progress: None,
    )
    poses, action, after, _, source = (np.concatenate(part) for part in zip(*parts, strict=True))
    return own_data.checked_rows(TASK, poses, action, after, source), json.loads(report)


def arrays(rows):
    metres = [TASK.metre, TASK.metre, 1.0]
    return {
        "states": rows.poses / metres,
        "actions": rows.action,
        "next_states": rows.next_poses / metres,
    }


def test_a_file_is_read_in_metres_and_judged_by_the_task(tmp_path, generated):
    rows = generated[0]
    path = tmp_path / "mine.npz"
    np.savez(path, **arrays(rows), success=np.ones(len(rows.action), bool))
    found, origin = own_data.read(path, TASK)
    np.testing.assert_allclose(found.poses, rows.poses, rtol=1e-12)
    assert np.array_equal(found.action, rows.action)
    assert np.array_equal(found.terminated, TASK.succeeded(found.next_poses))
    assert 0 < found.terminated.sum() < len(found.action)
    assert not found.source.any()
    assert origin == {"format": "npz", "name": "mine.npz", "sha256": versions.digest(path)}


def test_sources_are_kept(tmp_path, generated):
    rows = generated[0]
    np.savez(tmp_path / "mine.npz", **arrays(rows), source=rows.source)
    assert np.array_equal(own_data.read(tmp_path / "mine.npz", TASK).rows.source, rows.source)


@pytest.fixture
def run(tmp_path, generated):
    """The folder of a run that has found the rows."""
    folder = tmp_path / "run"
    folder.mkdir()
    recorder = Recorder(CONFIG)
    recorder.add(generated[0])
    recorder.finish(folder / "transitions.npz")
    return folder


@pytest.mark.parametrize("name", ["", "transitions.npz"])
def test_a_run_is_read_to_the_bit_and_judged_by_the_task(run, generated, name):
    found, origin = own_data.read(run / name, TASK)
    for expected, column in zip(generated[0], found, strict=True):
        assert np.array_equal(expected, column) and expected.dtype == column.dtype
    digest = versions.sealed_digest(run / "transitions.npz")
    assert origin == {"format": "run", "name": "run/transitions.npz", "sha256": digest}


def test_a_run_of_another_task_and_a_changed_file_are_refused(run):
    other = _core.Config.from_file(paths.CONFIG / "push_t.yaml").task
    file = run / "transitions.npz"
    with pytest.raises(UserError, match=rf"^{file}: has transitions of another task .*'push_t'"):
        own_data.read(run, other)
    with file.open("ab") as more:
        more.write(b"x")
    with pytest.raises(UserError, match=rf"^{file}: .*or changed since it was written\); legal: "):
        own_data.read(run, TASK)


def test_a_folder_without_transitions_is_refused(tmp_path):
    with pytest.raises(
        UserError, match=r"/transitions\.npz: no such file; legal: a \.npz of numpy"
    ):
        own_data.read(tmp_path, TASK)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"next_states": None}, "array 'next_states' is missing; legal: states, actions, next_st"),
        ({"states": np.zeros((5, 3, 3))}, "states of shape [5, 3, 3]; legal: [N, 4, 3]"),
        ({"states": np.full((5, 4, 3), np.nan)}, "states hold numbers that are not finite"),
        ({"actions": np.zeros(4, int)}, "columns of [4, 5] transitions; legal: of equally many"),
        ({"actions": np.full(5, 48)}, "action 48; legal: 0 to 47"),
        ({"actions": np.zeros(5)}, "actions of type float64; legal: whole numbers, [N]"),
        ({"actions": np.zeros((5, 1), int)}, "actions of type int64; legal: whole numbers, [N]"),
        ({"source": np.full(5, 4)}, "source 4; legal: 0 to 3"),
    ],
)
def test_what_is_not_legal_is_named_with_the_file(tmp_path, generated, changes, words):
    given = {name: column[:5] for name, column in arrays(generated[0]).items()} | changes
    path = tmp_path / "mine.npz"
    np.savez(path, **{name: column for name, column in given.items() if column is not None})
    with pytest.raises(UserError) as error:
        own_data.read(path, TASK)
    assert str(error.value).startswith(f"{path}: {words}")


def test_a_file_without_transitions_or_arrays_is_refused(tmp_path, generated):
    none = {name: column[:0] for name, column in arrays(generated[0]).items()}
    np.savez(tmp_path / "none.npz", **none)
    with pytest.raises(UserError, match="no transitions; legal: at least one"):
        own_data.read(tmp_path / "none.npz", TASK)
    (tmp_path / "text.npz").write_text("text")
    np.save(tmp_path / "one.npy", np.zeros(3))
    for name in ("text.npz", "one.npy"):
        with pytest.raises(
            UserError, match=r"is not a transition file, or damaged \(no archive, .* legal: a \.npz"
        ):
            own_data.read(tmp_path / name, TASK)


def test_figures_are_those_that_a_search_tells_of_the_same_rows(generated):
    rows, report = generated
    figures = own_data.figures(TASK, rows)
    assert figures == pytest.approx({name: report[name] for name in figures})
    assert 0 < figures["contact_share"] < 1 and figures["headings_per_state"] > 2


def test_figures_are_those_of_a_task_of_any_size(generated):
    """A robot of 4 cm moves boxes by millimetres."""
    rows = generated[0]
    small = scaled.gathering(1 / 20).task
    ways = [column / [small.metre, small.metre, 1.0] for column in (rows.poses, rows.next_poses)]
    assert np.abs(ways[1] - ways[0])[:, 1:, :2].max() < 0.2  # [m]
    poses, next_poses = (own_data.in_task_units(small, states) for states in ways)
    found = own_data.figures(small, rows._replace(poses=poses, next_poses=next_poses))
    assert found == pytest.approx(own_data.figures(TASK, rows))


def test_a_run_stores_them_sealed_and_tells_of_their_file(tmp_path, generated):
    poses = generated[0].poses.copy()
    poses[:2] = TASK.start
    rows = generated[0]._replace(poses=poses)
    own_data.store(tmp_path, CONFIG, OwnData(rows, ORIGIN), "box2d")
    stored = dataset.read(tmp_path / "transitions.npz", TASK)
    assert np.array_equal(stored.poses, rows.poses)
    assert versions.sealed_digest(tmp_path / "transitions.npz") is not None
    made_by = versions.generator(tmp_path)
    assert made_by["data"] == ORIGIN and "core_sha256" not in made_by
    told = run_folder.read_json(tmp_path / "generation.json")["data"]
    successes = int(rows.terminated.sum())
    assert told == {**ORIGIN, "transitions": 300, "successes": successes, "at_start": 2}
    assert own_data.words(told) == (
        f"300 transitions of mine.npz (SHA-256 abc…), {successes} of which succeed"
    )
    assert own_data.words({**told, "name": None}).startswith(
        "300 transitions of arrays (SHA-256 abc…), "
    )
