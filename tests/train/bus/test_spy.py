"""Checks what `rtg spy` shows, from messages on a bus within this process."""

import asyncio
import io
import time

import pytest
from rich.console import Console
from rtg import paths
from rtg.bus.bus import PROTOCOL, Bus, run_key
from rtg.bus.channel_monitor import ChannelMonitor
from rtg.bus.messages import message_type
from rtg.bus.node_status import ENDED, NodeStatus
from rtg.bus.spy import Picture, SpyApp, bandwidth, run_name, watch_plainly
from rtg.files.run_folder import write_run_name


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
    assert lines[0] == ["run", f"{run_key('a run') % 2**64:016x}"[:8]]
    assert lines[1] == ["node", "pid", "state", "done", "rate", "CPU"]
    assert lines[2][:2] == ["reverse_worker", "3"] and lines[2][3] == "busy"
    assert lines[4] == ["channels", "of", "all", "runs"]
    assert lines[5] == ["channel", "type", "messages", "rate", "bandwidth", "undecodable"]
    assert lines[6] == ["RTG_STATUS", "node_status_t", "2", "0.0", "Hz", "0.0", "B/s", "1"]
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


def of_run(run, message):
    """Returns the message as a process of another run sends it."""
    message.header.protocol, message.header.run = PROTOCOL, run_key(run)
    return message.encode()


def publish_run(bus, run, phase, counters=()):
    progress = message_type("search_progress_t")()
    progress.phase, progress.transitions, progress.target = phase, 12_345, 60_000
    bus.send("RTG_PROGRESS", of_run(run, progress))
    for number, node in enumerate(("forward_sim_server", "trainer")):
        status = message_type("node_status_t")()
        status.node, status.number, status.state = node, number, "learning"
        status.done, status.n = 1_234_567, len(counters)
        status.counter_name, status.counter_value = list(counters), [7] * len(counters)
        bus.send("RTG_STATUS", of_run(run, status))


def shown(monitor, width):
    out = io.StringIO()
    Console(file=out, width=width).print(Picture(monitor, time.monotonic(), run_name))
    return out.getvalue()


@pytest.fixture
def two_runs(bus, monitor, tmp_path, monkeypatch):
    monkeypatch.setattr(paths, "RUNS", tmp_path)
    for name in ("first", "second"):
        (tmp_path / name).mkdir()
        write_run_name(tmp_path / name, f"{name}-a1b2")
    publish_run(bus, "first-a1b2", "tree 4")
    publish_run(bus, "second-a1b2", "plan 7", ("bus.foreign_run", "units.reissued"))
    for channel in ("RTG_REVERSE_RESULT", "RTG_TRANSITION"):
        bus.send(channel, message_type("stream_tail_t")().encode())
    bus.spin(0.0)


@pytest.mark.parametrize("width", [56, 80, 200])
def test_each_run_has_its_name_progress_and_nodes(monitor, two_runs, width):
    _, first, second = shown(monitor, width).split("run ", 2)
    assert first.startswith("first\n") and second.startswith("second\n")
    assert "tree 4: 12,345 of 60,000" in first and "plan 7: 12,345 of 60,000" in second
    for part in (first, second):
        assert "forward_sim_server 0" in part and "trainer 1" in part
    assert "trainer 1: bus.foreign_run 7" in second and "bus.foreign_run" not in first


def test_a_narrow_terminal_cuts_no_word(monitor, two_runs):
    """Columns are left out instead: of 60 columns, borders take 4."""
    narrow, wide = shown(monitor, 56), shown(monitor, 200)
    assert "…" not in narrow
    assert max(map(len, narrow.splitlines())) <= 56
    for word in ("1,234,567", "learning", "RTG_REVERSE_RESULT", "messages"):
        assert word in narrow
    assert " pid " in wide and " pid " not in narrow
    assert "undecodable" in wide and "undecodable" not in narrow


def test_what_cannot_be_decoded_shows_in_a_narrow_terminal(bus, monitor, two_runs):
    bus.send("RTG_STATUS", b"rubbish")
    bus.spin(0.0)
    assert "undecodable" in shown(monitor, 56)


def test_a_small_terminal_shows_the_runs_first(bus, monitor, two_runs):
    async def use():
        app = SpyApp(bus, monitor)
        async with app.run_test(size=(60, 24)) as pilot:
            app.refresh_picture()
            await pilot.pause()
            picture = app.export_screenshot()
            assert "first" in picture and "second" in picture and "…" not in picture

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
    (row,) = monitor.runs(time.monotonic())[0].nodes
    assert (row.name, row.state, row.done) == ("trainer 0", "learning", 400)
    assert row.counters == "bus.malformed 2"
    assert monitor.channels()[0].messages == 1
    status.tick(ENDED, 402)  # a new state is said at once
    bus.spin(0.0)
    (row,) = monitor.runs(time.monotonic())[0].nodes
    assert (row.state, row.done) == (ENDED, 402)
