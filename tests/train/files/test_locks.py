"""Locks on files."""

import fcntl
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from rtg import paths
from rtg.errors import UserError
from rtg.files.locks import exclusive_lock, is_locked, lock, try_lock


def test_a_lock_has_one_holder_at_a_time(tmp_path):
    held = try_lock(tmp_path / "lock")
    assert try_lock(tmp_path / "lock") is None
    held.release()
    held.release()
    assert try_lock(tmp_path / "lock") is not None


def test_it_tells_whether_a_file_is_locked_and_leaves_it_as_it_is(tmp_path):
    assert not is_locked(tmp_path / "lock") and not any(tmp_path.iterdir())
    held = try_lock(tmp_path / "lock")
    assert is_locked(tmp_path / "lock") and is_locked(tmp_path / "lock")
    held.release()
    assert not is_locked(tmp_path / "lock")
    held = try_lock(tmp_path / "lock")
    assert held is not None
    held.release()
    (tmp_path / "lock").chmod(0o444)
    assert not is_locked(tmp_path / "lock")


def test_who_asks_whether_a_file_is_locked_is_in_nobodys_way(tmp_path, monkeypatch):
    file = tmp_path / "lock"
    file.touch()
    asked = file.open()
    fcntl.flock(asked, fcntl.LOCK_SH)  # as is_locked() has it for a moment
    monkeypatch.setattr("rtg.files.locks.time.sleep", lambda seconds: asked.close())
    assert try_lock(file) is not None
    assert asked.closed and try_lock(file) is None


def test_a_killed_holder_frees_its_lock(tmp_path):
    program = f"""
import signal
from pathlib import Path
from rtg.files.locks import try_lock
held = try_lock(Path({str(tmp_path / "lock")!r}))
print("held", flush=True)
signal.pause()
"""
    holder = subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(paths.ROOT / "train")},
    )
    assert holder.stdout.readline() == "held\n"
    assert try_lock(tmp_path / "lock") is None
    holder.kill()
    holder.communicate(timeout=60.0)
    assert try_lock(tmp_path / "lock") is not None


def test_who_waits_for_a_lock_gets_it_at_last(tmp_path):
    seen = []

    def enter():
        with lock(tmp_path / "lock"):
            seen.append("waiter")

    with lock(tmp_path / "lock"):
        waiter = threading.Thread(target=enter)
        waiter.start()
        seen.append("holder")
    waiter.join(60.0)
    assert seen == ["holder", "waiter"]


def test_a_folder_in_use_is_named(tmp_path):
    with exclusive_lock(tmp_path, "nobody"):
        with pytest.raises(UserError) as told, exclusive_lock(tmp_path, "somebody"):
            pytest.fail("is locked")
        words = "somebody uses this folder; legal: another folder, or wait"
        assert str(told.value) == f"--out: {tmp_path}: {words}"
    with exclusive_lock(tmp_path, "nobody"):
        pass


def test_a_folder_that_cannot_be_written_is_named():
    with pytest.raises(UserError) as told, exclusive_lock(Path("/proc"), "nobody"):
        pytest.fail("cannot be locked")
    assert str(told.value).startswith("--out: /proc: ")
