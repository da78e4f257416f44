"""What a consumer of the transition stream takes for rows."""

import numpy as np
import pytest
from rtg import _core
from rtg.bus.bus import open_bus
from rtg.bus.transition_stream import TransitionStream, to_rows
from rtg.errors import RunError
from rtg.files.dataset import Rows


def test_two_streams_are_not_mixed():
    ours = open_bus("memq://", _core.RunKey.random("a run"))
    stream = TransitionStream(ours, bodies=3, actions=48, most=9, sink=print)
    for number in (5, 5, 6):
        ours.publish("RTG_TAIL", "stream_tail_t", stream=number)
    with pytest.raises(RunError, match="the coordinator began another generation"):
        stream.poll(0.0)


def test_rows_come_once_and_in_order_and_the_end_is_acknowledged():
    ours = open_bus("memq://", _core.RunKey.random("a run"))
    acks, got = [], []
    ours.subscribe("RTG_ACK", "stream_ack_t", acks.append)
    stream = TransitionStream(
        ours, bodies=1, actions=48, most=4, sink=lambda rows: got.extend(rows.action)
    )
    for first, actions in ((2, [12, 13]), (0, [10, 11, 12]), (2, [12, 13])):
        n = len(actions)
        state = {"poses": np.zeros(3 * n), "next_poses": np.zeros(3 * n)}
        labels = {
            "action": actions,
            "success": np.zeros(n, np.int8),
            "source": np.zeros(n, np.int8),
        }
        ours.publish(
            "RTG_TRANSITION", "transition_batch_t", first=first, stream=5, **state, **labels
        )
    ours.publish("RTG_TAIL", "stream_tail_t", stream=5, count=4, sealed=1)
    while not stream.complete:
        stream.poll(0.0)
    ours.spin(0.0)
    assert got == [10, 11, 12, 13] and stream.received == 4
    assert (acks[0].first.tolist(), acks[0].last.tolist()) == ([0], [1])  # what was missing
    assert (acks[-1].cursor, acks[-1].credit) == (4, 0)


def test_a_stream_is_no_longer_than_the_search_is_to_find():
    ours = open_bus("memq://", _core.RunKey.random("a run"))
    stream = TransitionStream(ours, bodies=1, actions=48, most=4, sink=print)
    for count in (5, -1, 10**15):
        ours.publish("RTG_TAIL", "stream_tail_t", count=count, sealed=1)
    stream.poll(0.0)
    assert ours.counters == {"stream.illegal": 3} and not stream.complete


class Message:
    """A transition_batch_t of two rows and three bodies."""

    def __init__(self, **changes):
        self.first, self.n, self.n_poses = 4, 2, 18
        self.poses, self.next_poses = tuple(range(18)), tuple(range(18, 36))
        self.action, self.success, self.source = (0, 47), (0, 1), (0, 3)
        self.__dict__.update(changes)


def test_rows_have_the_shapes_of_the_data_set():
    rows = to_rows(Message(), bodies=3, actions=48)
    assert isinstance(rows, Rows)
    assert rows.poses.shape == rows.next_poses.shape == (2, 3, 3)
    assert rows.next_poses[1, 2, 2] == 35.0
    assert rows.reward.tolist() == [0.0, 1.0] and rows.reward.dtype == np.float32
    assert rows.terminated.tolist() == [False, True]
    assert rows.slice(1).action.tolist() == [47]


@pytest.mark.parametrize(
    "changes",
    [
        {"n": 0, "n_poses": 0},
        {"n_poses": 12},
        {"first": -1},
        {"action": (0, 48)},
        {"action": (-1, 0)},
        {"success": (2, 0)},
        {"source": (0, 4)},
    ],
)
def test_a_batch_that_makes_no_sense_is_refused(changes):
    assert to_rows(Message(**changes), bodies=3, actions=48) is None
