"""Checks what `rtg spy` shows, from messages on a bus within this process."""

import asyncio
import io
import time

import pytest
from rich.console import Console
from rtg import _core, paths
from rtg.bus.bus import open_bus
from rtg.bus.channel_monitor import ChannelMonitor
from rtg.bus.node_status import ENDED, NodeStatus
from rtg.bus.spy import Picture, SpyApp, bandwidth, run_name, watch_plainly
from rtg.files.run_folder import write_run_name


class Bus:
    """Passes to a monitor what is published, with the header of a run."""

    def __init__(self):
        self.waiting, self.run = [], "a run"

    def publish(self, channel, kind, **fields):
        bus = open_bus("memq://", _core.RunKey.random(self.run))
        bus.subscribe(channel, kind, lambda message: self.say(channel, kind, message))
        bus.publish(channel, kind, **fields)
        bus.spin(0.0)

    def say(self, channel, kind="", message=None):
        self.waiting.append((channel, 57, kind, message))

    def spin(self, timeout, handler):
        waiting, self.waiting = self.waiting, []
        for words in waiting:
            handler(*words)
        return len(waiting)


@pytest.fixture
def bus():
    return Bus()


@pytest.fixture
def monitor(bus):
    return ChannelMonitor(bus)


def publish(bus):
    bus.publish("RTG_STATUS", "node_status_t", node="reverse_worker", number=3, state="busy")
    bus.say("RTG_STATUS")


def test_the_plain_table_names_channels_types_and_nodes(bus, monitor):
    publish(bus)
    out = io.StringIO()
    watch_plainly(monitor, 0.0, out)
    assert out.getvalue().startswith("no message heard: no run is on this bus, or ")
    monitor.listen(0.0)
    watch_plainly(monitor, 0.0, out)
    lines = [line.split() for line in out.getvalue().splitlines()[1:]]
    assert lines[0] == ["run", f"{_core.run_id('a run') % 2**64:016x}"[:8]]
    assert lines[1] == ["node", "pid", "state", "done", "rate", "CPU"]
    assert lines[2][:2] == ["reverse_worker", "3"] and lines[2][3] == "busy"
    assert lines[4] == ["channels", "of", "all", "runs"]
    assert lines[5] == ["channel", "type", "messages", "rate", "bandwidth", "undecodable"]
    assert lines[6] == ["RTG_STATUS", "node_status_t", "2", "0.0", "Hz", "0.0", "B/s", "1"]
    assert "\x1b" not in out.getvalue()


def test_the_terminal_monitor_shows_what_is_heard_and_pauses(bus, monitor):
    async def use():
        app = SpyApp(monitor)
        async with app.run_test(size=(120, 30)) as pilot:
            publish(bus)
            monitor.listen(0.0)
            app.refresh_picture()
            await pilot.pause()
            assert "reverse_worker" in app.export_screenshot()
            await pilot.press("space")
            bus.publish("RTG_TAIL", "stream_tail_t")
            monitor.listen(0.0)
            app.refresh_picture()
            await pilot.pause()
            assert "RTG_TAIL" not in app.export_screenshot()
            await pilot.press("q")

    asyncio.run(use())


def publish_run(bus, run, phase, counters=()):
    bus.run = run
    bus.publish("RTG_PROGRESS", "search_progress_t", phase=phase, transitions=12_345, target=60_000)
    for number, node in enumerate(("forward_sim_server", "trainer")):
        bus.publish(
            "RTG_STATUS",
            "node_status_t",
            node=node,
            number=number,
            state="learning",
            done=1_234_567,
            counter_name=list(counters),
            counter_value=[7] * len(counters),
        )


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
        bus.publish(channel, "stream_tail_t")
    monitor.listen(0.0)


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
    bus.say("RTG_STATUS")
    monitor.listen(0.0)
    assert "undecodable" in shown(monitor, 56)


def test_a_small_terminal_shows_the_runs_first(bus, monitor, two_runs):
    async def use():
        app = SpyApp(monitor)
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
    ours = open_bus("memq://", _core.RunKey.random("a run"))
    said = lambda message: bus.say("RTG_STATUS", "node_status_t", message)  # noqa: E731
    ours.subscribe("RTG_STATUS", "node_status_t", said)
    status = NodeStatus(ours, "trainer")
    ours.count("bus.malformed")
    ours.count("bus.malformed")
    status.tick("learning", 400)
    status.tick("learning", 401)  # too early to say more
    ours.spin(0.0)
    monitor.listen(0.0)
    (row,) = monitor.runs(time.monotonic())[0].nodes
    assert (row.name, row.state, row.done) == ("trainer 0", "learning", 400)
    assert row.counters == "bus.malformed 2"
    assert monitor.channels()[0].messages == 1
    status.tick(ENDED, 402)  # a new state is said at once
    ours.spin(0.0)
    monitor.listen(0.0)
    (row,) = monitor.runs(time.monotonic())[0].nodes
    assert (row.state, row.done) == (ENDED, 402)
