"""Checks what the set-up says to somebody who waits for it."""

import shutil
import subprocess

from rtg import paths

NINJA = """#!/bin/sh
case "$*" in
*-n*) {} ;;
esac
"""
FORTY_STEPS = 'for k in $(seq 40); do echo "[$k/40] Building"; done'
CHANGED_LISTS = 'echo "[1/1] Re-running CMake..."'


def set_up(folder, command, dry_run=FORTY_STEPS):
    """stderr of one command in a checkout that has nothing but a configured build."""
    shutil.copy(paths.ROOT / "setup.sh", folder)
    programs = {"ninja": NINJA.format(dry_run), "nproc": "#!/bin/sh\necho 2\n"}
    for name, text in programs.items():
        program = folder / ".venv" / "bin" / name
        program.parent.mkdir(parents=True, exist_ok=True)
        program.write_text(text)
        program.chmod(0o755)
    built = folder / "build" / "release" / "build.ninja"
    built.parent.mkdir(parents=True, exist_ok=True)
    built.touch()
    done = subprocess.run(
        ["bash", "-euc", f"source setup.sh; {command}"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stderr


def test_a_build_says_how_long_it_takes(tmp_path):
    said = set_up(tmp_path, "build_preset release rtg_run")
    assert said == "rtg: building build/release: 40 steps, about 1 min on 2 cores\n"


def test_a_build_whose_steps_are_not_known_says_no_time(tmp_path):
    said = set_up(tmp_path, "build_preset release rtg_run", CHANGED_LISTS)
    assert said == "rtg: building build/release\n"


def test_the_first_call_says_that_it_is_the_first(tmp_path):
    assert set_up(tmp_path, "lock_setup").startswith("rtg: first call: sets everything up, ")
    (tmp_path / ".venv" / ".made-from").touch()
    assert set_up(tmp_path, "lock_setup") == ""


def test_a_linked_environment_is_not_emptied(tmp_path):
    (tmp_path / "train").mkdir()
    for name in ("requirements.txt", "pyproject.toml"):
        shutil.copy(paths.ROOT / "train" / name, tmp_path / "train")
    shutil.copy(paths.ROOT / "setup.sh", tmp_path)
    other = tmp_path / "other"
    other.mkdir()
    (other / "kept").touch()
    (tmp_path / ".venv").symlink_to(other)
    command = ["bash", "-euc", "source setup.sh; setup_python"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 1
    assert f".venv is a link to {other}, whose content would go; remove the link" in done.stderr
    assert (other / "kept").exists()
