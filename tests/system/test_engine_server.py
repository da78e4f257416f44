"""A forward simulator of the user's as a process of the graph: `forward.engine: module:Class`."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import network
import pytest
from graph import PATIENCE, Graph, Process, first_rows, lost
from rtg import cli, paths

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
def expected(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("in_process") / "run"
    assert cli.main([*SMALL, "--in-process", "--set", ENVIRONMENT, "--out", str(folder)]) == 0
    return digest(folder)


@pytest.mark.parametrize("workers", ["1", "4"])
def test_the_bytes_are_those_of_a_run_in_one_process(
    tmp_path: Path, expected: str, workers: str
) -> None:
    done = run(ENVIRONMENT, tmp_path / "run", "--workers", workers)
    assert done.returncode == 0, done.stderr
    assert digest(tmp_path / "run") == expected


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


def test_a_killed_server_is_replaced(net: network.Network, tmp_path: Path, expected: str) -> None:
    settings = ("search.breadth=4", "search.transitions=400")
    graph = Graph(net, tmp_path, ENVIRONMENT, *settings, task=paths.CONFIG / "gathering.yaml")

    def server() -> Process:
        command = [sys.executable, "-m", "rtg.engines.server", graph.config, graph.key]
        return net.start(command, PYTHONPATH=str(paths.ROOT / "train"))

    consumer, worker, coordinator = graph.consumer(), graph.worker(0), graph.coordinator()
    first = server()
    assert first_rows(consumer) < 400
    first.kill()
    second = server()
    assert lost(consumer) == 0
    for process in (coordinator, worker, second):
        assert process.wait(PATIENCE) == 0
    assert digest(tmp_path) == expected
