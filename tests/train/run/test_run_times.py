"""Times of a whole run."""

import sys
import time

from rtg.run import run_times
from rtg.run.run_state import RunState
from rtg.run.run_times import RunTimes
from time_limit import run


class Shown:
    """A display that notes what it is asked to show."""

    def __init__(self) -> None:
        self.states, self.notes, self.open = [], [], False

    def __enter__(self):
        self.open = True
        return self

    def __exit__(self, *_):
        self.open = False

    def show(self, state):
        self.states.append(state)

    def note(self, message):
        self.notes.append(message)


def test_the_start_ends_with_the_first_transition_or_interaction(monkeypatch) -> None:
    for begun in (RunState(transitions=3), RunState(interactions=4)):
        ages = iter([1.234, 5.0])
        monkeypatch.setattr(run_times, "process_age", lambda ages=ages: next(ages))
        shown = Shown()
        with RunTimes(shown) as times:
            assert shown.open
            times.show(RunState())
            times.show(begun)
            times.show(RunState(transitions=9))
            times.note("a")
            found = times.seconds()
        assert not shown.open and len(shown.states) == 3 and shown.notes == ["a"]
        assert (found["start_wall_s"], found["run_wall_s"]) == (1.23, 5.0)


def test_without_a_transition_there_is_no_end_of_the_start() -> None:
    assert RunTimes(Shown()).seconds()["start_wall_s"] is None


def test_what_processes_used_that_have_ended_counts() -> None:
    before = RunTimes(Shown()).seconds()["run_cpu_s"]
    busy = "import time\nwhile time.process_time() < 0.5: pass"
    run(sys.executable, "-c", busy, check=True)
    assert RunTimes(Shown()).seconds()["run_cpu_s"] >= before + 0.49


def test_the_age_of_a_process_is_the_time_since_its_start() -> None:
    code = "from rtg.run.clock import process_age; print(process_age())"
    begin = time.monotonic()
    said = run(sys.executable, "-c", code, check=True)
    assert 0.02 < float(said.stdout) <= time.monotonic() - begin + 0.02
