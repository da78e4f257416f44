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
    monkeypatch.setattr(results, "generation_warning", lambda plan: None)
    return event


def test_what_limits_the_generation_is_said_before_the_training(plan, drawn, monkeypatch) -> None:
    monkeypatch.setattr(results, "generation_warning", lambda plan: "no tree reaches the start")
    plan.report_file.write_text("{}")
    for trains in (True, False):
        said = []
        plan = RunPlan(plan.folder, "x", plan.config, train=trains, resume=True, notes=())
        monkeypatch.setattr(RunPlan, "is_generated", lambda plan: True)
        with EarlyPictures(plan, said.append) as pictures:
            pictures.finish()
        assert said == (["no tree reaches the start"] if trains else [])


def test_what_limits_the_generation_is_said_again_when_the_user_stops_the_run(
    plan, drawn, monkeypatch
) -> None:
    monkeypatch.setattr(results, "generation_warning", lambda plan: "no tree reaches the start")
    said = []
    with EarlyPictures(plan, said.append) as pictures:
        pictures.warn_again()
        assert said == [], "the generation is not over"
        plan.report_file.write_text("{}")
        assert drawn.wait(20.0)
        pictures.warn_again()
    assert said == ["no tree reaches the start"] * 2


def test_they_are_drawn_as_soon_as_the_generation_has_ended(plan, drawn) -> None:
    with EarlyPictures(plan, print) as pictures:
        assert not drawn.wait(0.3)
        plan.report_file.write_text("{}")
        assert drawn.wait(20.0)
        pictures.finish()


def test_those_of_an_earlier_generation_that_begins_anew_are_not(plan, drawn) -> None:
    plan.report_file.write_text("{}")
    with EarlyPictures(plan, print) as pictures:
        assert not drawn.wait(0.5)
        pictures.finish()
    assert drawn.is_set()


def test_a_run_that_fails_draws_none_of_an_earlier_generation(plan, drawn) -> None:
    plan.report_file.write_text("{}")
    with pytest.raises(KeyError), EarlyPictures(plan, print):
        raise KeyError
    assert not drawn.is_set()


def test_those_of_a_generation_that_is_complete_are_drawn_at_once(plan, drawn, monkeypatch) -> None:
    monkeypatch.setattr(RunPlan, "is_generated", lambda plan: True)
    plan.report_file.write_text("{}")
    with EarlyPictures(plan, print) as pictures:
        assert drawn.wait(20.0)
        pictures.finish()


def test_without_a_generation_there_are_none(plan, drawn) -> None:
    with EarlyPictures(plan, print) as pictures:
        pictures.finish()
    assert not drawn.is_set()


def test_an_error_of_drawing_reaches_the_run(plan, monkeypatch) -> None:
    def fail(plan: RunPlan) -> None:
        raise OSError("disk full")

    monkeypatch.setattr(results, "draw_generation", fail)
    monkeypatch.setattr(results, "generation_warning", lambda plan: None)
    plan.report_file.write_text("{}")
    with EarlyPictures(plan, print) as pictures, pytest.raises(OSError, match="disk full"):
        pictures.finish()
