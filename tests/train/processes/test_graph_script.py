"""graph.sh, with programs that do as they are told."""

import fcntl
import os
import pty
import signal
import subprocess
import time

import pytest
from rtg import paths
from rtg.files.locks import is_locked
from time_limit import run

CONFIG = "search:\n  workers_: 9\nrun:\n  workers: 2  # reverse workers\n  record: false  # none\n"
# By name: what a program does. The trainer and the recorder are modules of "python".
PATIENT = "trap 'exit 143' TERM; while :; do sleep 0.05; done"
DONE = 'echo "{}" > "$3/generation.json"'
# Writes a generation.json in which the search lacks two things, with other keys around them.
SHORT = """cat > "$3/generation.json" <<'END'
{"transitions":3,"shortfalls":["no step, see X","3 of 9 (a.b, c.d)"],"replay_gaps":[],"nodes":[]}
END
"""
PROGRAMS = {
    "rtg_forward_sim_server": PATIENT,
    "rtg_reverse_worker": PATIENT,
    "rtg_beam_coordinator": DONE,
    "python": 'echo "$@"',
}


class Graph:
    def __init__(self, folder):
        self.run_folder = folder / "a run"
        self.run_folder.mkdir()
        (self.run_folder / "config.yaml").write_text(CONFIG)
        self.bin = folder / "bin"
        self.bin.mkdir()
        python = str(self.bin / "python")
        self.settings = {"RTG_NODES": str(self.bin), "RTG_PYTHON": python, "RTG_KEY": "given"}
        for name, script in PROGRAMS.items():
            self.let(name, script)

    def let(self, name, script):
        (self.bin / name).write_text(f"#!/usr/bin/env bash\n{script}\n")
        (self.bin / name).chmod(0o755)

    def start(self, *words):
        return subprocess.Popen(
            [paths.ROOT / "graph.sh", self.run_folder, *words],
            env={**os.environ, **self.settings},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )

    def run(self, *words):
        process = self.start(*words)
        out, _ = process.communicate(timeout=120.0)
        return process.returncode, out

    def log(self, name):
        return (self.run_folder / "logs" / f"{name}.log").read_text()

    def programs(self):
        """Command lines of the programs that run."""
        return run("pgrep", "-a", "-f", self.bin).stdout.splitlines()


@pytest.fixture
def graph(tmp_path):
    graph = Graph(tmp_path)
    yield graph
    run("pkill", "-KILL", "-f", graph.bin)


def wait_for(condition):
    deadline = time.monotonic() + 120.0
    while not condition():
        assert time.monotonic() < deadline, "never came true"
        time.sleep(0.02)


def waits_for_a_lock(parent):
    """Whether a child of this process is flock(1)."""
    return run("pgrep", "-x", "-P", str(parent), "flock").returncode == 0


def test_all_programs_run_with_their_words_and_end_with_the_last_needed_one(graph):
    graph.let("rtg_reverse_worker", f'echo "$@"; {PATIENT}')
    assert graph.run("trainer", "--resume") == (0, "")
    folder, config = graph.run_folder, graph.run_folder / "config.yaml"
    key = folder / "run.key"
    assert graph.log("reverse_worker_0") == f"{config} {key} 0\n"
    assert graph.log("reverse_worker_1") == f"{config} {key} 1\n"
    words = f"-m rtg.learn.trainer {folder} --resume\n"
    assert graph.log("trainer") == words
    logs = {path.stem for path in (folder / "logs").iterdir()}
    assert logs == {
        "forward_sim_server",
        "reverse_worker_0",
        "reverse_worker_1",
        "beam_coordinator",
        "trainer",
    }
    assert graph.programs() == []


def test_the_recorder_and_the_logger_run_if_asked(graph):
    (graph.run_folder / "config.yaml").write_text(CONFIG.replace("record: false", "record: true"))
    assert graph.run("recorder")[0] == 0
    config = graph.run_folder / "config.yaml"
    key, transitions = graph.run_folder / "run.key", graph.run_folder / "transitions.npz"
    assert graph.log("recorder") == f"-m rtg.bus.record {config} {key} {transitions}\n"
    assert graph.log("lcm_logger").startswith(f"-m rtg.bus.lcm_tools {config} ")


def test_a_worker_that_dies_is_started_again(graph):
    once = f'if mkdir "$(dirname "$1")/died-$3" 2>&-; then kill -KILL $$; fi; {PATIENT}'
    graph.let("rtg_reverse_worker", once)
    graph.let("rtg_beam_coordinator", f"sleep 2; {DONE}")
    status, out = graph.run()
    assert status == 0
    assert sorted(out.splitlines()) == [
        f"reverse_worker_{k} was killed by SIGKILL, started again" for k in (0, 1)
    ]


def test_a_worker_that_says_good_bye_is_let_go(graph):
    graph.let("rtg_reverse_worker", "exit 0")
    graph.let("rtg_beam_coordinator", f"sleep 1; {DONE}")
    assert graph.run() == (0, "")


