"""Checks what is known of a run by the messages of its processes."""

from rtg.bus.bus import Bus
from rtg.bus.messages import message_type
from rtg.run.run_state import RunState
from rtg.run.run_watch import RunWatch


def test_counters_of_a_process_and_of_its_successor_add_up(monkeypatch):
    bus = Bus("memq://", "test")
    watch = RunWatch(bus, RunState())
    for sender, count in ((1, 3), (1, 5), (2, 4)):  # a process, later, and its successor
        status = message_type("node_status_t")()
        status.node, status.n = "reverse_worker", 1
        status.counter_name, status.counter_value = ["jobs"], [count]
        monkeypatch.setattr("os.getpid", lambda sender=sender: sender)
        bus.publish("RTG_STATUS", status)
        bus.spin(0.0)
    assert watch.counters() == {"jobs": 9}


def test_the_progress_of_the_coordinator_is_shown():
    bus = Bus("memq://", "test")
    watch = RunWatch(bus, RunState(budget=9, interactions=8))
    progress = message_type("search_progress_t")()
    progress.phase, progress.layer, progress.depth = "tree 2", 3, 40
    progress.transitions, progress.target = 500, 49000
    progress.contact_share, progress.start_region, progress.workers = 0.25, 6, 2
    bus.publish("RTG_PROGRESS", progress)
    bus.spin(0.0)
    assert watch.state == RunState(
        phase="tree 2",
        layer=3,
        depth=40,
        transitions=500,
        target=49000,
        contact_share=0.25,
        start_region=6,
        workers=2,
        interactions=8,
        budget=9,
    )
