import sys
from pathlib import Path

from layering import ROOT, sources
from time_limit import run

TOOLS = Path(sys.executable).parent
TESTS = ROOT / "tests"
PYPROJECT = "pyproject.toml"
PYTHON = ("train", "tests", "msgs", "docs")  # folders


def check(*command: str) -> None:
    done = run(*command, cwd=ROOT)
    assert done.returncode == 0, (done.stdout + done.stderr)[-4000:]


def test_cpp_is_formatted() -> None:
    files = [str(path) for path in sources(".hpp", ".cpp")]
    check(str(TOOLS / "clang-format"), "--dry-run", "-Werror", *files)


def test_cpp_functions_are_small() -> None:
    """Bounds that stop what has got out of hand; ruff has those of Python in pyproject.toml."""
    files = [str(path) for path in sources(".hpp", ".cpp") if not path.is_relative_to(TESTS)]
    bounds = ("--length", "60", "--CCN", "15", "--arguments", "7")
    check(sys.executable, "-m", "lizard", "--languages", "cpp", "--warnings_only", *bounds, *files)


def test_python_is_formatted() -> None:
    check(str(TOOLS / "ruff"), "format", "--check", "--config", PYPROJECT, *PYTHON)


def test_python_is_clean() -> None:
    check(str(TOOLS / "ruff"), "check", "--no-cache", "--config", PYPROJECT, *PYTHON)


def test_python_types_hold() -> None:
    cache = str(ROOT / "build" / "mypy")
    check(str(TOOLS / "mypy"), "--config-file", PYPROJECT, "--cache-dir", cache)


def test_shell_scripts_parse() -> None:
    command = ("git", "ls-files", "*.sh", ".ci/run")
    found = run(*command, cwd=ROOT, check=True)
    scripts = found.stdout.splitlines()
    assert {"run.sh", "graph.sh", ".ci/run"} <= set(scripts)
    for script in scripts:
        check("bash", "-n", script)
