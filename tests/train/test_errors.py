"""Errors end every program in the same way: a line that says what is wrong, and a status."""

import os
from pathlib import Path

import pytest
from rtg import _core
from rtg.bus import lcm_tools, record
from rtg.errors import RunError, UserError, exit_status
from rtg.learn import trainer
from training_runs import TINY


@pytest.mark.parametrize(
    ("error", "status"), [(UserError, 2), (_core.ConfigError, 2), (RunError, 1)]
)
def test_an_error_is_told_and_becomes_a_status(error, status, capsys) -> None:
    def command() -> int:
        raise error("why")

    assert exit_status("program", command) == status
    assert capsys.readouterr().err == "program: why\n"


def test_without_an_error_the_status_is_that_of_the_command(capsys) -> None:
    assert exit_status("program", lambda: 130) == 130
    assert capsys.readouterr().err == ""


def test_our_own_faults_are_no_bad_input() -> None:
    with pytest.raises(ZeroDivisionError):
        exit_status("program", lambda: 1 // 0)


MAINS = {
    "rtg.learn.trainer": (trainer.main, []),
    "rtg.bus.record": (record.main, ["run", "transitions.npz"]),
    "rtg.bus.lcm_tools": (lcm_tools.main, ["lcm.log"]),
}


@pytest.mark.parametrize("program", MAINS)
def test_a_missing_configuration_is_bad_input(program: str, tmp_path: Path, capsys) -> None:
    main, more = MAINS[program]
    missing = str(tmp_path) if program == "rtg.learn.trainer" else str(tmp_path / "config.yaml")
    assert main([missing, *more]) == 2
    words = capsys.readouterr().err
    assert words.startswith(f"{program}: {tmp_path / 'config.yaml'}: no such file; legal: ")
    assert words.count("\n") == 1


@pytest.mark.parametrize("program", ["rtg.bus.record", "rtg.bus.lcm_tools"])
def test_too_few_words_are_bad_input(program: str, capsys) -> None:
    assert MAINS[program][0]([]) == 2
    assert capsys.readouterr().err.startswith(f"{program}: legal words: CONFIG.yaml ")


def test_without_lcm_the_logger_fails(monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert lcm_tools.main([str(TINY), "lcm.log"]) == 1
    assert capsys.readouterr().err.startswith("rtg.bus.lcm_tools: the Python package lcm is miss")


def test_the_logger_appends_what_is_on_the_bus(monkeypatch: pytest.MonkeyPatch) -> None:
    class BecameError(Exception):
        pass

    def become(program: Path, words: list[str]) -> None:
        raise BecameError(program, words)

    monkeypatch.setattr(os, "execv", become)
    with pytest.raises(BecameError) as told:
        lcm_tools.main([str(TINY), "lcm.log"])
    program, words = told.value.args
    assert program.name == "lcm-logger" and os.access(program, os.X_OK)
    url = _core.Config.from_file(TINY).run.bus
    assert words == [str(program), "--quiet", "--append", f"--lcm-url={url}", "lcm.log"]
