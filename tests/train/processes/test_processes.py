"""Child processes: they end with their parent, tell why they failed, and never linger."""

import os
import signal
import subprocess
import sys
import textwrap
import time

import pytest
from rtg import paths
from rtg.errors import RunError, UserError
from rtg.processes.children import Node, stop_all

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


def test_stop_ends_even_the_deaf_and_their_children(tmp_path):
    log = tmp_path / "log"
    node = Node("stubborn", STUBBORN, log)
    wait_for(lambda: log.read_text().endswith("\n"))
    child = int(log.read_text())
    assert is_alive(child)
    stop_all([node], grace=0.5)
    assert node.exit_status() == -signal.SIGKILL
    wait_for(lambda: not is_alive(child))


@pytest.mark.parametrize(
    ("command", "error", "words"),
    [
        (
            "print('out of memory'); raise SystemExit(3)",
            RunError,
            r"^one ended with exit status 3; .*:\nout of memory$",
        ),
        ("import os; os.kill(os.getpid(), 9)", RunError, "^one was killed by SIGKILL$"),
        (
            "print('reading'); print('model.pt: damaged'); raise SystemExit(2)",
            UserError,
            r"^model\.pt: damaged$",
        ),
    ],
)
def test_a_failure_is_told_with_the_last_words(tmp_path, command, error, words):
    node = Node("one", [sys.executable, "-c", command], tmp_path / "log")
    assert node.wait(60.0)
    with pytest.raises(error, match=words):
        node.raise_if_failed()


def test_success_is_no_failure(tmp_path):
    node = Node("one", ["true"], tmp_path / "log")
    assert node.wait(60.0)
    node.raise_if_failed()


def test_lines_of_a_log_are_read_once_and_whole(tmp_path):
    (tmp_path / "log").write_text("of an earlier start\n")
    node = Node("one", ["sh", "-c", "echo one; echo two; printf thr; read wait"], tmp_path / "log")
    assert node.wait(60.0)  # at the end of its input
    assert node.new_log_lines() == ["one", "two"]
    assert node.new_log_lines() == []
    with node.log.open("a") as log:
        log.write("ee\n")
    assert node.new_log_lines() == ["three"]


def test_the_end_of_a_log_is_that_of_the_last_start(tmp_path):
    (tmp_path / "log").write_text("of an earlier start\n")
    node = Node("one", ["true"], tmp_path / "log")
    assert node.wait(60.0)
    assert node.log_tail() == ""
    assert node.log.read_text() == "of an earlier start\n"


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
    parent.wait(60.0)
    wait_for(lambda: not is_alive(child))


def test_a_program_that_has_ended_is_never_signalled_again(tmp_path, monkeypatch):
    node = Node("short", ["true"], tmp_path / "log")
    assert node.wait(60.0)
    monkeypatch.setattr(os, "killpg", lambda *_: pytest.fail("its id may be another's by now"))
    node.signal_group(signal.SIGKILL)
