"""The command: its page and its data are for this machine alone, and a signal ends it."""

import contextlib
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("rerun", reason="the extra view is not installed")

from rtg import paths
from rtg.errors import RunError
from rtg.view import view, web_page
from view_runs import finished, free_pair

PATIENCE = 120.0  # [s]; longer is a hang


@pytest.fixture(scope="module")
def folder(tmp_path_factory, rows):
    return finished(tmp_path_factory.mktemp("view") / "run", rows)


def start(*words, home=None):
    return subprocess.Popen(
        [sys.executable, "-m", "rtg.cli", "view", *map(str, words)],
        env={**os.environ, "PYTHONPATH": str(paths.ROOT / "train"), "HOME": str(home or "/")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def listening(pids):
    """Returns the addresses, in hexadecimal, on which processes take connections."""
    sockets = set()
    for pid in pids:
        for link in Path(f"/proc/{pid}/fd").iterdir():
            with contextlib.suppress(FileNotFoundError):  # closed since it was listed
                target = os.readlink(link)
                if target.startswith("socket:["):
                    sockets.add(target[8:-1])
    lines = [
        line.split()
        for table in ("tcp", "tcp6")
        for line in Path(f"/proc/net/{table}").read_text().splitlines()[1:]
    ]
    return {line[1].split(":")[0] for line in lines if line[3] == "0A" and line[9] in sockets}


def children(pid):
    return [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def test_it_listens_on_this_machine_alone_until_a_signal(folder, tmp_path):
    port = free_pair()
    process = start(folder, "--port", port, "--no-browser", home=tmp_path)
    first = process.stdout.readline()
    assert first == f"http://127.0.0.1:{port}/ shows {folder}, with the data on port {port + 1}\n"
    below = children(process.pid)
    assert below and listening([process.pid, *below]) == {"0100007F"}
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, errors
    assert "Traceback" not in errors
    assert not any(Path(f"/proc/{pid}").exists() for pid in below)
    assert list(tmp_path.rglob("*rerun*")) == []  # no settings, no events to be reported


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["--port", "80"], "rtg: --port 80: legal: a number from 1024 to 65534"),
        (["--port", "x"], "rtg: --port x: legal: a number from 1024 to 65534"),
    ],
)
def test_a_port_has_to_be_legal(folder, words, why):
    process = start(folder, *words)
    _, errors = process.communicate(timeout=PATIENCE)
    assert (process.returncode, errors) == (2, f"{why}\n")


def test_two_views_need_two_ports(folder):
    port = free_pair()
    with web_page.WebPage(port, 1, 1):
        process = start(folder, "--port", port)
        _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 2
    assert errors.startswith(f"rtg: --port: 127.0.0.1:{port}: address already in use; legal: ")


def test_a_viewer_that_cannot_start_is_named(folder, monkeypatch):
    monkeypatch.setattr(view, "_program", lambda: Path("/bin/false"))
    with pytest.raises(RunError, match="rerun analytics disable failed"):
        view.serve(folder, free_pair(), False, print)
    monkeypatch.setattr(view, "_without_analytics", lambda settings: [])
    with pytest.raises(RunError, match="rerun does not listen:"):
        view.serve(folder, free_pair(), False, print)


def test_a_package_without_the_program_is_named(folder, monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(RunError, match="rerun-sdk lacks its program rerun; legal: a wheel for"):
        view.serve(folder, free_pair(), False, print)