def test_a_worker_that_cannot_even_start_ends_the_run(graph):
    graph.let("rtg_reverse_worker", "echo no such library; exit 3")
    graph.let("rtg_beam_coordinator", PATIENT)
    status, out = graph.run()
    assert status == 3
    assert out.count("started again") >= 9
    assert out.endswith("no such library\n")
    assert graph.programs() == []


def test_bad_input_of_a_worker_ends_the_run_at_once(graph):
    graph.let("rtg_reverse_worker", "echo config.yaml:3: wrong; exit 2")
    graph.let("rtg_beam_coordinator", PATIENT)
    status, out = graph.run()
    assert status == 2
    assert "started again" not in out
    assert out.endswith("config.yaml:3: wrong\n")


@pytest.mark.parametrize("name", ["rtg_beam_coordinator", "python"])
def test_a_failure_of_coordinator_or_trainer_ends_the_run_with_its_last_words(graph, name):
    graph.let("rtg_beam_coordinator", PATIENT)
    graph.let("python", PATIENT)
    graph.let(name, "echo out of memory; exit 4")
    status, out = graph.run()
    assert status == 4
    assert "ended with exit status 4; the end of " in out and out.endswith("out of memory\n")
    assert graph.programs() == []


def test_a_killed_coordinator_with_a_journal_is_started_again(graph):
    journal = graph.run_folder / "generation.journal"
    killed = f'echo >> "{journal}"; if (($(stat -c %s "{journal}") < 15)); then kill -KILL $$; fi'
    graph.let("rtg_beam_coordinator", f"{killed}; {DONE}")
    graph.let(
        "python", f'while [[ ! -e "{graph.run_folder}/generation.json" ]]; do sleep 0.1; done'
    )
    again = "beam_coordinator was killed by SIGKILL, started again\n"
    assert graph.run() == (0, 14 * again)


@pytest.mark.parametrize(("journal", "starts"), [("touch", 10), (":", 1)])
def test_a_coordinator_killed_without_adding_to_a_journal_ends_the_run(graph, journal, starts):
    killed = f'echo memory; {journal} "{graph.run_folder}/generation.journal"; kill -KILL $$'
    graph.let("rtg_beam_coordinator", killed)
    graph.let("python", PATIENT)
    status, out = graph.run()
    assert status == 137
    assert out.count("started again") == starts - 1
    assert out.endswith(starts * "memory\n" if starts < 8 else 8 * "memory\n")
    assert graph.programs() == []


def test_a_coordinator_that_gave_units_up_lets_the_trainer_finish(graph):
    graph.let("rtg_beam_coordinator", f"{DONE}; echo working; echo 2 units; exit 3")
    graph.let("python", "sleep 1; echo learned")
    assert graph.run() == (0, "2 units\n")
    assert graph.log("trainer") == "learned\n"


def test_a_search_that_falls_short_lets_the_trainer_finish_and_ends_with_status_1(graph):
    words = "no step, see X", "3 of 9 (a.b, c.d)"
    told = "; ".join(f'echo "rtg_beam_coordinator: {line}"' for line in ("ends", *words))
    graph.let("rtg_beam_coordinator", f"{SHORT}{told}; exit 1")
    graph.let("python", "sleep 1; echo learned")
    assert graph.run() == (1, f"{words[0]}\n{words[1]}\n")
    assert graph.log("trainer") == "learned\n"


def test_a_search_that_fell_short_is_told_though_the_coordinator_waits_in_vain(graph):
    graph.let("rtg_beam_coordinator", f"{SHORT}{PATIENT}")
    assert graph.run() == (1, "no step, see X\n3 of 9 (a.b, c.d)\n")


@pytest.mark.parametrize("search", [SHORT, f"{DONE}; "], ids=["fell short", "is done"])
def test_a_coordinator_that_fails_after_its_search_ends_the_run(graph, search):
    graph.let("rtg_beam_coordinator", f"{search}echo no memory; exit 1")
    graph.let("python", PATIENT)
    status, out = graph.run()
    assert status == 1
    assert out.endswith("no memory\n")


def test_after_the_coordinator_no_worker_is_started_again(graph):
    graph.let("rtg_beam_coordinator", f"sleep 0.5; {DONE}")
    graph.let("rtg_reverse_worker", "sleep 1; echo no coordinator; exit 1")
    graph.let("python", "sleep 2.5")
    assert graph.run() == (0, "")


def test_a_program_that_does_not_want_to_end_is_killed(graph):
    graph.let("rtg_forward_sim_server", "trap '' TERM; while :; do sleep 0.05; done")
    assert graph.run() == (0, "")
    assert graph.programs() == []


def test_a_coordinator_that_waits_in_vain_is_not_waited_for(graph):
    graph.let("rtg_beam_coordinator", f"{DONE}; {PATIENT}")
    assert graph.run() == (0, "")
    assert graph.programs() == []


@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)]
)
def test_a_signal_ends_all_programs_in_order(graph, number, status):
    orderly = "trap 'echo good-bye; exit 143' TERM; echo here; while :; do sleep 0.05; done"
    graph.let("rtg_beam_coordinator", PATIENT)
    graph.let("python", orderly)
    process = graph.start()
    log = graph.run_folder / "logs" / "trainer.log"
    wait_for(lambda: log.exists() and log.read_text() == "here\n")
    process.send_signal(number)
    assert process.wait(120.0) == status
    process.stdout.close()
    assert log.read_text() == "here\ngood-bye\n"  # told once: a second signal would end it at once
    assert graph.programs() == []


