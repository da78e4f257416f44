"""Child processes: they end with their parent, are replaced when they may be, and never linger."""

import os
import signal
import subprocess
import sys
import textwrap
import time

import pytest
from rtg import paths
from rtg.errors import RunError, UserError
from rtg.processes.children import Node
from rtg.processes.graph import ProcessGraph

SLEEP = [sys.executable, "-c", "import signal; signal.pause()"]
# Two generations, deaf to SIGTERM; says when both are there.
STUBBORN = [
    sys.executable,
    "-c",
    textwrap.dedent(
        """
        import os, signal
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        child = os.fork()
        if child:
            print(child, flush=True)
        signal.pause()
        """
    ),
]


def is_alive(pid):
    """Zombies are dead."""
    try:
        with open(f"/proc/{pid}/stat") as stat:
            return stat.read().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def wait_for(condition):
    deadline = time.monotonic() + 120.0  # longer is a hang
    while not condition():
        assert time.monotonic() < deadline, "never came true"
        time.sleep(0.02)


@pytest.fixture
def graph(tmp_path):
    graph = ProcessGraph(tmp_path / "logs")
    yield graph
    graph.kill()


def test_stop_ends_even_the_deaf_and_their_children(tmp_path):
    graph = ProcessGraph(tmp_path)
    graph.add("stubborn", STUBBORN)
    log = tmp_path / "stubborn.log"
    wait_for(lambda: log.read_text().endswith("\n"))
    child = int(log.read_text())
    assert is_alive(child)
    graph.stop()
    assert not graph.working()
    wait_for(lambda: not is_alive(child))


def test_a_dead_helper_is_started_again_and_counted(graph):
    graph.add("coordinator", SLEEP)
    graph.add("worker", SLEEP, helper=True)
    assert graph.check_and_restart() == []
    worker = graph.pids()["worker"]
    os.kill(worker, signal.SIGKILL)
    wait_for(lambda: not is_alive(worker))
    assert graph.check_and_restart() == ["worker was killed by SIGKILL, started again"]
    assert graph.restarts == 1
    assert graph.pids()["worker"] != worker


def test_a_helper_that_says_good_bye_is_let_go_only_at_the_end(graph):
    graph.add("coordinator", SLEEP)
    graph.add("worker", ["true"], helper=True)
    worker = graph.pids()["worker"]
    wait_for(lambda: not is_alive(worker))
    assert graph.check_and_restart(leaving=True) == []
    assert graph.check_and_restart() == []  # the news may still be on their way
    notes = []
    wait_for(lambda: notes.extend(graph.check_and_restart()) or notes)
    assert notes == ["worker ended with exit status 0, started again"]


def test_any_other_dead_program_ends_the_run_with_its_last_words(graph):
    graph.add("trainer", [sys.executable, "-c", "print('out of memory'); raise SystemExit(3)"])
    while graph.wait(60.0):
        pass
    with pytest.raises(RunError) as error:
        graph.check_and_restart()
    assert "trainer ended with exit status 3" in str(error.value)
    assert str(error.value).endswith("out of memory")


def test_bad_input_of_a_program_is_bad_input_of_the_run(graph):
    command = "print('reading'); print('trainer: model.pt: damaged'); raise SystemExit(2)"
    graph.add("trainer", [sys.executable, "-c", command])
    while graph.wait(60.0):
        pass
    with pytest.raises(UserError, match=r"^trainer: model\.pt: damaged$"):
        graph.check_and_restart()


def test_a_program_that_is_spared_may_fail_and_is_reported(graph):
    graph.add(
        "coordinator", [sys.executable, "-c", "print('one was skipped'); raise SystemExit(1)"]
    )
    graph.add("trainer", ["true"])
    graph.ignore_failure("coordinator")
    while graph.wait(60.0):
        assert graph.check_and_restart() == []
    assert graph.check_and_restart() == []
    (words,) = graph.failures()
    assert words.startswith("coordinator ended with exit status 1")
    assert words.endswith("one was skipped")


def test_a_helper_that_cannot_even_start_ends_the_run(graph):
    graph.add("coordinator", SLEEP)
    graph.add("worker", [sys.executable, "-c", "raise SystemExit('no such library')"], helper=True)
    with pytest.raises(RunError, match=r"(?s)no such library.*died 10 times in a row"):
        while True:
            worker = graph.pids()["worker"]
            wait_for(lambda pid=worker: not is_alive(pid))
            graph.check_and_restart()


def test_deaths_after_a_long_life_do_not_add_up(graph, monkeypatch):
    graph.add("coordinator", SLEEP)
    graph.add("worker", ["false"], helper=True)
    for death in range(1, 13):
        monkeypatch.setattr("rtg.processes.graph._QUICK_DEATH_AGE", 0.0 if death == 6 else 1e9)
        worker = graph.pids()["worker"]
        wait_for(lambda pid=worker: not is_alive(pid))
        graph.check_and_restart()
    assert graph.restarts == 12


def test_the_end_of_a_log_is_that_of_the_last_start(tmp_path):
    node = Node("one", [sys.executable, "-c", "print('first')"], tmp_path / "log")
    assert node.wait(60.0)
    node.command = ["true"]
    node.start()
    assert node.wait(60.0)
    assert node.log_tail() == ""
    assert node.log.read_text() == "first\n"


def test_a_killed_parent_takes_its_children_along(tmp_path):
    program = f"""
import signal
from pathlib import Path
from rtg.processes.children import Node
node = Node("child", {SLEEP!r}, Path({str(tmp_path / "log")!r}))
print(node.pid, flush=True)
signal.pause()
"""
    parent = subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(paths.ROOT / "train")},
    )
    child = int(parent.stdout.readline())
    assert is_alive(child)
    parent.kill()
    parent.wait()
    wait_for(lambda: not is_alive(child))


def test_a_program_that_has_ended_is_never_signalled_again(tmp_path, monkeypatch):
    node = Node("short", ["true"], tmp_path / "log")
    assert node.wait(60.0)
    monkeypatch.setattr(os, "killpg", lambda *_: pytest.fail("its id may be another's by now"))
    node.signal_group(signal.SIGKILL)
