"""Checks what a process hears and says, on a bus within it and on a network of its own."""

import os
import stat
import sys
from pathlib import Path

import numpy as np
import pytest
from rtg import _core, paths
from rtg.bus import new_key
from rtg.bus.bus import defect, listen, open_bus, read_key
from rtg.errors import RunError, UserError
from time_limit import run

NETWORK = paths.ROOT / "tests" / "support" / "private_network.sh"
URL = "udpm://239.255.76.67:7667"
REMEDY = "To mend it: sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo"


@pytest.fixture
def ours():
    return open_bus("memq://", _core.RunKey.random("a run"))


def heard_by(receiver, channel="RTG_TAIL", name="stream_tail_t"):
    messages = []
    receiver.subscribe(channel, name, messages.append)
    return messages


def test_a_message_arrives_with_the_header_of_its_run(ours):
    heard = heard_by(ours)
    ours.publish("RTG_TAIL", "stream_tail_t", count=3)
    assert ours.spin(0.0) == 1 and ours.spin(0.0) == 0
    (message,) = heard
    assert (message.run, message.protocol) == (_core.run_id("a run"), 2)
    assert (message.sender, message.count, message.stream) == (os.getpid(), 3, 0)
    assert ours.counters == {} and ours.warning == "" and ours.run == "a run"


def test_arrays_and_texts_arrive(ours):
    acks = heard_by(ours, "RTG_ACK", "stream_ack_t")
    states = heard_by(ours, "RTG_STATUS", "node_status_t")
    ours.publish("RTG_ACK", "stream_ack_t", first=np.arange(3), last=[4, 5, 6])
    ours.publish("RTG_STATUS", "node_status_t", counter_name=["a", "b"], counter_value=[1, 2])
    ours.spin(0.0)
    assert acks[0].first.tolist() == [0, 1, 2] and acks[0].last.dtype == np.int64
    assert states[0].counter_name == ["a", "b"] and states[0].n == 2


def test_what_could_steer_a_terminal_arrives_as_question_marks(ours):
    heard = heard_by(ours, "RTG_STATUS", "node_status_t")
    ours.publish("RTG_STATUS", "node_status_t", node="\x1b[2J\x9b\nworker")
    ours.spin(0.0)
    assert heard[0].node == "?[2J???worker"  # U+009B has two bytes


def test_run_ids_are_the_published_hash_of_the_name():
    """FNV-1a's value of the empty text and of "a", as signed numbers."""
    assert _core.run_id("") % 2**64 == 0xCBF29CE484222325
    assert _core.run_id("a") % 2**64 == 0xAF63DC4C8601EC8C


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_numbers_that_are_none_are_counted_and_not_heard(ours, value):
    heard = heard_by(ours, "RTG_STATUS", "node_status_t")
    ours.publish("RTG_STATUS", "node_status_t", cpu_s=value)
    ours.spin(0.0)
    assert heard == [] and ours.counters == {"bus.not_finite": 1}


@pytest.mark.parametrize(
    ("type_name", "fields", "error", "words"),
    [
        ("stream_tail_t", {"counts": 1}, TypeError, "are fields of stream_tail_t"),
        ("stream_tail_t", {"count": "many"}, TypeError, "'count' cannot hold"),
        ("stream_tail_t", {"count": 2**64}, TypeError, "'count' cannot hold"),
        ("stream_ack_t", {"first": [1], "last": []}, RuntimeError, "counts do not match"),
        ("node_status_t", {"state": "x" * 60_000}, RuntimeError, "longer than one datagram"),
        ("tail_t", {}, ValueError, "no type of message 'tail_t'"),
    ],
)
def test_what_is_no_message_is_not_sent(ours, type_name, fields, error, words):
    with pytest.raises(error, match=words):
        ours.publish("RTG_TAIL", type_name, **fields)
    assert ours.spin(0.0) == 0


def test_what_a_handler_raises_comes_out_of_spin_and_the_next_message_is_heard(ours):
    heard = []

    def handler(message):
        heard.append(message.count)
        if message.count == 0:
            raise KeyError("boom")

    ours.subscribe("RTG_TAIL", "stream_tail_t", handler)
    for count in (0, 1):
        ours.publish("RTG_TAIL", "stream_tail_t", count=count)
    with pytest.raises(KeyError, match="boom"):
        ours.spin(0.0)
    ours.spin(0.0)
    assert heard == [0, 1]


def test_a_bus_without_subscriptions_hears_nothing(ours):
    heard = heard_by(ours)
    ours.publish("RTG_TAIL", "stream_tail_t", count=3)
    ours.unsubscribe()
    ours.spin(0.0)
    assert heard == []


