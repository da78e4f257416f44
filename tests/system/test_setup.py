"""Checks what the set-up says to somebody who waits for it."""

import shutil

from rtg import paths
from time_limit import run

GLOBS = 'echo "[0/2] Re-checking globbed directories..."'
FORTY_STEPS = f'{GLOBS}; for k in $(seq 40); do echo "[$k/40] Building"; done'
NOTHING = f'{GLOBS}; echo "ninja: no work to do."'


def set_up(folder, command, ninja=FORTY_STEPS):
    """stderr of one command in a checkout that has nothing but a configured build."""
    shutil.copy(paths.ROOT / "setup.sh", folder)
    programs = {"ninja": f"#!/bin/sh\n{ninja}\n", "nproc": "#!/bin/sh\necho 2\n"}
    for name, text in programs.items():
        program = folder / ".venv" / "bin" / name
        program.parent.mkdir(parents=True, exist_ok=True)
        program.write_text(text)
        program.chmod(0o755)
    built = folder / "build" / "release" / "build.ninja"
    built.parent.mkdir(parents=True, exist_ok=True)
    built.touch()
    words = ["bash", "-euc", f"source setup.sh; {command}"]
    return run(*words, cwd=folder, check=True).stderr


def test_a_build_says_how_long_it_takes(tmp_path):
    said = set_up(tmp_path, "build_preset release rtg_run")
    assert said == "rtg: building build/release: 40 steps, about 1 min on 2 cores\n"


def test_a_build_with_nothing_to_do_says_nothing(tmp_path):
    assert set_up(tmp_path, "build_preset release rtg_run", NOTHING) == ""


def test_the_first_call_says_that_it_is_the_first(tmp_path):
    assert set_up(tmp_path, "lock_setup").startswith("rtg: first call: sets everything up, ")
    (tmp_path / ".venv" / ".made-from").touch()
    assert set_up(tmp_path, "lock_setup") == ""


def test_a_checkout_that_cannot_be_written_is_refused(tmp_path):
    shutil.copy(paths.ROOT / "setup.sh", tmp_path)
    (tmp_path / "build").touch()
    done = run("bash", "-euc", "source setup.sh; lock_setup", cwd=tmp_path)
    why = "cannot be written; legal: a checkout in a folder to write to"
    assert (done.returncode, done.stderr) == (2, f"rtg: {tmp_path}/build {why}\n")


def test_a_linked_environment_is_not_emptied(tmp_path):
    (tmp_path / "train").mkdir()
    shutil.copy(paths.ROOT / "train" / "requirements.txt", tmp_path / "train")
    shutil.copy(paths.ROOT / "setup.sh", tmp_path)
    other = tmp_path / "other"
    other.mkdir()
    (other / "kept").touch()
    (tmp_path / ".venv").symlink_to(other)
    command = ["bash", "-euc", "source setup.sh; setup_python"]
    done = run(*command, cwd=tmp_path)
    assert done.returncode == 1
    assert f".venv is a link to {other}, whose content would go; remove the link" in done.stderr
    assert (other / "kept").exists()
