"""Counts, rates and node states of the channel monitor, with a clock of our own."""

from rtg.bus.channel_monitor import ChannelMonitor, ChannelRow, NodeRow
from rtg.bus.messages import message_type


def status(number=0, done=0, cpu_s=0.0, pid=7, counters=()):
    message = message_type("node_status_t")()
    message.header.sender = pid
    message.node, message.number, message.state = "reverse_worker", number, "busy"
    message.done, message.cpu_s = done, cpu_s
    message.n = len(counters)
    message.counter_name = [name for name, _ in counters]
    message.counter_value = [value for _, value in counters]
    return message.encode()


def nodes(monitor, now):
    """The nodes of the only run."""
    (row,) = monitor.runs(now)
    return row.nodes


def test_a_channel_shows_type_count_rate_and_bandwidth():
    monitor = ChannelMonitor()
    data = message_type("stream_tail_t")().encode()
    for k in range(21):
        monitor.on_message("RTG_TAIL", data, 0.1 * k)
        monitor.sample(0.1 * k)
    (row,) = monitor.channels()
    # 20 messages after the one at the first sample, in 2 s
    assert row == ChannelRow("RTG_TAIL", "stream_tail_t", 21, 10.0, 10.0 * len(data), 0)


def test_rates_forget_what_was_long_ago():
    monitor = ChannelMonitor()
    data = message_type("stream_tail_t")().encode()
    for _ in range(100):
        monitor.on_message("RTG_TAIL", data, 0.0)
    for k in range(20):
        monitor.sample(0.5 * k)
    assert monitor.channels()[0].rate == 0.0
    assert monitor.channels()[0].messages == 100


def test_bytes_of_no_type_and_broken_messages_are_undecodable():
    monitor = ChannelMonitor()
    tail = message_type("stream_tail_t")().encode()
    monitor.on_message("OTHER", b"rubbish", 0.0)
    for data in (tail, tail[:-1], tail + b"x", b""):
        monitor.on_message("RTG_TAIL", data, 0.0)
    other, ours = monitor.channels()
    assert (other.type_name, other.messages, other.undecodable) == ("?", 1, 1)
    assert (ours.type_name, ours.messages, ours.undecodable) == ("stream_tail_t", 4, 3)


def test_a_node_shows_its_state_rate_cpu_and_the_counters_that_count():
    monitor = ChannelMonitor()
    counters = [("bus.malformed", 2), ("jobs.resent", 0), ("bus.foreign_run", 5)]
    for k in range(5):
        monitor.on_message(
            "RTG_STATUS", status(1, done=10 * k, cpu_s=0.25 * k, counters=counters), 0.5 * k
        )
        monitor.sample(0.5 * k)
    (row,) = nodes(monitor, 2.0)
    words = "bus.malformed 2, bus.foreign_run 5"
    assert row == NodeRow("reverse_worker 1", 7, "busy", 40, 20.0, 0.5, words)


def test_a_node_that_falls_silent_says_so():
    monitor = ChannelMonitor()
    monitor.on_message("RTG_STATUS", status(), 0.0)
    assert nodes(monitor, 2.9)[0].state == "busy"
    assert nodes(monitor, 5.0)[0].state == "silent 5 s"


def test_a_trainer_goes_on_after_the_good_bye_or_is_silent():
    message = message_type("node_status_t")()
    message.node, message.state = "trainer", "learning"
    monitor = ChannelMonitor()
    monitor.on_message("RTG_STATUS", message.encode(), 0.0)
    monitor.on_message("RTG_PROGRESS", progress(leaving=1), 0.0)
    assert nodes(monitor, 5.0)[0].state == "silent 5 s"


def test_a_trainer_that_says_so_has_ended():
    message = message_type("node_status_t")()
    message.node, message.state = "trainer", "ended"
    monitor = ChannelMonitor()
    monitor.on_message("RTG_STATUS", message.encode(), 0.0)
    assert nodes(monitor, 0.1)[0].state == "ended"
    assert nodes(monitor, 60.0)[0].state == "ended"


def test_lcm_trying_itself_is_no_channel_of_ours():
    monitor = ChannelMonitor()
    monitor.on_message("LCM_SELF_TEST", b"lcm self test", 0.0)
    assert monitor.channels() == []


def progress(leaving):
    message = message_type("search_progress_t")()
    message.phase, message.leaving = "sealed", leaving
    return message.encode()


def test_a_node_that_falls_silent_after_the_good_bye_has_ended():
    monitor = ChannelMonitor()
    monitor.on_message("RTG_STATUS", status(), 0.0)
    monitor.on_message("RTG_PROGRESS", progress(leaving=0), 0.0)
    assert nodes(monitor, 5.0)[0].state == "silent 5 s"
    monitor.on_message("RTG_PROGRESS", progress(leaving=1), 0.0)
    assert nodes(monitor, 2.9)[0].state == "busy"
    assert nodes(monitor, 5.0)[0].state == "ended"
    assert monitor.runs(5.0)[0].progress.startswith("generation over: ")
    monitor.on_message("RTG_PROGRESS", progress(leaving=0), 0.0)  # resumed
    assert nodes(monitor, 5.0)[0].state == "silent 5 s"


def test_a_restarted_node_counts_from_nothing():
    monitor = ChannelMonitor()
    for k, (pid, done) in enumerate([(7, 0), (7, 1000), (8, 0), (8, 10)]):
        monitor.on_message("RTG_STATUS", status(pid=pid, done=done), float(k))
        monitor.sample(float(k))
    (row,) = nodes(monitor, 3.0)
    assert (row.pid, row.done, row.rate) == (8, 10, 10.0)


def of_run(data, kind, run):
    message = message_type(kind).decode(data)
    message.header.run = run
    return message.encode()


def test_each_run_has_its_own_nodes_and_progress():
    monitor = ChannelMonitor()
    for run, pid in ((5, 50), (-3, 30)):
        monitor.on_message("RTG_STATUS", of_run(status(pid=pid), "node_status_t", run), 0.0)
        if run == 5:
            said = of_run(progress(leaving=0), "search_progress_t", run)
            monitor.on_message("RTG_PROGRESS", said, 0.0)
    first, second = monitor.runs(0.0)
    assert (first.run, first.nodes[0].pid, first.progress[:7]) == (5, 50, "sealed:")
    assert (second.run, second.nodes[0].pid, second.progress) == (-3, 30, "")


def test_runs_that_are_over_come_last():
    monitor = ChannelMonitor()
    for run in (1, 2):
        monitor.on_message("RTG_STATUS", of_run(status(), "node_status_t", run), 0.0)
        said = of_run(progress(leaving=run == 1), "search_progress_t", run)
        monitor.on_message("RTG_PROGRESS", said, 0.0)
    assert [(row.run, row.is_over) for row in monitor.runs(0.1)] == [(1, False), (2, False)]
    assert [(row.run, row.is_over) for row in monitor.runs(9.0)] == [(2, False), (1, True)]


def test_progress_is_one_line():
    monitor = ChannelMonitor()
    monitor.on_message("RTG_STATUS", status(), 0.0)
    assert monitor.runs(0.0)[0].progress == ""
    message = message_type("search_progress_t")()
    message.phase, message.layer, message.depth = "round 1", 3, 24
    message.transitions, message.target = 12345, 60000
    monitor.on_message("RTG_PROGRESS", message.encode(), 0.0)
    words = monitor.runs(0.0)[0].progress
    assert words.startswith("round 1, layer 3/24: 12,345 of 60,000 transitions, ")
