"""Counts, rates and node states of the channel monitor, with a clock of our own."""

from types import SimpleNamespace

from rtg.bus.channel_monitor import (
    MOST_CHANNELS,
    MOST_NODES,
    OTHERS,
    ChannelMonitor,
    ChannelRow,
    NodeRow,
)

TAIL = ("RTG_TAIL", 57, "stream_tail_t", SimpleNamespace(run=1))


def status(pid=7, counters=(), **fields):
    message = SimpleNamespace(
        run=1, sender=pid, node="reverse_worker", number=0, state="busy", done=0, cpu_s=0.0
    )
    vars(message).update(fields)
    message.counter_name = [name for name, _ in counters]
    message.counter_value = [value for _, value in counters]
    return "RTG_STATUS", 100, "node_status_t", message


def progress(leaving=0, run=1, phase="sealed", **fields):
    zero = ("layer", "depth", "transitions", "target", "contact_share", "starts_reached", "workers")
    zero += ("jobs_open", "consumers", "slowest_cursor")
    fields = {**dict.fromkeys(zero, 0), **fields}
    message = SimpleNamespace(run=run, phase=phase, leaving=leaving, **fields)
    return "RTG_PROGRESS", 100, "search_progress_t", message


def nodes(monitor, now):
    """The nodes of the only run."""
    (row,) = monitor.runs(now)
    return row.nodes


def test_a_channel_shows_type_count_rate_and_bandwidth():
    monitor = ChannelMonitor()
    for k in range(21):
        monitor.on_message(*TAIL, 0.1 * k)
        monitor.sample(0.1 * k)
    (row,) = monitor.channels()
    # 20 messages after the one at the first sample, in 2 s
    assert row == ChannelRow("RTG_TAIL", "stream_tail_t", 21, 10.0, 10.0 * 57, 0)


def test_rates_forget_what_was_long_ago():
    monitor = ChannelMonitor()
    for _ in range(100):
        monitor.on_message(*TAIL, 0.0)
    for k in range(20):
        monitor.sample(0.5 * k)
    assert monitor.channels()[0].rate == 0.0
    assert monitor.channels()[0].messages == 100


def test_messages_of_no_type_are_undecodable():
    monitor = ChannelMonitor()
    monitor.on_message("OTHER", 7, "", None, 0.0)
    monitor.on_message(*TAIL, 0.0)
    monitor.on_message("RTG_TAIL", 7, "", None, 0.0)
    other, ours = monitor.channels()
    assert (other.type_name, other.messages, other.undecodable) == ("?", 1, 1)
    assert (ours.type_name, ours.messages, ours.undecodable) == ("stream_tail_t", 2, 1)


def test_made_up_channels_runs_and_nodes_take_no_room():
    monitor = ChannelMonitor()
    for k in range(2 * MOST_NODES):
        monitor.on_message(f"CHANNEL_{k}", 7, "", None, 0.0)
        monitor.on_message(*status(number=k), 0.0)
        monitor.on_message(*progress(run=k), 0.0)
    rows = {row.channel: row.messages for row in monitor.channels()}
    assert len(rows) == MOST_CHANNELS + 1 and sum(rows.values()) == 6 * MOST_NODES
    assert rows[OTHERS] > MOST_NODES
    assert len(monitor.runs(0.0)) <= MOST_NODES
    assert sum(len(run.nodes) for run in monitor.runs(0.0)) == MOST_NODES


def test_a_node_shows_its_state_rate_cpu_and_the_counters_that_count():
    monitor = ChannelMonitor()
    counters = [("bus.malformed", 2), ("jobs.resent", 0), ("bus.foreign_run", 5)]
    for k in range(5):
        monitor.on_message(
            *status(number=1, done=10 * k, cpu_s=0.25 * k, counters=counters), 0.5 * k
        )
        monitor.sample(0.5 * k)
    (row,) = nodes(monitor, 2.0)
    words = "bus.malformed 2, bus.foreign_run 5"
    assert row == NodeRow("reverse_worker 1", 7, "busy", 40, 20.0, 0.5, words)


