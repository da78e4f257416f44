"""Checks what a run says it was made with."""

import json
import platform
import re

import pytest
from rtg import _core, engines
from rtg.errors import UserError
from rtg.files import versions
from training_runs import TINY


def test_versions_name_what_a_run_was_made_with():
    found = versions.versions("box2d")
    assert found["packages"]["lcm"] == "1.5.3"
    revision = found["git_revision"]
    assert revision is None or re.fullmatch("[0-9a-f]{40}", revision)
    assert set(found["debian"]) >= {"libbox2d-dev", "libeigen3-dev", "libsleef-dev"}
    if platform.machine() == "x86_64":
        assert found["instruction_set"].startswith(("x86-64-v", "native"))


def test_a_commit_says_whether_files_were_changed():
    assert versions.commit({"git_revision": "abc", "git_modified": False}) == "abc"
    assert versions.commit({"git_revision": "abc", "git_modified": True}) == "abc-modified"
    assert versions.commit({"git_revision": None}) is None


def test_a_run_that_another_commit_goes_on_with_says_so(tmp_path, monkeypatch):
    for revision in ("older", "old", "old", "new"):
        monkeypatch.setattr(versions, "_revision", lambda revision=revision: (revision, False))
        versions.write(tmp_path, "box2d", {})
    found = json.loads((tmp_path / versions.FILE).read_text())
    assert (found["git_revision"], found["begun_by"]) == ("new", ["older", "old"])


def test_a_run_goes_on_with_its_forward_simulator_alone(tmp_path):
    engine = engines.identity(_core.Config.from_file(TINY))
    versions.check_engine(tmp_path, "newton")  # nobody has worked on it
    versions.write(tmp_path, engine)
    assert versions.generator(tmp_path)["forward_engine"] == "box2d " + _core.BOX2D_VERSION
    versions.check_engine(tmp_path, engine)
    with pytest.raises(UserError, match=r"begun with the forward simulator box2d 2\.\d\.\d, and"):
        versions.check_engine(tmp_path, "newton")


def test_unknown_makers_stay_unknown(tmp_path):
    assert versions.generator(tmp_path) == {}
    versions.write(tmp_path, "box2d", {})
    assert versions.generator(tmp_path) == {}
