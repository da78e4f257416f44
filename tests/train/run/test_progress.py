"""Checks what a run shows of itself, on a terminal and elsewhere."""

import io
from dataclasses import replace

import pytest
from rich.console import Console
from rtg import _core, paths
from rtg.run.progress import LiveDisplay, PlainDisplay, display
from rtg.run.run_state import RateMeter, RunState
from rtg.run.time_left import TimeLeft, usual_rate

GENERATING = RunState(
    phase="tree 1", layer=2, depth=24, transitions=1234, target=60000, contact_share=0.417
)
TRAINING = replace(GENERATING, phase="finished", interactions=10_000, budget=350_000, rate=812.3)


def plain(*states):
    out = io.StringIO()
    with display(out, 100.0) as shown:
        assert isinstance(shown, PlainDisplay)
        for state in states:
            shown.show(state)
    return [line.split("] ", 1)[1] for line in out.getvalue().splitlines()]


def test_elsewhere_there_is_one_line_per_layer_and_no_control_character():
    lines = plain(GENERATING, GENERATING, replace(GENERATING, layer=3, starts_reached=1))
    assert lines == [
        "1,234 of 60,000 transitions: tree 1, layer 2/24, contact share 0.42",
        "1,234 of 60,000 transitions: tree 1, layer 3/24, contact share 0.42, starts reached: 1",
    ]


def test_elsewhere_training_says_every_tenth_of_the_budget_and_every_evaluation():
    states = [replace(TRAINING, interactions=n) for n in (5_000, 20_000, 34_000, 36_000, 60_000)]
    states += [replace(states[-1], evaluations=n, success_rate=0.5) for n in (1, 1, 2)]
    lines = [line for line in plain(*states) if "interactions/s" in line]
    assert lines == [
        "36,000 of 350,000 interactions: success -, 812 interactions/s, at most 6:47 left",
        "60,000 of 350,000 interactions: success 0.50, 812 interactions/s, at most 6:17 left",
        "60,000 of 350,000 interactions: success 0.50, 812 interactions/s, at most 6:17 left",
    ]


def test_elsewhere_the_last_line_of_each_half_says_that_the_results_are_to_come():
    end = "contact share 0.42, results to come"
    made = replace(GENERATING, phase="finished", transitions=60_000)
    (line,) = plain(made)
    assert line.endswith(end)
    (*_, line) = plain(made, replace(TRAINING, interactions=350_000))
    assert line.endswith("812 interactions/s, results to come")


@pytest.mark.parametrize(
    ("budget", "words"),
    [
        (6000, "at most 1:40 left"),  # 20 s + 60 s at 100 interactions/s + results
        (0, "about 0:24 left"),
    ],
)
def test_elsewhere_the_time_left_is_a_bound_where_training_may_end_early(
    monkeypatch, budget, words
):
    clock = iter((0.0, 10.0))
    monkeypatch.setattr("rtg.run.progress.time.monotonic", lambda: next(clock))
    begun = replace(GENERATING, transitions=0, budget=budget)
    _, line = plain(begun, replace(begun, layer=3, transitions=20_000))
    assert line.endswith(f", {words}")


def test_nothing_is_said_about_a_generation_that_has_not_begun():
    assert plain(RunState(budget=1000), RunState(budget=1000)) == []


def test_a_terminal_shows_no_generation_where_there_is_none():
    out = io.StringIO()
    with LiveDisplay(Console(file=out, force_terminal=True, width=100), 100.0) as shown:
        shown.show(RunState(generates=False, budget=1000))
    assert "train" in out.getvalue() and "starting" in out.getvalue()
    assert "generate" not in out.getvalue() and "transitions" not in out.getvalue()


def test_a_terminal_shows_a_bar_with_words_for_each_half_of_the_run():
    out = io.StringIO()
    console = Console(file=out, force_terminal=True, width=100)
    with LiveDisplay(console, 100.0) as shown:
        shown.show(TRAINING)
        shown.note("reverse_worker_0 was killed by SIGKILL, started again")
    text = out.getvalue()
    for words in (
        "generate",
        "1,234 of    60,000",
        "train",
        "10,000 of   350,000",
        "success -",
        "SIGKILL",
    ):
        assert words in text


def test_a_terminal_shows_the_time_since_the_command_and_what_is_left(monkeypatch):
    monkeypatch.setattr("rtg.run.progress.process_age", lambda: 83.2)
    out = io.StringIO()
    with LiveDisplay(Console(file=out, force_terminal=True, width=100), 100.0) as shown:
        shown.show(replace(GENERATING, transitions=0, budget=1000))
        before = out.tell()
        shown.show(RunState(generates=False, budget=10_000, interactions=4_000, rate=100.0))
    first, last = out.getvalue()[:before], out.getvalue()[before:]
    assert "1:23" in first and "left" not in first
    assert "1:23, at most 1:20 left" in last


def test_a_terminal_says_when_only_the_results_are_to_come(monkeypatch):
    monkeypatch.setattr("rtg.run.progress.process_age", lambda: 3.2)
    out = io.StringIO()
    with LiveDisplay(Console(file=out, force_terminal=True, width=100), 100.0) as shown:
        shown.show(replace(GENERATING, phase="finished", transitions=60_000))
    assert "0:03, results to come" in out.getvalue()


def test_the_time_left_is_that_of_both_halves_at_their_rates_and_of_the_results():
    left = TimeLeft(usual_rate=600.0)
    assert left.seconds(RunState(), 0.0) is None, "nothing is known yet"
    begun = replace(GENERATING, transitions=0, target=1000, budget=6000)
    assert left.seconds(begun, 0.0) is None
    assert left.seconds(replace(begun, transitions=100), 10.0) == pytest.approx(90.0 + 10.0 + 20.0)
    done = replace(begun, transitions=1000, interactions=3000, rate=100.0)
    assert left.seconds(done, 100.0) == pytest.approx(30.0 + 20.0)
    assert left.seconds(replace(done, interactions=6000), 130.0) == 0.0


def test_more_gradient_steps_are_expected_to_take_longer():
    file = paths.CONFIG / "gathering.yaml"

    def rate(*settings):
        return usual_rate(_core.Config.from_file(file, list(settings)).train)

    assert rate("train.gradient_steps=4") == pytest.approx(rate() / 4)
    assert rate("train.train_frequency=8") == pytest.approx(rate() * 2)


def test_without_training_there_is_no_bar_of_it():
    out = io.StringIO()
    with LiveDisplay(Console(file=out, force_terminal=True, width=100), 100.0) as shown:
        shown.show(GENERATING)
    assert "run " in out.getvalue() and "generate" in out.getvalue()
    assert "train " not in out.getvalue()


def test_the_rate_is_that_of_the_last_stretch():
    meter = RateMeter(window=10.0)
    assert meter.rate(0, 0.0) == 0.0
    assert meter.rate(100, 1.0) == 100.0
    for second in range(2, 30):
        rate = meter.rate(100 + 5 * second, float(second))
    assert rate == pytest.approx(5.0)


def test_a_rate_is_never_negative_when_the_count_falls_back_to_a_checkpoint():
    meter = RateMeter(window=10.0)
    meter.rate(12_000, 0.0)
    assert meter.rate(10_000, 1.0) == 0.0
    assert meter.rate(10_500, 2.0) == 500.0