def test_a_node_that_falls_silent_says_so():
    monitor = ChannelMonitor()
    monitor.on_message(*status(), 0.0)
    assert nodes(monitor, 2.9)[0].state == "busy"
    assert nodes(monitor, 5.0)[0].state == "silent 5 s"


def test_a_trainer_goes_on_after_the_good_bye_or_is_silent():
    monitor = ChannelMonitor()
    monitor.on_message(*status(node="trainer", state="learning"), 0.0)
    monitor.on_message(*progress(leaving=1), 0.0)
    assert nodes(monitor, 5.0)[0].state == "silent 5 s"


def test_a_trainer_that_says_so_has_ended():
    monitor = ChannelMonitor()
    monitor.on_message(*status(node="trainer", state="ended"), 0.0)
    assert nodes(monitor, 0.1)[0].state == "ended"
    assert nodes(monitor, 60.0)[0].state == "ended"


def test_lcm_trying_itself_is_no_channel_of_ours():
    monitor = ChannelMonitor()
    monitor.on_message("LCM_SELF_TEST", 13, "", None, 0.0)
    monitor.on_message("RTG_ECHO", 16, "", None, 0.0)
    assert monitor.channels() == []


def test_a_node_that_falls_silent_after_the_good_bye_has_ended():
    monitor = ChannelMonitor()
    monitor.on_message(*status(), 0.0)
    monitor.on_message(*progress(leaving=0), 0.0)
    assert nodes(monitor, 5.0)[0].state == "silent 5 s"
    monitor.on_message(*progress(leaving=1), 0.0)
    assert nodes(monitor, 2.9)[0].state == "busy"
    assert nodes(monitor, 5.0)[0].state == "ended"
    assert monitor.runs(5.0)[0].progress.startswith("generation over: ")
    monitor.on_message(*progress(leaving=0), 0.0)  # resumed
    assert nodes(monitor, 5.0)[0].state == "silent 5 s"


def test_a_restarted_node_counts_from_nothing():
    monitor = ChannelMonitor()
    for k, (pid, done) in enumerate([(7, 0), (7, 1000), (8, 0), (8, 10)]):
        monitor.on_message(*status(pid=pid, done=done), float(k))
        monitor.sample(float(k))
    (row,) = nodes(monitor, 3.0)
    assert (row.pid, row.done, row.rate) == (8, 10, 10.0)


def test_each_run_has_its_own_nodes_and_progress():
    monitor = ChannelMonitor()
    for run, pid in ((5, 50), (-3, 30)):
        monitor.on_message(*status(pid=pid, run=run), 0.0)
        if run == 5:
            monitor.on_message(*progress(run=run), 0.0)
    first, second = monitor.runs(0.0)
    assert (first.run, first.nodes[0].pid, first.progress[:7]) == (5, 50, "sealed:")
    assert (second.run, second.nodes[0].pid, second.progress) == (-3, 30, "")


def test_runs_that_are_over_come_last():
    monitor = ChannelMonitor()
    for run in (1, 2):
        monitor.on_message(*status(run=run), 0.0)
        monitor.on_message(*progress(leaving=run == 1, run=run), 0.0)
    assert [(row.run, row.is_over) for row in monitor.runs(0.1)] == [(1, False), (2, False)]
    assert [(row.run, row.is_over) for row in monitor.runs(9.0)] == [(2, False), (1, True)]


def test_progress_is_one_line():
    monitor = ChannelMonitor()
    monitor.on_message(*status(), 0.0)
    assert monitor.runs(0.0)[0].progress == ""
    said = progress(phase="round 1", layer=3, depth=24, transitions=12345, target=60000)
    monitor.on_message(*said, 0.0)
    words = monitor.runs(0.0)[0].progress
    assert words.startswith("round 1, layer 3/24: 12,345 of 60,000 transitions, ")
