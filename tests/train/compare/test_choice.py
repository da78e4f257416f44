"""The executors by name, and what is said where one cannot be had."""

import sys

import pytest
from rtg.compare.executors.choice import EXECUTORS, opened
from rtg.compare.executors.local import LocalExecutor
from rtg.errors import UserError


def test_without_a_choice_jobs_run_on_this_machine(tmp_path):
    with opened(EXECUTORS[0], {}, tmp_path) as executor:
        assert isinstance(executor, LocalExecutor)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["submitit", "ray"])
def test_a_missing_package_is_named(name, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(UserError) as told, opened(name, {}, tmp_path):
        pytest.fail("cannot be opened")
    assert str(told.value).startswith(f"--executor {name} needs the Python package {name}, which")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"cluster": "moon"}, "AutoExecutor doesn't know any executor named moon"),
        ({"cluster": "local", "nonsense": 1}, "Parameter 'nonsense' need to be prefixed"),
        ({"cluster": "local", "timeout_min": "soon"}, 'Parameter "timeout_min" expected type'),
    ],
)
def test_illegal_options_of_submitit_are_named(options, words, tmp_path):
    pytest.importorskip("submitit", reason="extra slurm")
    with pytest.raises(UserError) as told, opened("submitit", options, tmp_path):
        pytest.fail("cannot be opened")
    assert str(told.value).startswith(f"--executor submitit: {words}")


def test_without_slurm_nothing_runs_here_unasked(tmp_path, monkeypatch):
    pytest.importorskip("submitit", reason="extra slurm")
    monkeypatch.setenv("PATH", str(tmp_path))
    with (
        pytest.raises(UserError, match=r"or cluster=local$"),
        opened("submitit", {}, tmp_path),
    ):
        pytest.fail("cannot be opened")


def test_illegal_options_of_ray_are_named():
    pytest.importorskip("ray", reason="extra ray")
    from rtg.compare.executors.ray_tasks import RayExecutor

    with pytest.raises(UserError, match=r"^--executor ray: .*nonsense"):
        RayExecutor({"nonsense": 1})
