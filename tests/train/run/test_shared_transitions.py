"""Checks which transitions of one run are good for another."""

import json

import pytest
from rtg import engines
from rtg.errors import UserError
from rtg.files import run_folder, versions
from rtg.run import effective_config, run_args
from rtg.run.plan import make_plan
from rtg.run.run_args import Override
from rtg.run.shared_transitions import find, generation_key, is_generated, take_over
from training_runs import TINY

CONFIG = effective_config.load(TINY)


def changed(section, key, value):
    config = effective_config.load(TINY, [Override("", f"{section}.{key}={json.dumps(value)}")])
    values, before = map(effective_config.values, (config, CONFIG))
    assert values[section][key] != before[section][key]
    return config


@pytest.fixture
def made(tmp_path):
    """A run of this program that has generated."""
    run = tmp_path / "ddqn_naive" / "seed-1"
    run.mkdir(parents=True)
    (run / "config.yaml").write_text(effective_config.load(TINY).yaml)
    versions.write(run, engines.identity(CONFIG))
    for name in ("transitions.npz", "generation.json"):
        (run / name).write_text(name)
    versions.seal(run / "transitions.npz")
    return run


@pytest.mark.parametrize(
    ("section", "key", "value"),
    [
        ("task", "horizon", 7),
        ("physics", "inertia", True),
        ("forward", "engine", "newton"),
        ("reverse", "late_contacts", 0),
        ("search", "generator", "rrbs"),
        ("search", "transitions", 7),
        ("run", "seed", 7),
    ],
)
def test_what_changes_the_transitions_changes_their_kind(section, key, value):
    assert generation_key(changed(section, key, value)) != generation_key(CONFIG)


@pytest.mark.parametrize(
    ("section", "key", "value"),
    [("train", "batch", 7), ("train", "interact", False), ("run", "workers", 7)],
)
def test_what_changes_how_they_are_learned_from_does_not(section, key, value):
    assert generation_key(changed(section, key, value)) == generation_key(CONFIG)


def test_methods_with_the_same_data_share_them():
    methods = [
        [Override("", f"run.method={name}")] for name in ("ddqn_rtg", "cql_rtg", "ddqn_naive")
    ]
    rtg, cql, naive = (generation_key(effective_config.load(TINY, method)) for method in methods)
    assert rtg == cql != naive


def test_without_offline_data_there_is_none():
    assert generation_key(changed("train", "offline", False)) is None


def test_a_run_of_the_same_kind_is_found_and_taken_over(made, tmp_path):
    assert find(generation_key(CONFIG), tmp_path, "seed-1") == made
    new = tmp_path / "other" / "seed-1"
    new.mkdir(parents=True)
    take_over(made, new)
    assert is_generated(new) and (new / "transitions.npz").read_text() == "transitions.npz"
    names = ["generation.json", "transitions.npz", "versions.json"]
    assert sorted(path.name for path in new.iterdir()) == names
    assert versions.generator(new) == versions.generator(made) != {}


def test_those_of_another_forward_simulator_are_not_found(made, tmp_path):
    found = json.loads((made / "versions.json").read_text())
    found["generator"][versions.ENGINE_KEY] = "box2d 1.0"
    run_folder.write_json(made / "versions.json", found)
    assert find(generation_key(CONFIG), tmp_path, "seed-1") is None


def test_another_kind_or_seed_is_not_found(made, tmp_path):
    assert find(generation_key(changed("search", "generator", "rrbs")), tmp_path, "seed-1") is None
    assert find(generation_key(CONFIG), tmp_path, "seed-2") is None


def test_transitions_that_were_changed_are_neither_taken_over_nor_gone_on_with(made, tmp_path):
    (made / "transitions.npz").write_text("changed")
    new = tmp_path / "other"
    new.mkdir()
    with pytest.raises(UserError, match=r"transitions\.npz: was changed since the run wrote it"):
        take_over(made, new)
    assert list(new.iterdir()) == []
    before = {path: path.read_bytes() for path in made.iterdir()}
    with pytest.raises(UserError, match="or no file, to generate anew"):
        make_plan(run_args.parse(["--resume", "--out", str(made)]))
    assert {path: path.read_bytes() for path in made.iterdir()} == before


def test_a_set_that_was_not_sealed_is_not_whole(made):
    """As if the run was killed between writing and sealing it."""
    versions.write(made, "box2d", {"core_sha256": versions.core_digest()})
    assert not is_generated(made)


DEFECTS = {
    "config.yaml": "search: {unknown: 1}\n",
    "versions.json": '{"generator": {"core_sha256": "another"}}',
    "generation.json": None,
    "transitions.npz": None,
}


@pytest.mark.parametrize("name", DEFECTS)
def test_what_another_program_made_or_is_not_whole_is_not_found(made, tmp_path, name):
    if DEFECTS[name] is None:
        (made / name).unlink()
    else:
        (made / name).write_text(DEFECTS[name])
    assert find(generation_key(CONFIG), tmp_path, "seed-1") is None


def test_what_another_program_made_stays_that_of_the_other(made, tmp_path):
    """It does so even when this one goes on with the run."""
    other = {"git_revision": "another", "core_sha256": "another"}
    versions.write(made, engines.identity(CONFIG), other)
    versions.seal(made / "transitions.npz")
    other["sha256"] = {"transitions.npz": versions.digest(made / "transitions.npz")}
    make_plan(run_args.parse(["--resume", "--out", str(made)]))
    assert versions.generator(made) == other
    assert find(generation_key(CONFIG), tmp_path, "seed-1") is None
    (made / "generation.json").unlink()  # to be generated again
    make_plan(run_args.parse(["--resume", "--out", str(made)]))
    assert versions.generator(made)["core_sha256"] == versions.core_digest()


def test_a_version_without_one_of_the_settings_is_not_found(made, tmp_path):
    lines = (made / "config.yaml").read_text().splitlines(keepends=True)
    kept = [line for line in lines if not line.startswith("  late_contacts:")]
    assert len(kept) == len(lines) - 1
    (made / "config.yaml").write_text("".join(kept))
    assert find(generation_key(CONFIG), tmp_path, "seed-1") is None
