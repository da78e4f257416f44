"""What the set-up says to somebody who waits for it."""

import shutil
import subprocess

from rtg import paths

NINJA = """#!/bin/sh
case "$*" in
*-n*) for k in $(seq 40); do echo "[$k/40] Building"; done ;;
esac
"""


def set_up(folder, command):
    """stderr of one command in a checkout that has nothing but a configured build."""
    shutil.copy(paths.ROOT / "setup.sh", folder)
    programs = {"ninja": NINJA, "nproc": "#!/bin/sh\necho 2\n"}
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
    assert said == "rtg: building build/release: 40 steps, about 2 min on 2 cores\n"


def test_the_first_call_says_that_it_is_the_first(tmp_path):
    assert set_up(tmp_path, "lock_setup").startswith("rtg: first call: sets everything up, ")
    (tmp_path / ".venv" / ".made-from").touch()
    assert set_up(tmp_path, "lock_setup") == ""
