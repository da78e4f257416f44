"""Files that are none, machines that lack something: a line and a status, no traceback."""

import os
import sys
from pathlib import Path

import pytest
from rtg import cli, paths
from time_limit import run
from training_runs import TINY, run_folder

COMMANDS = {
    "check": ["check", "X.yaml"],
    "print": ["X.yaml", "--print-config"],
    "data": [str(TINY), "--data", "X.npz", "--out", "out"],
    "plot": ["plot", "X"],
    "evaluate": ["evaluate", "X"],
    "minari": ["export", "minari", "X"],
    "lerobot": ["export", "lerobot", "X"],
    "spy": ["spy", "X.yaml"],
    "resume": ["--resume", "--out", "X"],
    "reproduce": ["reproduce", "X.yaml", "--out", "out"],
    "task": ["check", "T.yaml"],
}
MAKERS = {
    "missing": lambda path: None,
    "fifo": os.mkfifo,
    "zero": lambda path: path.symlink_to("/dev/zero"),
    "loop": lambda path: path.symlink_to(path.name),
    "random": lambda path: path.write_bytes(b"\xff\x00PK\x05\x06" * 500),
    "empty": lambda path: path.touch(),
    "folder": lambda path: path.mkdir(),
}


@pytest.mark.parametrize("kind", MAKERS)
@pytest.mark.parametrize("command", COMMANDS)
def test_a_file_that_is_none_is_named(command, kind, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    words = COMMANDS[command]
    name = next((word for word in words if word.startswith("X")), "X.yaml")
    Path("T.yaml").write_text(f"task: {name}\n")
    MAKERS[kind](Path(name))
    assert cli.main(words) == 2
    said = capsys.readouterr().err
    assert name in said and "; legal: " in said and said.count("\n") == 1


RTG = f"{sys.executable} -m rtg"
MAKE = f"{RTG} {TINY} --in-process --workers 1 --transitions 100 --no-train --out"
MOUNT = "mount -t tmpfs -o size=%s none /mnt"
EXPORT = f"{RTG} export minari run --transitions"
VIEW = f"RUST_LOG=off {RTG} view run --save"  # off: Rerun tells of its errors in lines of its own
LACKS = {
    "no reader": (f"set -o pipefail; {RTG} --print-config | true", 1, ""),
    "no output": (f"{RTG} check gathering >&-", 0, ""),
    "full output": (f"{RTG} check gathering >/dev/full", 1, "No space left on device; to mend it"),
    "short files": (f"ulimit -f 1; {MAKE} out", 1, "config.yaml: File too large; to mend it: "),
    "no home": (f"env -u HOME {RTG} check gathering --picture a.png >/dev/null", 0, ""),
    "full disk": (f"{MOUNT % '40k'} && {MAKE} /mnt/out", 1, "No space left on device"),
    "short export": (f"ulimit -f 20; {EXPORT}", 1, "File too large; to mend it: "),
    "full export": (
        f"{MOUNT % '40k'} && {EXPORT} --out /mnt",
        1,
        "No space left on device; to mend",
    ),
    "short view": (f"ulimit -f 20; {VIEW} a.rrd", 1, "a.rrd: File too large; to mend it: "),
    "full view": (
        f"{MOUNT % '40k'} && {VIEW} /mnt/a.rrd",
        1,
        "/mnt/a.rrd: No space left on device",
    ),
    "no descriptors": (
        f"ulimit -n 8; {MAKE} out",
        1,
        "Too many open files; to mend it: allow more",
    ),
    "few descriptors": (f"ulimit -n 12; {MAKE} out", 1, "Too many open files; to mend it: allow"),
    "read-only": (f"{MOUNT % '40k,ro'} && {MAKE} /mnt/out", 2, "/mnt/out: Read-only file system"),
}


@pytest.mark.parametrize("name", LACKS)
def test_what_a_machine_lacks_is_told(name, tmp_path, rows):
    script, status, words = LACKS[name]
    for package, command in {"minari": EXPORT, "rerun": VIEW}.items():
        if command in script:
            pytest.importorskip(package, reason=f"the package {package} is not installed")
            run_folder(tmp_path / "run", rows)
            os.utime(tmp_path / "run/config.yaml", (1e6, 1e6))  # nobody works on it
    sets = {"MINARI_DATASETS_PATH": str(tmp_path / "sets")}
    env = {**os.environ, "PYTHONPATH": str(paths.ROOT / "train"), **sets}
    within = ["unshare", "--map-root-user", "--mount"] if "mount" in script else []
    done = run(*within, "bash", "-c", script, cwd=tmp_path, env=env)
    if "unshare" in done.stderr:
        pytest.skip("this machine forbids namespaces")
    assert (done.returncode, "Traceback" in done.stderr) == (status, False), done.stderr
    assert words in done.stderr and done.stderr.count("\n") == (1 if words else 0)
    assert not [*tmp_path.glob("sets/*/*.part"), *tmp_path.glob("*.rrd")]
