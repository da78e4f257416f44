"""The log of a program, read while it grows."""

import tracemalloc

import pytest
from rtg.processes.program_log import ProgramLog


@pytest.fixture
def path(tmp_path):
    return tmp_path / "log"


def test_of_a_file_that_is_not_there_yet_there_are_no_lines(path):
    log = ProgramLog(path)
    assert (log.tail(), log.new_lines()) == ("", [])
    path.write_text("one\n")
    assert (log.tail(), log.new_lines()) == ("one", ["one"])


def test_the_last_lines_of_a_huge_log_are_read_without_the_rest(path):
    log = ProgramLog(path)
    with path.open("wb") as file:
        file.seek(1 << 26)
        file.write(b"\none\ntwo\nthr")
    tracemalloc.start()
    assert log.tail(2) == "two\nthr" and log.tail(3) == "one\ntwo\nthr"
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 1 << 20


@pytest.mark.parametrize("length", [1, 1000, 4095, 4096, 5000, 20_000])
def test_long_lines_are_whole(path, length):
    log = ProgramLog(path)
    written = [f"{k}" + length * "é" for k in range(5)]
    path.write_text("\n".join(written))
    assert log.tail(3).splitlines() == written[-3:]
    path.write_text("\n".join(written) + "\n")
    assert log.tail(3).splitlines() == written[-3:]
    assert log.tail(9).splitlines() == written


def test_what_an_earlier_program_wrote_is_left_out(path):
    path.write_text("of an earlier start\n")
    log = ProgramLog(path)
    assert log.tail() == ""
    with path.open("a") as file:
        file.write("one\n")
    assert log.tail() == "one"
    path.write_text("cut\n")  # shorter than it was
    assert log.tail() == ""
