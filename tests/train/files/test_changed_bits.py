"""A single changed bit is found in every file of a run that is read back."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from rtg import _core
from rtg.errors import UserError
from rtg.files import best_episode, checkpoint, dataset, run_folder, versions
from rtg.learn import networks, policy_file
from rtg.run import effective_config
from samples import random_transitions
from training_runs import TINY

CONFIG = _core.Config.from_file(TINY)
TASK = CONFIG.task
FLIPS = 1000


class Kind(NamedTuple):
    """How a file of the run folder is written and read back."""

    write: Callable[[Path], object]
    read: Callable[[Path], object]


def write_policy(path: Path) -> None:
    network = networks.make(CONFIG.train.network, TASK.observation_size, TASK.headings)
    policy_file.write(path, TASK, CONFIG.train, network.state_dict())


def write_transitions(path: Path) -> None:
    dataset.write(path, random_transitions(20), dataset.origin_of(CONFIG))


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
    "versions.json": Kind(lambda path: versions.write(path.parent, {}), JSON.read),
    "config.yaml": Kind(
        lambda path: run_folder.write_config(path, CONFIG.yaml), effective_config.load_written
    ),
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


def test_objects_and_arrays_of_others_have_no_digest(tmp_path: Path) -> None:
    for text, known in {"{}": {}, '{"a": "' + "0" * 63 + '"}': {"a": "0" * 63}}.items():
        (tmp_path / "a.json").write_text(text)
        assert run_folder.read_json(tmp_path / "a.json") == known
    np.savez(tmp_path / best_episode.FILE, poses=np.ones((2, 4, 3)), success=True)
    assert best_episode.read(tmp_path, 4)[1]
