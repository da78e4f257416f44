"""LCM's own programs: lcm-spy with our types, lcm-logger."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

from rtg import paths
from rtg.errors import RunError

_TYPES_JAR = paths.BUILD / "msgs" / "rtg_msgs.jar"


def lcm_program(name: str) -> Path:
    """The program itself. The scripts of that name in .venv/bin only start it as a child."""
    spec = importlib.util.find_spec("lcm")
    if spec is None or spec.origin is None:
        raise RunError("the Python package lcm is missing: start through ./run.sh")
    return Path(spec.origin).parents[1] / "bin" / name


def logger_command(url: str, log: Path) -> list[str | Path]:
    """lcm-logger, which adds everything on the bus at `url` to `log`."""
    return [lcm_program("lcm-logger"), "--quiet", "--append", f"--lcm-url={url}", log]


def _build_types_jar() -> None:
    """The build made none if there was no JDK then; there may be one now."""
    for command in (
        ["cmake", "--preset", "release"],
        ["cmake", "--build", "--preset", "release", "--target", "rtg_msgs_jar"],
    ):
        done = subprocess.run(command, cwd=paths.ROOT, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RunError(f"{' '.join(command)} failed:\n{done.stdout}{done.stderr}")


def _types_jar() -> Path | None:
    if not _TYPES_JAR.is_file() and shutil.which("javac") and shutil.which("jar"):
        _build_types_jar()
    return _TYPES_JAR if _TYPES_JAR.is_file() else None


def lcm_spy(url: str) -> None:
    """Becomes lcm-spy. Raises RunError with the remedy if this machine cannot show it."""
    if shutil.which("java") is None:
        raise RunError("lcm-spy needs Java: apt-get install default-jdk. Without: ./run.sh spy")
    if not os.environ.get("DISPLAY"):
        raise RunError(
            "lcm-spy needs a graphical display (DISPLAY is not set); in a terminal: ./run.sh spy"
        )
    jar = _types_jar()
    if jar is None:
        print(
            "rtg: no JDK, so lcm-spy will show our channels undecoded: apt-get install default-jdk",
            file=sys.stderr,
        )
    program = lcm_program("lcm-spy")
    environment = {**os.environ, "CLASSPATH": str(jar or "")}
    os.execve(program, [str(program), f"--lcm-url={url}"], environment)
