"""The learner's program on several runs at once."""

import signal
import threading
import time
from pathlib import Path

import pytest
from rtg.files.dataset import Rows
from rtg.files.run_folder import checkpoint_file, read_json
from rtg.learn import trainer
from rtg.processes.interrupts import Interrupts
from training_runs import run_folder


def learn(*words: object) -> int:
    return trainer.main([str(word) for word in words])


def test_several_runs_come_to_the_same_bits_as_alone(tmp_path: Path, rows: Rows) -> None:
    def made(name: str) -> list[Path]:
        (tmp_path / name).mkdir()
        return [
            run_folder(tmp_path / name / f"{seed}", rows, f"run.seed={seed}") for seed in (3, 4, 5)
        ]

    alone, beside = made("alone"), made("beside")
    for folder in alone:
        assert learn(folder, "--no-stream") == 0
    assert learn(*beside, "--no-stream") == 0
    weights = [
        [(folder / "model.pt").read_bytes() for folder in found] for found in (alone, beside)
    ]
    assert weights[0] == weights[1]
    assert len(set(weights[0])) == 3
    counted = [read_json(folder / "training.json")["runs_in_process"] for folder in alone + beside]
    assert counted == [1, 1, 1, 3, 3, 3]


def test_a_run_that_cannot_learn_leaves_the_others_alone(
    tmp_path: Path, rows: Rows, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = run_folder(tmp_path / "bad", None)
    good = run_folder(tmp_path / "good", rows)
    assert learn(bad, good, "--no-stream") == 2
    assert f"{bad}/transitions.npz" in capsys.readouterr().err
    assert (good / "training.json").exists()


def test_several_runs_have_no_stream(capsys: pytest.CaptureFixture[str]) -> None:
    assert learn("one", "other") == 2
    assert "legal: with --no-stream" in capsys.readouterr().err


def test_a_signal_that_another_thread_gets_stops_learning(
    tmp_path: Path, rows: Rows, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Python handles signals in the main thread, which used to sleep until learning ended."""
    folder = run_folder(tmp_path / "run", rows)
    requested, sent = Interrupts.requested, threading.Event()

    def interrupted(interrupts: Interrupts) -> bool:
        if not sent.is_set():
            sent.set()
            assert threading.current_thread() is not threading.main_thread()
            signal.pthread_kill(threading.get_ident(), signal.SIGTERM)
            for _ in range(100):
                if requested(interrupts):
                    break
                time.sleep(0.1)
        return requested(interrupts)

    monkeypatch.setattr(Interrupts, "requested", interrupted)
    assert learn(folder, "--no-stream") == 128 + signal.SIGTERM
    assert checkpoint_file(folder).exists() and not (folder / "training.json").exists()
