"""Forward simulators of Python as processes of the graph: mujoco, and a class of the user's."""

from __future__ import annotations

import functools
import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import network
import pytest
from graph import PATIENCE, Graph, Process, finish, first_rows
from rtg import cli, paths

MUJOCO = "forward.engine=mujoco"
ENVIRONMENT = "forward.engine=rtg.examples.environment_engine:Environment"
SMALL = ("gathering", "--no-train", "--transitions", "400", "--set", "search.breadth=4")
NETWORK = paths.ROOT / "tests" / "support" / "private_network.sh"
TOYS = paths.ROOT / "tests" / "train" / "engines"


@pytest.fixture(autouse=True)
def _private_network() -> None:
    network.require()


def run(engine: str, out: Path, *words: str) -> subprocess.CompletedProcess[str]:
    command = [NETWORK, sys.executable, "-m", "rtg.cli", *SMALL, "--set", engine, *words]
    return subprocess.run(
        [*command, "--out", out],
        cwd=paths.ROOT,
        env={**os.environ, "PYTHONPATH": f"{paths.ROOT / 'train'}:{TOYS}"},
        capture_output=True,
        text=True,
        timeout=2 * PATIENCE,
        check=False,
    )


def digest(folder: Path) -> str:
    return str(json.loads((folder / "generation.json").read_text())["rows_sha256"])


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], str]:
    """Returns the digest of the transitions that a run in one process finds with an engine."""

    @functools.cache
    def found(engine: str) -> str:
        if engine == MUJOCO:
            pytest.importorskip("mujoco", reason="the extra `mujoco` is not installed")
        folder = tmp_path_factory.mktemp("in_process") / "run"
        assert cli.main([*SMALL, "--in-process", "--set", engine, "--out", str(folder)]) == 0
        return digest(folder)

    return found


@pytest.mark.parametrize(
    ("engine", "workers"), [(ENVIRONMENT, "2"), (MUJOCO, "1"), (MUJOCO, "2"), (MUJOCO, "4")]
)
def test_the_bytes_are_those_of_a_run_in_one_process(
    tmp_path: Path, expected: Callable[[str], str], engine: str, workers: str
) -> None:
    there = expected(engine)
    done = run(engine, tmp_path / "run", "--workers", workers)
    assert done.returncode == 0, done.stderr
    assert digest(tmp_path / "run") == there


def test_an_engine_that_fails_ends_the_run_with_its_traceback(tmp_path: Path) -> None:
    done = run("forward.engine=toy_engines:Broken", tmp_path / "run")
    assert done.returncode == 1
    assert "forward.engine toy_engines:Broken failed:" in done.stderr
    assert "ZeroDivisionError: no such place" in done.stderr
    assert done.stderr.rstrip().splitlines()[-1].startswith("in the state [[")


@pytest.fixture
def net() -> Iterator[network.Network]:
    with network.Network() as created:
        yield created


@pytest.mark.parametrize("engine", [ENVIRONMENT, MUJOCO])
def test_a_killed_server_is_replaced(
    net: network.Network, tmp_path: Path, expected: Callable[[str], str], engine: str
) -> None:
    there = expected(engine)
    settings = ("search.breadth=4", "search.transitions=400")
    graph = Graph(net, tmp_path, engine, *settings, task=paths.CONFIG / "gathering.yaml")

    def server() -> Process:
        command = [sys.executable, "-m", "rtg.engines.server", graph.config, graph.key]
        return net.start(command, PYTHONPATH=str(paths.ROOT / "train"))

    consumer, worker, coordinator = graph.consumer(), graph.worker(0), graph.coordinator()
    first = server()
    assert first_rows(consumer) < 400
    first.kill()
    second = server()
    finish(consumer)
    for process in (coordinator, worker, second):
        assert process.wait(PATIENCE) == 0
    assert digest(tmp_path) == there
