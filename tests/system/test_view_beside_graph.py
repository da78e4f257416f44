"""The view beside a process graph: it hears what is not yet on disk, and no one notices it."""

import re
import sys

import network
import pytest
from graph import PATIENCE, Graph
from network import Network
from rtg import paths
from rtg.files.run_folder import write_run_name

rerun_chunk = pytest.importorskip("rerun.chunk", reason="the extra view is not installed")


def texts(file):
    """Returns the words on the state of the run, in the order in which they were shown."""
    found = []
    for chunk in rerun_chunk.RrdReader(file).stream().to_chunks():
        if chunk.entity_path == "/state":
            batch = chunk.to_record_batch()
            times = batch.column("time").cast("int64").to_pylist()
            words = [value[0] for value in batch.column("TextDocument:text").to_pylist()]
            found += zip(times, words, strict=True)
    return [words for _, words in sorted(found)]


def test_a_view_shows_steps_before_they_are_stored_and_no_one_waits_for_it(tmp_path):
    network.require()
    file = tmp_path / "run.rrd"
    with Network() as net:
        graph = Graph(net, tmp_path, "search.transitions=12000")
        write_run_name(tmp_path, "system-test")
        words = [sys.executable, "-m", "rtg.cli", "view", tmp_path, "--save", file]
        view = net.start(words, PYTHONPATH=str(paths.ROOT / "train"))
        assert view.stdout.readline() == "listening to the run system-test\n"
        others = [graph.server(), graph.worker(0), graph.coordinator(), graph.consumer()]
        assert others[-1].wait(PATIENCE) == 0
        assert others[-2].wait(PATIENCE) == 0
        (tmp_path / "summary.json").write_text("{}")
        assert view.wait(PATIENCE) == 0
    shown = texts(file)
    early = [words for words in shown if re.search(r"- tree \d", words)]
    counts = [re.search(r"- ([\d,]+) transitions, [\d,]+ of them steps", words) for words in early]
    heard = [int(found[1].replace(",", "")) for found in counts if found]
    assert any(0 < count < 12000 for count in heard)
    assert "12,000 transitions" in shown[-1]
