"""When the pictures of the generation are drawn."""

import threading

import pytest
from rtg import paths
from rtg.run import effective_config, results
from rtg.run.early_pictures import EarlyPictures
from rtg.run.plan import RunPlan


@pytest.fixture
def plan(tmp_path):
    config = effective_config.load(paths.CONFIG / "tests" / "tiny.yaml")
    return RunPlan(tmp_path, "x", config, train=True, resume=True, notes=())


@pytest.fixture
def drawn(monkeypatch):
    event = threading.Event()
    monkeypatch.setattr(results, "draw_generation", lambda plan: event.set())
    return event


def test_they_are_drawn_as_soon_as_the_generation_has_ended(plan, drawn) -> None:
    with EarlyPictures(plan) as pictures:
        assert not drawn.wait(0.3)
        plan.report_file.write_text("{}")
        assert drawn.wait(20.0)
        pictures.finish()


def test_those_of_an_earlier_generation_that_begins_anew_are_not(plan, drawn) -> None:
    plan.report_file.write_text("{}")
    with EarlyPictures(plan) as pictures:
        assert not drawn.wait(0.5)
        pictures.finish()
    assert drawn.is_set()


def test_a_run_that_fails_draws_none_of_an_earlier_generation(plan, drawn) -> None:
    plan.report_file.write_text("{}")
    with pytest.raises(KeyError), EarlyPictures(plan):
        raise KeyError
    assert not drawn.is_set()


def test_those_of_a_generation_that_is_complete_are_drawn_at_once(plan, drawn, monkeypatch) -> None:
    monkeypatch.setattr(RunPlan, "is_generated", lambda plan: True)
    plan.report_file.write_text("{}")
    with EarlyPictures(plan) as pictures:
        assert drawn.wait(20.0)
        pictures.finish()


def test_without_a_generation_there_are_none(plan, drawn) -> None:
    with EarlyPictures(plan) as pictures:
        pictures.finish()
    assert not drawn.is_set()


def test_an_error_of_drawing_reaches_the_run(plan, monkeypatch) -> None:
    def fail(plan: RunPlan) -> None:
        raise OSError("disk full")

    monkeypatch.setattr(results, "draw_generation", fail)
    plan.report_file.write_text("{}")
    with EarlyPictures(plan) as pictures, pytest.raises(OSError, match="disk full"):
        pictures.finish()
