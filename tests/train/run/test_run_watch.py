"""Checks what is known of a run by the messages of its processes."""

from types import SimpleNamespace

import numpy as np
from rtg import _core
from rtg.bus.bus import open_bus
from rtg.run.run_state import RunState
from rtg.run.run_watch import RunWatch


def test_counters_of_a_process_and_of_its_successor_add_up():
    handlers = {}
    bus = SimpleNamespace(subscribe=lambda channel, kind, handler: handlers.update({kind: handler}))
    watch = RunWatch(bus, RunState())
    for sender, count in ((1, 3), (1, 5), (2, 4)):  # a process, later, and its successor
        status = {"node": "reverse_worker", "number": 0, "sender": sender}
        counters = {"counter_name": ["jobs"], "counter_value": np.array([count])}
        handlers["node_status_t"](SimpleNamespace(**status, **counters))
    assert watch.counters() == {"jobs": 9}


def test_the_progress_of_the_coordinator_is_shown():
    bus = open_bus("memq://", _core.RunKey.random("test"))
    watch = RunWatch(bus, RunState(budget=9, interactions=8))
    bus.publish(
        "RTG_PROGRESS",
        "search_progress_t",
        phase="tree 2",
        layer=3,
        depth=40,
        transitions=500,
        target=49000,
        contact_share=0.25,
        starts_reached=6,
        workers=2,
    )
    bus.spin(0.0)
    assert watch.state == RunState(
        phase="tree 2",
        layer=3,
        depth=40,
        transitions=500,
        target=49000,
        contact_share=0.25,
        starts_reached=6,
        workers=2,
        interactions=8,
        budget=9,
    )
