"""Checks what a process hears and says, on a bus within it and on a network of its own."""

import os
import re
import signal
import subprocess
import sys

import pytest
from rtg import paths
from rtg.bus import bus
from rtg.bus.bus import MAX_MESSAGE_BYTES, Bus, run_key
from rtg.bus.messages import message_type

NETWORK = paths.ROOT / "tests" / "support" / "private_network.sh"


@pytest.fixture
def ours():
    return Bus("memq://", "a run")


def heard_by(receiver, channel="RTG_TAIL", name="stream_tail_t"):
    messages = []
    receiver.subscribe(channel, message_type(name), messages.append)
    return messages


def tail(count=3):
    message = message_type("stream_tail_t")()
    message.count = count
    return message


def test_a_message_arrives_with_the_header_of_its_run(ours):
    heard = heard_by(ours)
    ours.publish("RTG_TAIL", tail())
    assert ours.spin(0.0) == 1 and ours.spin(0.0) == 0
    (message,) = heard
    header = message.header
    assert (header.run, header.protocol, header.sender) == (run_key("a run"), 1, os.getpid())
    assert message.count == 3 and not ours.counters and ours.warning is None


def test_run_keys_are_those_of_the_c_plus_plus_side():
    """FNV-1a's published value of the empty text, as a signed number."""
    assert run_key("") % 2**64 == 0xCBF29CE484222325
    assert run_key("a") % 2**64 == 0xAF63DC4C8601EC8C


def spoilt(**changes):
    message = message_type("stream_ack_t")()
    message.header.run, message.header.protocol = run_key("a run"), bus.PROTOCOL
    for name, value in changes.items():
        setattr(message.header, name, value)
    return message.encode()


REFUSED = {
    "bus.foreign_run": spoilt(run=1),
    "bus.foreign_protocol": spoilt(protocol=2),
    "bus.malformed": spoilt()[:-1],
    "bus.too_long": bytes(MAX_MESSAGE_BYTES + 1),
}


@pytest.mark.parametrize("counter", REFUSED)
def test_what_is_not_for_us_is_counted_and_not_heard(ours, counter):
    heard = heard_by(ours, "RTG_ACK", "stream_ack_t")
    ours.send("RTG_ACK", REFUSED[counter])
    ours.send("RTG_ACK", spoilt())
    ours.spin(0.0)
    assert len(heard) == 1 and ours.counters == {counter: 1}


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_numbers_that_are_none_are_counted_and_not_heard(ours, value):
    heard = heard_by(ours, "RTG_STATUS", "node_status_t")
    message = message_type("node_status_t")()
    message.cpu_s = value
    ours.publish("RTG_STATUS", message)
    ours.spin(0.0)
    assert heard == [] and ours.counters == {"bus.not_finite": 1}


def test_what_does_not_fit_into_a_datagram_is_not_sent(ours):
    message = message_type("node_status_t")()
    message.state = "x" * MAX_MESSAGE_BYTES
    with pytest.raises(ValueError, match="node_status_t: the message is longer than one datagram"):
        ours.publish("RTG_STATUS", message)


def test_what_a_handler_raises_comes_out_of_spin_and_the_next_message_is_heard(ours):
    heard = []

    def handler(message):
        heard.append(message.count)
        if message.count == 0:
            raise KeyError("boom")

    ours.subscribe("RTG_TAIL", message_type("stream_tail_t"), handler)
    ours.publish("RTG_TAIL", tail(0))
    ours.publish("RTG_TAIL", tail(1))
    with pytest.raises(KeyError, match="boom"):
        ours.spin(0.0)
    ours.spin(0.0)
    assert heard == [0, 1]


def test_a_signal_ends_the_wait_and_is_counted(ours):
    heard = heard_by(ours)
    before = signal.signal(signal.SIGALRM, lambda number, frame: None)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.01)
        assert ours.spin(60.0) == 0
    finally:
        signal.signal(signal.SIGALRM, before)
    assert ours.counters == {"bus.interrupted": 1}
    ours.publish("RTG_TAIL", tail())
    assert ours.spin(60.0) == 1 and len(heard) == 1


def test_a_closed_bus_hears_nothing(ours):
    heard = heard_by(ours)
    ours.publish("RTG_TAIL", tail())
    ours.close()
    ours.spin(0.0)
    assert heard == []


def warning(size):
    """Returns the warning of a bus on the network that asks for a buffer of `size` bytes."""
    program = f"""from rtg.bus import bus
bus.RECEIVE_BUFFER = {size}
opened = bus.Bus("udpm://239.255.76.67:7667", "a run")
opened.watch("A", print)
first = opened.warning
opened.watch("B", print)
assert opened.warning == first
print(first)"""
    done = subprocess.run(
        [NETWORK, sys.executable, "-c", program],
        env={**os.environ, "PYTHONPATH": str(paths.ROOT / "train")},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode == 77:
        pytest.skip("this machine forbids network namespaces")
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_a_receive_buffer_that_the_kernel_cuts_is_told_with_the_remedy():
    asked = 1 << 30  # no kernel's limit is that high by default
    found = re.fullmatch(
        r"bus: receive buffer is (\d+) kB instead of 1048576 kB; bursts will be lost and sent "
        r"again\. To raise it: sysctl -w net\.core\.rmem_max=1073741824",
        warning(asked),
    )
    assert found and 100 < int(found[1]) < asked >> 10


def test_a_receive_buffer_as_large_as_asked_needs_no_words():
    assert warning(65536) == "None"