def test_a_listener_says_nothing():
    listener = listen("memq://", "a run")
    with pytest.raises(RuntimeError, match="a listener sends nothing"):
        listener.publish("RTG_TAIL", "stream_tail_t", count=3)


def test_a_new_key_is_its_owners_alone(tmp_path):
    file = tmp_path / "run.key"
    assert new_key.main([str(file), "a run"]) == 0
    assert read_key(file).name == "a run" and stat.S_IMODE(file.stat().st_mode) == 0o600
    file.chmod(0o644)
    with pytest.raises(UserError, match=r"run\.key: others can read or write it"):
        read_key(file)


def test_a_key_that_cannot_be_written_is_told(tmp_path, capsys):
    assert new_key.main([str(tmp_path / "none" / "run.key"), "a run"]) == 1
    assert "none/run.key cannot be written: No such file" in capsys.readouterr().err
    assert new_key.main([str(tmp_path / "run.key")]) == 2


def test_a_bus_of_one_process_is_none_for_a_process_graph():
    words = "memq:// is for one process only; run.bus = udpm://… is for several"
    assert defect("memq://") == words


PRELUDE = f"""
import os, signal
from rtg import _core
from rtg.bus.bus import defect, listen, open_bus
URL = {URL!r}
key = _core.RunKey.random("a run")
"""


def said(program, *network):
    """Returns what a Python program prints, by default on a network of its own."""
    done = run(*(network or [NETWORK]), sys.executable, "-c", PRELUDE + program)
    if done.returncode == 77 or "unshare" in done.stderr:
        pytest.skip("this machine forbids network namespaces")
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_a_network_with_a_multicast_route_has_no_defect():
    assert said("print(defect(URL))") == "None"


def test_a_machine_without_any_network_has_one():
    why = said("print(defect(URL))", "unshare", "--map-root-user", "--net")
    assert why == f"multicast group 239.255.76.67 cannot be joined: No such device. {REMEDY}"


def test_a_bus_that_cannot_be_opened_is_told():
    program = """
try:
    open_bus(URL, key)
except Exception as error:
    print(type(error).__name__, error)"""
    assert said(program, "unshare", "--map-root-user", "--net") == (
        f"{RunError.__name__} bus: multicast group 239.255.76.67 cannot be joined: No such device. "
        f"{REMEDY}"
    )


def test_a_listener_without_the_key_hears_the_run_and_no_other():
    program = """
ours, other = open_bus(URL, key), open_bus(URL, _core.RunKey.random("another run"))
listener, heard = listen(URL, "a run"), []
listener.subscribe("RTG_TAIL", "stream_tail_t", lambda message: heard.append(message.count))
for bus, count in ((other, 1), (ours, 2)):
    bus.publish("RTG_TAIL", "stream_tail_t", count=count)
listener.spin(5.0)
print(heard, listener.counters)"""
    assert said(program) == "[2] {'bus.foreign_run': 1}"


def test_a_monitor_hears_all_of_all():
    program = """
monitor, heard = _core.BusMonitor(URL), []
ours = open_bus(URL, key)
ours.publish("RTG_TAIL", "stream_tail_t", count=2)
ours.send("OTHER", b"rubbish")
while len(heard) < 3:
    monitor.spin(5.0, lambda *words: heard.append(words))
for channel, size, kind, message in heard[1:]:
    print(channel, size, repr(kind), message and message.count)"""
    assert said(program) == "RTG_TAIL 57 'stream_tail_t' 2\nOTHER 7 '' None"


def test_a_signal_ends_the_wait_and_is_counted():
    program = """
ours = open_bus(URL, key)
signal.signal(signal.SIGALRM, lambda number, frame: None)
signal.setitimer(signal.ITIMER_REAL, 0.1)
print(ours.spin(50.0), ours.counters)"""
    assert said(program) == "0 {'bus.interrupted': 1}"


def test_a_receive_buffer_that_the_kernel_cuts_is_told_with_the_remedy():
    """A network namespace has the limit of the machine; only its root can lower it."""
    limit = int(Path("/proc/sys/net/core/rmem_max").read_text())
    told = said("print(open_bus(URL, key).warning)")
    if limit >= 4 << 20:
        assert told == ""
    else:
        assert told == (
            f"bus: receive buffer is {limit >> 10} kB instead of 4096 kB; bursts will be lost and "
            "sent again. To raise it: sysctl -w net.core.rmem_max=4194304"
        )
