"""Times of the stages of learning."""

import time

import pytest
from rtg.learn.stages import STAGES, Stages
from test_ddqn import model, play


@pytest.fixture
def now(monkeypatch: pytest.MonkeyPatch) -> dict[str, float]:
    """Sets what the clocks of the system say."""
    times = {"monotonic": 100.0, "process_time": 70.0, "thread_time": 5.0}
    for name in times:
        monkeypatch.setattr(time, name, lambda name=name: times[name])
    return times


@pytest.mark.parametrize("shared", [False, True])
def test_a_stage_has_the_times_of_its_blocks_and_the_next_process_adds_to_them(
    now: dict[str, float], shared: bool
) -> None:
    """Processor time is the process's; of several learners in one, that of the learner's thread."""
    first = Stages()
    if shared:
        first.share_process()
    for wall, cpu in ((2.0, 1.5), (0.25, 0.125)):
        with first["acting"]:
            now["monotonic"] += wall
            now["thread_time"] += cpu
            now["process_time"] += 2.0 * cpu
        now["monotonic"] += 50.0  # outside of all stages
    cpu_s = 1.625 if shared else 3.25
    nothing = {"wall_s": 0.0, "cpu_s": 0.0}
    expected = {**dict.fromkeys(STAGES, nothing), "acting": {"wall_s": 2.25, "cpu_s": cpu_s}}
    assert first.seconds() == expected
    second = Stages()
    second.restore(first.seconds())
    with second["saving"]:
        now["monotonic"] += 1.0
    assert second.seconds() == {**expected, "saving": {"wall_s": 1.0, "cpu_s": 0.0}}


def test_a_block_that_raises_counts(now) -> None:
    stages = Stages()
    with pytest.raises(ValueError), stages["acting"]:
        now["monotonic"] += 1.0
        raise ValueError
    assert stages.seconds()["acting"]["wall_s"] == 1.0


def test_rounds_of_learning_spend_most_of_their_time_in_stages() -> None:
    one = model()
    begin = time.thread_time()
    play(one, 400)
    spent, found = time.thread_time() - begin, one.stages.seconds()
    during = {name for name, times in found.items() if times["cpu_s"] > 0}
    assert during == {"acting", "environment", "replay", "gradient_steps"}
    assert 0.7 * spent < sum(times["cpu_s"] for times in found.values()) <= spent + 0.01
