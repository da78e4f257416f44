"""Seconds of learning over several processes."""

import pytest
from rtg.learn.clock import Clock

NAMES = {"monotonic": 0, "process_time": 1, "thread_time": 2}


@pytest.fixture
def now(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Sets what the clocks of the system say: wall, process, thread."""
    times = [100.0, 10.0, 5.0]
    for name, place in NAMES.items():
        monkeypatch.setattr(f"time.{name}", lambda place=place: times[place])
    return times


@pytest.mark.parametrize(("alone", "cpu"), [(True, 0.5), (False, 0.25)])
def test_wall_and_processor_time_count_while_it_runs(now, alone: bool, cpu: float) -> None:
    """Processor time is the process's, or the thread's where others share the process."""
    clock = Clock()
    assert not clock.running and clock.seconds() == {"wall_s": 0.0, "cpu_s": 0.0}
    clock.start(alone)
    now[:] = [102.0, 10.5, 5.25]
    assert clock.running and clock.seconds() == {"wall_s": 2.0, "cpu_s": cpu}
    clock.stop()
    now[:] = [1e3, 1e3, 1e3]
    assert not clock.running and clock.seconds() == {"wall_s": 2.0, "cpu_s": cpu}


def test_what_is_prepared_before_it_starts_takes_processor_time_but_no_wall_time(now) -> None:
    clock = Clock()
    now[:] = [130.0, 12.0, 5.0]
    clock.start()
    now[:] = [131.0, 12.5, 5.0]
    clock.stop()
    assert clock.seconds() == {"wall_s": 1.0, "cpu_s": 2.5}
    now[:] = [140.0, 20.0, 5.0]
    clock.start()
    assert clock.seconds() == {"wall_s": 1.0, "cpu_s": 2.5}, (
        "what happened in between is not its own"
    )


def test_the_next_process_adds_to_it(now) -> None:
    clock = Clock()
    clock.restore({"wall_s": 7.0, "cpu_s": 3.0, "interactions": 80})
    clock.start()
    now[:] = [101.0, 10.5, 5.0]
    assert clock.seconds() == {"wall_s": 8.0, "cpu_s": 3.5}
