"""RTG as others install it: a wheel in an environment of its own, and the C++ libraries."""

import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path

import network
import numpy as np
import pytest
import rtg
import time_limit
from rtg import paths
from small_examples import NAMES, SMALL

PARTS = """
import gymnasium, numpy, rtg
task = rtg.load_task("push_t")
found = rtg.ReverseSimulator(task).solve(task.goal_state(1), range(task.actions))
assert found.solved.sum() > 10
environment = gymnasium.make("RTG/Gathering-v0")
environment.reset(seed=1)
environment.step(3)
task = rtg.load_task("gathering")
data = rtg.Transitions.joined(rtg.generate(task, 400))
policy = rtg.train(data, task, "trained", settings=["train.interactions=80"])
assert policy(task.start()[None]).shape == (1,)
print(rtg.__file__)
"""

EXAMPLES = """
import importlib, pathlib, pkgutil, rtg.examples
names = sorted(module.name for module in pkgutil.iter_modules(rtg.examples.__path__))
for name in names:
    if name[0].isdigit() and name != "11_own_engine":  # which needs an extra
        example = importlib.import_module(f"rtg.examples.{name}")
        example.main(pathlib.Path("."), **SMALL.get(name, {}))
"""


OF_THE_SYSTEM = {"libc", "libm", "libgcc_s", "libstdc++", "libpthread", "libglib-2", "libpcre2-8"}
TOOLS = f"{Path(sys.executable).parent}:{os.environ['PATH']}"  # CMake and Ninja among them
# One process compiles: other tests run beside. By these names of the compilers ccache has what the
# release build has compiled.
COMPILERS = {"CC": "/usr/bin/cc", "CXX": "/usr/bin/c++"}
BUILDING = {**os.environ, **COMPILERS, "PATH": TOOLS, "CMAKE_BUILD_PARALLEL_LEVEL": "1"}
REPAIR = (sys.executable, "-m", "auditwheel", "repair", "--exclude", "liblcm.so.1")
BUILD_PATIENCE = 3000.0  # [s]


def run(command: Sequence[str | Path], **options: object) -> str:
    done = time_limit.run(*command, **{"env": BUILDING, "timeout": BUILD_PATIENCE, **options})
    assert done.returncode == 0, (done.stdout + done.stderr)[-4000:]
    return done.stdout


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A virtual environment with nothing but the wheel, for any machine, and what it depends on."""
    folder = tmp_path_factory.mktemp("package")
    build = [sys.executable, "-m", "pip", "wheel", paths.ROOT, "--wheel-dir", folder / "wheels"]
    below = f"build-dir={paths.ROOT / 'build' / 'wheel'}"
    run([*build, "--no-deps", "--no-build-isolation", "--config-settings", below])
    (here,) = (folder / "wheels").iterdir()
    run([*REPAIR, here, "--wheel-dir", folder / "repaired"])
    (wheel,) = (folder / "repaired").iterdir()
    assert "manylinux" in wheel.name
    run([sys.executable, "-m", "venv", folder / "environment"])
    pinned = paths.ROOT / "train" / "requirements.txt"
    python = folder / "environment" / "bin" / "python"
    run([python, "-m", "pip", "install", "--constraint", pinned, wheel])
    return python


def elsewhere(folder: Path) -> dict[str, object]:
    """Returns options of run(): another folder, and nothing that leads to the checkout."""
    return {"cwd": folder, "env": {"PATH": os.environ["PATH"], "HOME": str(folder)}}


def test_the_parts_work_from_a_wheel_in_any_folder(installed: Path, tmp_path: Path) -> None:
    said = run([installed, "-c", PARTS], **elsewhere(tmp_path))
    assert str(installed.parents[1]) in said
    checked = run([installed.parent / "rtg", "check", "drawer"], **elsewhere(tmp_path))
    assert f"{installed.parents[1]}/lib" in checked and "drawer.yaml: legal" in checked


def test_a_wheel_brings_the_libraries_of_debian(installed: Path) -> None:
    (package,) = installed.parents[1].glob("lib/python*/site-packages/rtg")
    files = [*package.glob("_core.*.so"), *(package / "programs").glob("rtg_*")]
    assert len(files) == 4
    for file in files:
        found = dict(re.findall(r"(\S+) => (\S+)", run(["ldd", file])))
        assert "not" not in found.values()  # as in "=> not found"
        theirs = {
            name for name, path in found.items() if not path.startswith(str(installed.parents[1]))
        }
        assert {name.split(".")[0] for name in theirs} <= OF_THE_SYSTEM, (file, theirs)


def test_the_examples_run_from_a_wheel(installed: Path, tmp_path: Path) -> None:
    run([installed, "-c", f"SMALL = {SMALL}\n{EXAMPLES}"], **elsewhere(tmp_path))
    pictures = {path.stem for path in tmp_path.iterdir()}
    assert pictures >= {name for name in NAMES if name != "11_own_engine"}


def test_an_installed_package_runs_its_processes(installed: Path, tmp_path: Path) -> None:
    network.require()
    small = ["--transitions", "400", "--interactions", "80", "--workers", "1"]
    with network.Network() as own:
        program = installed.parent / "rtg"
        graph = own.start([program, "gathering", *small, "--out", tmp_path / "run"])
        said, _ = graph.communicate(timeout=time_limit.PATIENCE)
    assert graph.returncode == 0, said[-4000:]
    with np.load(tmp_path / "run" / "transitions.npz") as rows:
        assert len(rows["action"]) == 400
    assert rtg.load_policy(tmp_path / "run").task.name == "gathering"


def test_a_project_of_somebody_else_finds_the_libraries(tmp_path: Path) -> None:
    """It is told which processor they are for, solves reverse pushes, and has Box2D's own clock."""
    prefix, build = tmp_path / "prefix", tmp_path / "build"
    run(["cmake", "--install", paths.BUILD, "--prefix", prefix])
    sources = paths.ROOT / "tests" / "consumer"
    configure = ["cmake", "-G", "Ninja", "-S", str(sources), "-B", str(build)]
    configure.append(f"-DCMAKE_PREFIX_PATH={prefix}")
    refused = time_limit.run(*configure, env=BUILDING)
    assert refused.returncode and "rtg is compiled with -march=x86-64-v3." in refused.stderr
    flags = "-march=x86-64-v3 -Wall -Wextra -Werror"
    run([*configure, f"-DCMAKE_CXX_FLAGS={flags}"])
    run(["cmake", "--build", build])
    said = run([build / "consumer", paths.CONFIG / "gathering.yaml"]).split()
    assert int(said[0]) > 10 and int(said[2]) >= 20
