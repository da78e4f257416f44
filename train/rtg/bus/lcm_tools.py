"""LCM's own programs: lcm-spy with the message types of RTG, and lcm-logger.

`python -m rtg.bus.lcm_tools CONFIG.yaml FILE` becomes lcm-logger, which appends all messages on the
bus of that configuration to FILE.
"""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NoReturn

from rtg import _core, paths
from rtg.errors import RunError, UserError, exit_status

_TYPES_JAR = paths.BUILD / "msgs" / "rtg_msgs.jar"


def lcm_program(name: str) -> Path:
    """Returns the path of LCM's binary `name`. Raises RunError if the package lcm is missing.

    It is not the script of that name in .venv/bin, which would start the binary as a child process.
    """
    spec = importlib.util.find_spec("lcm")
    if spec is None or spec.origin is None:
        raise RunError("the Python package lcm is missing: start through ./run.sh, or install lcm")
    return Path(spec.origin).parents[1] / "bin" / name


def _build_types_jar() -> None:
    """Builds the message types for Java. The main build skips them without a JDK.

    Raises RunError if the build fails.
    """
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
    """Replaces this process by lcm-spy. Raises RunError with a remedy if it cannot run here."""
    if shutil.which("java") is None:
        raise RunError(
            f"lcm-spy needs Java: apt-get install default-jdk. Without: {paths.COMMAND} spy"
        )
    if not os.environ.get("DISPLAY"):
        raise RunError(
            "lcm-spy needs a graphical display (DISPLAY is not set); in a terminal: "
            f"{paths.COMMAND} spy"
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


def _become_logger(argv: list[str]) -> NoReturn:
    if len(argv) != 2:
        raise UserError("legal words: CONFIG.yaml FILE")
    url, program = _core.Config.from_file(Path(argv[0])).run.bus, lcm_program("lcm-logger")
    os.execv(program, [str(program), "--quiet", "--append", f"--lcm-url={url}", argv[1]])


def main(argv: list[str]) -> int:
    """Replaces this process by lcm-logger, or returns the exit status of the error."""
    return exit_status("rtg.bus.lcm_tools", lambda: _become_logger(argv))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
