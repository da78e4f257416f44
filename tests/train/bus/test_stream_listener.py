"""What a listener hears of the transition stream, and that it says nothing."""

import numpy as np
import pytest
from rtg.bus.bus import Bus
from rtg.bus.messages import message_type
from rtg.bus.stream_listener import StreamListener


@pytest.fixture
def bus():
    return Bus("memq://", "a run")


@pytest.fixture
def heard(bus):
    found = []
    StreamListener(bus, 2, 48, lambda numbers, rows: found.append((numbers.tolist(), rows)))
    return found


def publish(bus, first, actions):
    batch = message_type("transition_batch_t")()
    batch.first, batch.n, batch.n_poses = first, len(actions), len(actions) * 6
    batch.poses = batch.next_poses = [0.5] * batch.n_poses
    batch.action, batch.success = actions, [0] * len(actions)
    batch.source = [0] * len(actions)
    bus.publish("RTG_TRANSITION", batch)


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


def test_a_listener_says_nothing(bus, heard):
    """A consumer would acknowledge; the sender would then wait for it, and count it."""
    said = []
    bus.watch("RTG_ACK|RTG_STATUS", lambda channel, data: said.append(channel))
    tail = message_type("stream_tail_t")()
    tail.count, tail.sealed = 3, 1
    for _ in range(3):
        publish(bus, 0, [1, 2])
        bus.publish("RTG_TAIL", tail)
        bus.spin(0.0)
    assert len(heard) == 3 and said == []
