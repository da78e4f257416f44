"""The transitions are the same bytes however many processes work, die or go unheard."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import network
import pytest
from graph import PATIENCE, Graph, Process, finish, first_rows, generated_in_process
from rtg import paths
from rtg.bus.bus import new_key

LONG = ("search.transitions=12000", "run.seed=3")

RRBS = (
    "search.generator=rrbs",
    "search.transitions=300",
    "search.breadth=4",
)
# Falls short.
SHORT = ("search.depth=1", "search.breadth=1", "search.plans_per_node=1")
# On the server alone.
FORWARD = ("search.generator=forward", "search.transitions=800")
SCATTER = ("search.generator=scatter", "search.transitions=800")


@pytest.fixture
def net() -> Iterator[network.Network]:
    network.require()
    with network.Network() as created:
        yield created


@pytest.fixture(scope="module")
def tiny(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return generated_in_process(tmp_path_factory.mktemp("tiny") / "transitions.npz")


@pytest.fixture(scope="module")
def long(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return generated_in_process(tmp_path_factory.mktemp("long") / "transitions.npz", *LONG)


def assert_all_left(*processes: Process) -> None:
    for process in processes:
        assert process.wait(PATIENCE) == 0


@pytest.mark.parametrize("workers", [1, 2, 4])
def test_any_number_of_workers(
    net: network.Network, tmp_path: Path, tiny: bytes, workers: int
) -> None:
    graph = Graph(net, tmp_path, f"run.workers={workers}")
    helpers = [graph.server(), *(graph.worker(number) for number in range(workers))]
    consumer, coordinator = graph.consumer(), graph.coordinator()
    finish(consumer)
    assert_all_left(coordinator, *helpers)
    assert graph.transitions() == tiny


@pytest.mark.parametrize(
    "order", ["consumer server coordinator worker", "coordinator worker consumer server"]
)
def test_any_order_of_starts(net: network.Network, tmp_path: Path, tiny: bytes, order: str) -> None:
    graph = Graph(net, tmp_path)
    programs = {
        "server": graph.server,
        "worker": lambda: graph.worker(1),
        "consumer": graph.consumer,
        "coordinator": graph.coordinator,
    }
    started = {}
    for name in order.split():
        started[name] = programs[name]()
        time.sleep(0.5)
    finish(started.pop("consumer"))
    assert_all_left(*started.values())
    assert graph.transitions() == tiny


def test_the_shell_script(net: network.Network, tmp_path: Path, tiny: bytes) -> None:
    graph = Graph(net, tmp_path)
    assert graph.key.exists()  # an old one, of another name
    script = net.start([paths.ROOT / "graph.sh", tmp_path, "recorder"], RTG_RUN="by-the-script")
    assert script.stdout is not None
    assert script.stdout.read() == ""
    assert script.wait(PATIENCE) == 0
    assert graph.transitions() == tiny
    assert not graph.key.exists()
    said = {path.stem: path.read_text().splitlines() for path in (tmp_path / "logs").iterdir()}
    assert said["reverse_worker_0"][:2] == [
        "rtg_reverse_worker: waits for the coordinator of run by-the-script",
        "rtg_reverse_worker: works",
    ]
    assert said["forward_sim_server"][-1].startswith("rtg_forward_sim_server: ends after ")
    assert said["beam_coordinator"] == [
        "rtg_beam_coordinator: waits for the workers and the server of run by-the-script",
        "rtg_beam_coordinator: works",
        "rtg_beam_coordinator: has found 2000 transitions, waits until all consumers have them",
        "rtg_beam_coordinator: ends",
    ]
    assert said["recorder"][-1] == "recorder: ends with 2000 transitions"


def test_a_search_that_falls_short_ends_the_script_with_status_1(
    net: network.Network, tmp_path: Path
) -> None:
    graph = Graph(net, tmp_path, *SHORT)
    script = net.start([paths.ROOT / "graph.sh", tmp_path, "recorder"])
    assert script.stdout is not None
    (line,) = script.stdout.read().splitlines()
    assert re.match(r"the search \(naive\) found \d+ transitions of the 2000 asked for ", line)
    assert script.wait(PATIENCE) == 1
    said = (tmp_path / "logs" / "beam_coordinator.log").read_text().splitlines()
    assert said[-2:] == ["rtg_beam_coordinator: ends", f"rtg_beam_coordinator: {line}"]
    assert graph.transitions() == generated_in_process(tmp_path / "direct.npz", *SHORT)


@pytest.mark.parametrize("words", [RRBS, FORWARD, SCATTER], ids=["rrbs", "forward", "scatter"])
def test_other_searches(net: network.Network, tmp_path: Path, words: tuple[str, ...]) -> None:
    graph = Graph(net, tmp_path, *words)
    helpers = [graph.server(), graph.worker(1), graph.worker(2)]
    consumer, coordinator = graph.consumer(), graph.coordinator()
    finish(consumer)
    assert_all_left(coordinator, *helpers)
    assert graph.transitions() == generated_in_process(tmp_path / "direct.npz", *words)


def test_a_killed_worker(net: network.Network, tmp_path: Path, long: bytes) -> None:
    graph = Graph(net, tmp_path, *LONG)
    server, worker, consumer = graph.server(), graph.worker(1), graph.consumer()
    coordinator = graph.coordinator()
    assert 0 < first_rows(consumer) < 12000
    worker.kill()
    assert worker.wait(PATIENCE) == -signal.SIGKILL
    assert graph.is_generating()
    another = graph.worker(2)
    finish(consumer)
    assert_all_left(coordinator, server, another)
    assert graph.transitions() == long


def test_a_unit_that_no_worker_survives(net: network.Network, tmp_path: Path) -> None:
    graph = Graph(net, tmp_path)
    server, consumer = graph.server(), graph.consumer()
    coordinator, deadly = graph.coordinator(), graph.deadly_unit()
    assert deadly.wait(PATIENCE) == 0
    worker = graph.worker(1)
    finish(consumer)
    assert coordinator.wait(PATIENCE) == 3
    assert_all_left(server, worker)
    report = json.loads((tmp_path / "generation.json").read_text())
    assert (report["units_given_up"], report["transitions"]) == (1, 2000)


def test_a_killed_server(net: network.Network, tmp_path: Path, long: bytes) -> None:
    graph = Graph(net, tmp_path, *LONG)
    server, worker, consumer = graph.server(), graph.worker(1), graph.consumer()
    coordinator = graph.coordinator()
    assert 0 < first_rows(consumer) < 12000
    server.kill()
    assert server.wait(PATIENCE) == -signal.SIGKILL
    assert graph.is_generating()
    another = graph.server()
    finish(consumer)
    assert_all_left(coordinator, worker, another)
    assert graph.transitions() == long


def test_a_coordinator_killed_twice(net: network.Network, tmp_path: Path, long: bytes) -> None:
    graph = Graph(net, tmp_path, *LONG)
    server, worker, consumer = graph.server(), graph.worker(1), graph.consumer()
    coordinator = graph.coordinator()
    for _ in range(2):
        assert 0 < first_rows(consumer) < 12000
        coordinator.kill()
        assert coordinator.wait(PATIENCE) == -signal.SIGKILL
        assert graph.is_generating()
        coordinator = graph.coordinator()
    finish(consumer)
    assert_all_left(coordinator, server, worker)
    assert graph.transitions() == long
    assert json.loads((tmp_path / "generation.json").read_text())["units_from_journal"] > 0
    assert not graph.journal.exists()


def test_two_coordinators_do_not_share_a_folder(net: network.Network, tmp_path: Path) -> None:
    graph = Graph(net, tmp_path, *LONG)
    server, worker, consumer = graph.server(), graph.worker(1), graph.consumer()
    coordinator = graph.coordinator()
    assert first_rows(consumer) > 0
    assert graph.coordinator().wait(PATIENCE) == 1
    finish(consumer)
    assert_all_left(coordinator, server, worker)


def test_a_tenth_of_the_datagrams_lost(net: network.Network, tmp_path: Path, tiny: bytes) -> None:
    net.lose(10)
    graph = Graph(net, tmp_path)
    helpers = [graph.server(), graph.worker(1), graph.worker(2)]
    consumer, coordinator = graph.consumer(), graph.coordinator()
    finish(consumer)
    assert_all_left(coordinator, *helpers)
    assert net.lost() > 20
    assert graph.transitions() == tiny


def test_a_receive_buffer_too_small_for_a_burst(
    net: network.Network, tmp_path: Path, long: bytes
) -> None:
    graph = Graph(net, tmp_path, *LONG)
    helpers = [graph.server(), graph.worker(1)]
    small, usual = graph.consumer("small", "2048"), graph.consumer("usual")
    coordinator = graph.coordinator(2)
    assert 0 < first_rows(small) < 12000
    small.send_signal(signal.SIGSTOP)  # nobody empties the buffer
    finish(usual)
    assert net.dropped() > 0
    small.send_signal(signal.SIGCONT)
    finish(small)
    assert_all_left(coordinator, *helpers)
    assert graph.transitions("small") == long


def test_consumers_that_come_late_or_again(
    net: network.Network, tmp_path: Path, tiny: bytes
) -> None:
    graph = Graph(net, tmp_path)
    helpers = [graph.server(), graph.worker(1)]
    first, coordinator = graph.consumer("first"), graph.coordinator(2)
    assert first_rows(first) > 0
    first.kill()
    second = graph.consumer("second")
    finish(second)
    assert not graph.is_generating()
    third = graph.consumer("third")
    finish(third)
    assert_all_left(coordinator, *helpers)
    assert graph.transitions("second") == graph.transitions("third") == tiny


def test_a_terminated_coordinator_ends_all_and_leaves_no_half_file(
    net: network.Network, tmp_path: Path
) -> None:
    graph = Graph(net, tmp_path, *LONG)
    server, worker, consumer = graph.server(), graph.worker(1), graph.consumer()
    coordinator = graph.coordinator()
    assert first_rows(consumer) > 0
    coordinator.terminate()
    assert coordinator.wait(PATIENCE) == 128 + signal.SIGTERM
    assert_all_left(server, worker)
    left = ["config.yaml", "generation.journal", "run.key"]
    assert sorted(path.name for path in tmp_path.iterdir()) == left


def test_workers_and_server_end_when_told(net: network.Network, tmp_path: Path) -> None:
    graph = Graph(net, tmp_path, *LONG)
    server, worker, consumer = graph.server(), graph.worker(1), graph.consumer()
    coordinator = graph.coordinator()
    assert first_rows(consumer) > 0
    worker.terminate()
    server.send_signal(signal.SIGINT)
    assert worker.wait(PATIENCE) == 128 + signal.SIGTERM
    assert server.wait(PATIENCE) == 128 + signal.SIGINT
    coordinator.send_signal(signal.SIGINT)  # while its search waits for the two
    assert coordinator.wait(PATIENCE) == 128 + signal.SIGINT


def test_bad_words_are_named(net: network.Network, tmp_path: Path) -> None:
    graph = Graph(net, tmp_path)
    assert graph.worker(-1).wait(PATIENCE) == 2
    assert graph.coordinator(-1).wait(PATIENCE) == 2
    graph.config.write_text("task: nowhere.yaml\n")
    assert graph.server().wait(PATIENCE) == 2


@pytest.mark.parametrize(
    "program",
    [
        ["{coordinator}", "{config}", "{key}", "{folder}"],
        [sys.executable, "-m", "rtg.bus.record", "{config}", "{key}", "{folder}/transitions.npz"],
    ],
    ids=["coordinator", "recorder"],
)
def test_a_folder_that_does_not_exist_is_refused_before_the_search(
    tmp_path: Path, program: list[str]
) -> None:
    places = {
        "coordinator": paths.BUILD / "nodes" / "rtg_beam_coordinator",
        "config": paths.CONFIG / "gathering.yaml",
        "folder": tmp_path / "none",
        "key": tmp_path / "run.key",
    }
    new_key(places["key"], "a-run")
    words = [word.format(**places) for word in program]
    env = {**os.environ, "PYTHONPATH": str(paths.ROOT / "train")}
    ended = subprocess.run(words, env=env, stderr=subprocess.PIPE, text=True, timeout=PATIENCE)
    assert ended.returncode == 2
    assert f"{tmp_path / 'none'}: no such folder; legal: " in ended.stderr
