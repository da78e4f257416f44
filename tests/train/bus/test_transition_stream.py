"""The consumer's protocol core against a model of the server, over a network that misbehaves."""

import heapq
import random

import numpy as np
import pytest
from rtg import _core
from rtg.bus.bus import open_bus
from rtg.bus.transition_stream import FINAL_ACKS, StreamCursor, TransitionStream, to_rows
from rtg.errors import RunError
from rtg.files.dataset import Rows


class Server:
    """Sends rows once as they are made, again when asked, ten per message."""

    def __init__(self, total):
        self.total, self.made, self.live, self.asked, self.window = total, 0, 0, set(), 10**9

    def step(self, rng):
        self.made = min(self.total, self.made + rng.randrange(40))
        messages = []
        rows = sorted(self.asked)[:100]
        self.asked.difference_update(rows)
        end = min(self.made, self.live + 100, self.window)
        rows += range(self.live, end)
        self.live = max(self.live, end)
        while rows:
            size = 1
            while size < len(rows) and rows[size] == rows[0] + size and size < 10:
                size += 1
            messages.append(("rows", rows[0], size))
            rows = rows[size:]
        return [*messages, ("tail", self.made, self.made == self.total)]

    def on_ack(self, ack, credit):
        self.window = ack.cursor + credit
        for first, last in ack.missing:
            self.asked.update(range(first, min(last + 1, self.live)))


class Network:
    """Loses, doubles and delays."""

    loss, double, delay = 0.2, 0.1, 0.05  # shares of the messages; at most [s]

    def __init__(self, rng):
        self.rng = rng
        self.flying, self.sent = [], 0

    def send(self, now, to, message):
        for _ in range(1 + (self.rng.random() < self.double)):
            if self.rng.random() >= self.loss:
                self.sent += 1
                arrival = now + self.rng.random() * self.delay
                heapq.heappush(self.flying, (arrival, self.sent, to, message))

    def arrived(self, now):
        while self.flying and self.flying[0][0] <= now:
            _, _, to, message = heapq.heappop(self.flying)
            yield to, message


def consumed(seed, total=1500, credit=200, restart=0.002):
    """Rows that one consumer handed out until it said it was complete."""
    rng = random.Random(seed)
    server, network = Server(total), Network(rng)
    cursor, out, now = StreamCursor(credit), [], 0.0
    while not cursor.complete:
        now += 0.01
        assert now < 600, "no progress"
        for message in server.step(rng):
            network.send(now, "consumer", message)
        for to, message in network.arrived(now):
            if to == "server":
                server.on_ack(message, credit)
            elif message[0] == "tail":
                cursor.on_tail(*message[1:])
            else:
                _, first, size = message
                for rows, skip in cursor.on_rows(first, range(first, first + size), size, now):
                    out.extend(rows[skip:])
        ack = cursor.ack_due(now)
        if ack:
            network.send(now, "server", ack)
        if rng.random() < restart:
            cursor, out = StreamCursor(credit), []
    return out


@pytest.mark.parametrize("block", range(10))
def test_every_row_arrives_once_and_in_order_whatever_the_network_does(block):
    for seed in range(30 * block, 30 * block + 30):
        assert consumed(seed) == list(range(1500)), f"seed {seed}"


def test_a_good_network_needs_no_question():
    cursor = StreamCursor(credit=100)
    for first in range(0, 50, 10):
        assert cursor.on_rows(first, None, 10, now=0.1 * first) == [(None, 0)]
    cursor.on_tail(50, True)
    assert cursor.complete


def test_who_has_all_of_a_sealed_stream_says_so_many_times_and_goes_on_saying_it():
    cursor = StreamCursor(credit=100)
    cursor.on_rows(0, None, 10, now=0.0)
    cursor.on_tail(10, False)
    assert cursor.ack_due(now=1.0) == (10, 100, [])  # not sealed yet
    cursor.on_tail(10, True)
    assert [cursor.ack_due(now=1.0) for _ in range(FINAL_ACKS)] == [(10, 0, [])] * FINAL_ACKS
    assert cursor.ack_due(now=1.1) is None
    assert cursor.ack_due(now=1.6) == (10, 0, [])


def test_a_gap_is_asked_for_at_once_and_again_after_a_while():
    cursor = StreamCursor(credit=100)
    assert cursor.on_rows(10, "b", 10, now=0.0) == []
    assert cursor.ack_due(now=0.0) == (0, 100, [(0, 9)])
    assert cursor.ack_due(now=0.05) is None
    assert cursor.ack_due(now=0.11) == (0, 100, [(0, 9)])
    assert cursor.on_rows(0, "a", 10, now=0.12) == [("a", 0), ("b", 0)]
    assert cursor.cursor == 20


def test_lost_last_rows_are_seen_by_the_tail():
    cursor = StreamCursor(credit=100)
    cursor.on_tail(7, True)
    assert not cursor.complete
    assert cursor.ack_due(now=1.0) == (0, 100, [(0, 6)])


def test_rows_beyond_the_credit_are_neither_held_nor_forgotten():
    cursor = StreamCursor(credit=20)
    assert cursor.on_rows(30, "far", 10, now=0.0) == []
    assert cursor.ack_due(now=1.0) == (0, 20, [(0, 19)])


def test_a_gap_begins_after_the_longest_of_overlapping_pieces():
    cursor = StreamCursor(credit=100)
    cursor.on_rows(10, "long", 20, now=0.0)
    cursor.on_rows(12, "within", 3, now=0.0)
    cursor.on_tail(40, False)
    assert cursor.ack_due(now=1.0) == (0, 100, [(0, 9), (30, 39)])


def test_overlapping_pieces_are_cut():
    cursor = StreamCursor(credit=100)
    assert cursor.on_rows(5, "late", 10, now=0.0) == []
    assert cursor.on_rows(0, "early", 8, now=0.0) == [("early", 0), ("late", 3)]
    assert cursor.on_rows(0, "again", 15, now=0.0) == []


def test_two_streams_are_not_mixed():
    ours = open_bus("memq://", _core.RunKey.random("a run"))
    stream = TransitionStream(ours, bodies=3, actions=48, sink=print)
    for number in (5, 5, 6):
        ours.publish("RTG_TAIL", "stream_tail_t", stream=number)
    with pytest.raises(RunError, match="the coordinator was restarted"):
        stream.poll(0.0)


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