def test_a_closed_terminal_leaves_the_trainer_time_for_its_checkpoint(graph):
    graph.let("rtg_beam_coordinator", PATIENT)
    orderly = (
        "trap 'sleep 1; echo checkpoint; exit 143' TERM; echo here; while :; do sleep 0.05; done"
    )
    graph.let("python", orderly)
    shell, terminal = pty.fork()
    if shell == 0:
        os.environ |= graph.settings
        os.execvp("bash", ["bash", "--norc", "-i"])
    os.write(terminal, f"'{paths.ROOT / 'graph.sh'}' '{graph.run_folder}'\n".encode())
    log = graph.run_folder / "logs" / "trainer.log"
    wait_for(lambda: log.exists() and log.read_text() == "here\n")
    os.close(terminal)
    os.waitpid(shell, 0)
    wait_for(lambda: graph.programs() == [])
    assert log.read_text() == "here\ncheckpoint\n"


def test_a_repeated_hangup_does_not_cut_the_end_short(graph):
    graph.let("rtg_beam_coordinator", PATIENT)
    orderly = "trap 'echo stops; sleep 1; echo checkpoint; exit 143' TERM; echo here"
    graph.let("python", f"{orderly}; while :; do sleep 0.05; done")
    process = graph.start()
    log = graph.run_folder / "logs" / "trainer.log"
    for words in ("here\n", "here\nstops\n"):
        wait_for(lambda words=words: log.exists() and log.read_text() == words)
        process.send_signal(signal.SIGHUP)
    assert process.wait(120.0) == 129
    process.stdout.close()
    assert log.read_text() == "here\nstops\ncheckpoint\n"


def test_no_program_outlives_the_script(graph):
    for name in PROGRAMS:
        graph.let(name, "trap '' TERM INT; while :; do sleep 0.05; done")
    process = graph.start()
    wait_for(lambda: len(graph.programs()) >= 5)
    process.kill()
    process.wait(120.0)
    process.stdout.close()
    wait_for(lambda: graph.programs() == [])


def test_a_folder_has_one_script_at_a_time(graph):
    graph.let("python", PATIENT)
    process = graph.start()
    wait_for(lambda: len(graph.programs()) == 4)  # all but the coordinator, which is done
    status, out = graph.run()
    assert (status, "another graph.sh works in" in out) == (2, True)
    process.terminate()
    process.communicate(timeout=120.0)
    assert not is_locked(graph.run_folder / ".graph.lock")


def test_who_asks_whether_the_folder_is_locked_is_not_in_the_way(graph):
    with (graph.run_folder / ".graph.lock").open("w") as asked:
        fcntl.flock(asked, fcntl.LOCK_SH)
        process = graph.start()
        wait_for(lambda: waits_for_a_lock(process.pid))
    out, _ = process.communicate(timeout=120.0)
    assert (process.returncode, out) == (0, "")


@pytest.mark.parametrize("name", [".graph.lock", "logs", "generation.json"])
def test_a_folder_that_cannot_be_written_is_refused(graph, name):
    wrong = graph.run_folder / name
    wrong.touch() if name == "logs" else wrong.mkdir()
    why = "cannot be written (.graph.lock, logs/, generation.json); legal: a folder to write to"
    assert graph.run() == (2, f"graph.sh: '{graph.run_folder}' {why}\n")


def test_its_programs_do_not_hold_the_lock_of_the_folder(graph):
    graph.let("python", f"ls -l /proc/$$/fd; {PATIENT}")
    process = graph.start()
    wait_for(lambda: len(graph.programs()) == 4)
    wait_for(lambda: "trainer.log" in graph.log("trainer"))
    assert ".graph.lock" not in graph.log("trainer")
    process.terminate()
    process.communicate(timeout=120.0)


@pytest.mark.parametrize("words", ["trainr", "recorder --resume", "trainer --resum"])
def test_a_consumer_that_does_not_exist_is_refused(graph, words):
    legal = "trainer, trainer --resume, either with --log NAMES, recorder"
    assert graph.run(*words.split()) == (2, f"graph.sh: no consumer '{words}'; legal: {legal}\n")


def test_a_folder_without_a_configuration_is_refused(graph):
    (graph.run_folder / "config.yaml").unlink()
    status, out = graph.run()
    assert status == 2
    assert out.startswith(f"graph.sh: '{graph.run_folder}' is no folder with a config.yaml; ")


@pytest.mark.parametrize("text", ["run: {workers: 2}\n", "run:\n  workers: 0\n", "seed: 1\n"])
def test_a_configuration_that_is_not_resolved_is_refused(graph, text):
    (graph.run_folder / "config.yaml").write_text(text)
    status, out = graph.run()
    assert status == 2
    assert out.startswith(f"graph.sh: {graph.run_folder}/config.yaml: run.workers is '")
    assert out.endswith("; legal: a file that ./run.sh TASK --print-config has printed\n")
