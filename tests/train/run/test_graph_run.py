"""The end of a process graph, with programs that do nothing but end."""

import io
import json
import time
from dataclasses import replace
from types import SimpleNamespace

import pytest
from rtg import paths
from rtg.errors import RunError, StoppedError, UserError
from rtg.files import versions
from rtg.run import effective_config, graph_run, results, run
from rtg.run.plan import RunPlan
from rtg.run.progress import display
from rtg.run.run_args import parse

TINY = paths.CONFIG / "tests" / "tiny.yaml"
REPORT = {"transitions": 0, "generate_wall_s": 1.5, "replay_gaps": []}
SHORT = ["found nothing that moves", "found 3 of 9 (search.breadth)"]
# A coordinator whose search falls short.
FALLS_SHORT = f"""cat > "$3/generation.json" <<'END'
{json.dumps({**REPORT, "shortfalls": SHORT}, separators=(",", ":"))}
END
echo "rtg_beam_coordinator: ends"
echo "rtg_beam_coordinator: {SHORT[0]}"
echo "rtg_beam_coordinator: {SHORT[1]}"
exit 1"""
PROGRAMS = {
    "rtg_forward_sim_server": "exec sleep infinity",
    "rtg_reverse_worker": "exec sleep infinity",
    "rtg_beam_coordinator": f"echo '{json.dumps(REPORT)}' > \"$3/generation.json\"",
    "python": 'touch "$5"',  # the recorder
}


@pytest.fixture
def plan(tmp_path, monkeypatch):
    """A run of those programs, without a trainer, on a bus on which nobody speaks."""
    folder = tmp_path / "run"
    folder.mkdir()
    (folder / "config.yaml").write_text(effective_config.load(TINY).yaml)
    for name, script in PROGRAMS.items():
        program = tmp_path / name
        program.write_text(f"#!/bin/sh\n{script}\n")
        program.chmod(0o755)
    monkeypatch.setenv("RTG_NODES", str(tmp_path))
    monkeypatch.setenv("RTG_PYTHON", str(tmp_path / "python"))
    config = SimpleNamespace(  # with a bus that no file may have
        run=SimpleNamespace(bus="memq://", record=False, workers=1),
        task=effective_config.load(TINY).task,
    )
    return RunPlan(folder, "test", config, train=False, resume=False, notes=())


def test_the_failure_of_a_program_is_that_of_the_run(plan, tmp_path):
    coordinator = tmp_path / "rtg_beam_coordinator"
    for status, error in ((1, RunError), (2, UserError)):
        coordinator.write_text(f"#!/bin/sh\necho no such body; exit {status}\n")
        with display(io.StringIO(), 100.0) as shown, pytest.raises(error, match=r"no such body$"):
            graph_run.run(plan, shown)


def test_restarts_are_told_and_counted(plan, tmp_path):
    worker, coordinator = tmp_path / "rtg_reverse_worker", tmp_path / "rtg_beam_coordinator"
    coordinator.write_text(f"#!/bin/sh\nsleep 2\n{PROGRAMS['rtg_beam_coordinator']}\n")
    once = f"mkdir {tmp_path}/died-$3 || exec sleep infinity; kill -KILL $$"
    worker.write_text(f"#!/bin/sh\n{once}\n")
    out = io.StringIO()
    with display(out, 100.0) as shown:
        assert graph_run.run(plan, shown)["worker_restarts"] == 2
    assert "] reverse_worker_1 was killed by SIGKILL, started again\n" in out.getvalue()


def test_a_program_that_takes_longer_to_stop_is_waited_for(plan, tmp_path):
    recorder, ended = tmp_path / "python", tmp_path / "ended"
    orderly = f"trap 'sleep 5; touch {ended}; exit' TERM"  # more than other children may take
    recorder.write_text(f"#!/bin/bash\n{orderly}; touch $5; while :; do sleep 0.05; done\n")

    def step(state):
        if plan.transitions_file.exists():
            raise StoppedError

    shown = SimpleNamespace(note=lambda message: None, show=step)
    with pytest.raises(StoppedError):
        graph_run.run(plan, shown)
    assert ended.exists()


def test_what_the_network_lacks_is_told(plan, monkeypatch):
    bus = SimpleNamespace(
        warning="a small buffer",
        counters={},
        spin=lambda timeout: time.sleep(timeout),
        subscribe=lambda *words: None,
        unsubscribe=lambda: None,
    )
    monkeypatch.setattr(graph_run, "open_bus", lambda url, key: bus)
    out = io.StringIO()
    with display(out, 100.0) as shown:
        graph_run.run(plan, shown)
    assert "a small buffer\n" in out.getvalue()


def test_work_that_was_given_up_is_told(plan, tmp_path):
    report = json.dumps({**REPORT, "units_given_up": 2})
    coordinator = tmp_path / "rtg_beam_coordinator"
    coordinator.write_text(f"#!/bin/sh\necho '{report}' > \"$3/generation.json\"\nexit 3\n")
    with display(io.StringIO(), 100.0) as shown:
        measured = graph_run.run(plan, shown)
    assert measured["defects"] == ["the coordinator gave up 2 units of work"]


def test_a_search_that_falls_short_has_results_and_defects(plan, tmp_path):
    (tmp_path / "rtg_beam_coordinator").write_text(f"#!/bin/sh\n{FALLS_SHORT}\n")
    with display(io.StringIO(), 100.0) as shown:
        measured = graph_run.run(plan, shown)
    assert measured["defects"] == SHORT
    assert plan.transitions_file.is_file()


def test_a_consumer_that_fails_after_a_search_that_fell_short_is_a_failure(plan, tmp_path):
    (tmp_path / "rtg_beam_coordinator").write_text(f"#!/bin/sh\n{FALLS_SHORT}\n")
    (tmp_path / "python").write_text("#!/bin/sh\nsleep 1; echo no memory; exit 1\n")
    with display(io.StringIO(), 100.0) as shown, pytest.raises(RunError, match=r"no memory$"):
        graph_run.run(plan, shown)


def test_a_resumed_run_still_tells_what_its_generation_gave_up(plan, monkeypatch):
    report = {**REPORT, "transitions": 2000, "units_given_up": 2}
    plan.report_file.write_text(json.dumps(report))
    plan.transitions_file.touch()
    versions.seal(plan.transitions_file)
    measured = {}
    for drawing in ("draw", "draw_generation"):
        monkeypatch.setattr(results, drawing, lambda plan: None)
    monkeypatch.setattr(results, "finish", lambda plan, found: measured.update(found))
    monkeypatch.setattr(results, "summary_text", lambda plan, summary: "done")
    config = effective_config.load(TINY)
    monkeypatch.setattr(run, "make_plan", lambda args: replace(plan, config=config, resume=True))
    assert run.run(parse(["--no-train"])) == 1
    assert measured["defects"] == ["the coordinator gave up 2 units of work"]


def test_a_coordinator_that_was_never_heard_leaves_a_whole_report(plan):
    with display(io.StringIO(), 100.0) as shown:
        measured = graph_run.run(plan, shown)
    assert json.loads(plan.report_file.read_text()) == REPORT
    assert plan.transitions_file.is_file()
    assert measured["defects"] == []
