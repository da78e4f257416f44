"""What a listener hears of the transition stream, and that it says nothing."""

import numpy as np
import pytest
from rtg import _core
from rtg.bus.bus import open_bus
from rtg.bus.stream_listener import StreamListener


@pytest.fixture
def bus():
    return open_bus("memq://", _core.RunKey.random("a run"))


@pytest.fixture
def heard(bus):
    found = []
    StreamListener(bus, 2, 48, 12, lambda numbers, rows: found.append((numbers.tolist(), rows)))
    return found


def publish(bus, first, actions):
    n = len(actions)
    bus.publish(
        "RTG_TRANSITION",
        "transition_batch_t",
        first=first,
        poses=[0.5] * n * 6,
        next_poses=[0.5] * n * 6,
        action=actions,
        success=[0] * n,
        source=[0] * n,
    )


def test_rows_come_with_their_numbers_in_the_order_in_which_they_arrive(bus, heard):
    publish(bus, 10, [3, 4])
    publish(bus, 0, [5])
    publish(bus, 10, [3, 4])
    bus.spin(0.0)
    assert [numbers for numbers, _ in heard] == [[10, 11], [0], [10, 11]]
    assert heard[0][1].action.tolist() == [3, 4]
    assert np.all(heard[0][1].poses == 0.5)


def test_illegal_rows_are_counted(bus, heard):
    publish(bus, 0, [48])
    bus.spin(0.0)
    assert heard == [] and bus.counters["stream.illegal"] == 1


@pytest.mark.parametrize("first", [11, 10**12, 2**63 - 1, -1])
def test_rows_that_the_run_cannot_have_are_illegal(bus, heard, first):
    """A listener hears strangers, too: a display kept a terabyte for one row of theirs."""
    publish(bus, first, [3, 4])
    bus.spin(0.0)
    assert heard == [] and bus.counters["stream.illegal"] == 1


def test_a_listener_says_nothing(bus, heard):
    """A consumer would acknowledge; the sender would then wait for it, and count it."""
    said = []
    bus.subscribe("RTG_ACK", "stream_ack_t", said.append)
    bus.subscribe("RTG_STATUS", "node_status_t", said.append)
    for _ in range(3):
        publish(bus, 0, [1, 2])
        bus.publish("RTG_TAIL", "stream_tail_t", count=3, sealed=1)
        bus.spin(0.0)
    assert len(heard) == 3 and said == []
