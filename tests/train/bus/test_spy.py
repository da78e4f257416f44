"""Checks what `rtg spy` shows, from messages on a bus within this process."""

import asyncio
import io
import time

import pytest
from rtg.bus.bus import Bus
from rtg.bus.channel_monitor import ChannelMonitor
from rtg.bus.messages import message_type
from rtg.bus.node_status import ENDED, NodeStatus
from rtg.bus.spy import SpyApp, bandwidth, watch_plainly


@pytest.fixture
def bus():
    return Bus("memq://", "a run")


@pytest.fixture
def monitor(bus):
    monitor = ChannelMonitor()
    bus.watch(".*", lambda channel, data: monitor.on_message(channel, data, time.monotonic()))
    return monitor


def publish(bus):
    status = message_type("node_status_t")()
    status.node, status.number, status.state = "reverse_worker", 3, "busy"
    bus.publish("RTG_STATUS", status)
    bus.send("RTG_STATUS", b"rubbish")


def test_the_plain_table_names_channels_types_and_nodes(bus, monitor):
    publish(bus)
    out = io.StringIO()
    watch_plainly(bus, monitor, 0.0, out)
    assert out.getvalue().startswith("no message heard: no run is on this bus, or ")
    bus.spin(0.0)
    watch_plainly(bus, monitor, 0.0, out)
    lines = [line.split() for line in out.getvalue().splitlines()[1:]]
    assert lines[0] == ["channel", "type", "messages", "rate", "bandwidth", "undecodable"]
    assert lines[1] == ["RTG_STATUS", "node_status_t", "2", "0.0", "Hz", "0.0", "B/s", "1"]
    assert lines[4][:2] == ["reverse_worker", "3"] and lines[4][3] == "busy"
    assert "\x1b" not in out.getvalue()


def test_the_terminal_monitor_shows_what_is_heard_and_pauses(bus, monitor):
    async def use():
        app = SpyApp(bus, monitor)
        async with app.run_test(size=(120, 30)) as pilot:
            publish(bus)
            bus.spin(0.0)
            app.refresh_picture()
            await pilot.pause()
            assert "reverse_worker" in app.export_screenshot()
            await pilot.press("space")
            bus.publish("RTG_TAIL", message_type("stream_tail_t")())
            bus.spin(0.0)
            app.refresh_picture()
            await pilot.pause()
            assert "RTG_TAIL" not in app.export_screenshot()
            await pilot.press("q")

    asyncio.run(use())


def test_bandwidth_has_fitting_units():
    assert bandwidth(0.0) == "0.0 B/s"
    assert bandwidth(12345.0) == "12.3 kB/s"
    assert bandwidth(999_990.0) == "1.0 MB/s"
    assert bandwidth(2.5e9) == "2.5 GB/s"


def test_a_python_node_is_shown_like_any_other(bus, monitor):
    status = NodeStatus(bus, "trainer")
    bus.counters["bus.malformed"] = 2
    status.tick("learning", 400)
    status.tick("learning", 401)  # too early to say more
    bus.spin(0.0)
    (row,) = monitor.nodes(time.monotonic())
    assert (row.name, row.state, row.done) == ("trainer 0", "learning", 400)
    assert row.counters == "bus.malformed 2"
    assert monitor.channels()[0].messages == 1
    status.tick(ENDED, 402)  # a new state is said at once
    bus.spin(0.0)
    (row,) = monitor.nodes(time.monotonic())
    assert (row.state, row.done) == (ENDED, 402)
