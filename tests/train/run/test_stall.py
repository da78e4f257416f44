"""When a run that does not get on ends."""

from dataclasses import replace

import pytest
from rtg.errors import RunError
from rtg.run.run_state import RunState
from rtg.run.stall import LIMIT, Stall

STATE = RunState(phase="tree 2", transitions=500, workers=2, interactions=30)


@pytest.mark.parametrize("progress", [{"layer": 1}, {"transitions": 501}, {"interactions": 31}])
def test_a_run_that_gets_on_goes_on(progress):
    stall = Stall(0.0)
    stall.check(STATE, 1.0)
    stall.check(STATE, LIMIT)
    stall.check(replace(STATE, **progress), LIMIT + 2.0)
    stall.check(replace(STATE, **progress), 2.0 * LIMIT)


def test_a_run_that_stands_still_ends_with_a_reason():
    stall = Stall(0.0)
    stall.check(STATE, 1.0)
    words = "no progress for 30 minutes, .*: 500 transitions, 1 workers heard, 30 interactions"
    with pytest.raises(RunError, match=words):
        stall.check(replace(STATE, workers=1), LIMIT + 2.0)
