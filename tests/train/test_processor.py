"""Checks what a processor is told that cannot run the compiled core."""

import sys
from pathlib import Path

import pytest
import time_limit
from rtg import processor

KNOWN = "processor : 0\nflags\t\t: fpu sse2 avx avx2 bmi1 bmi2 fma\nbugs : fma\n"
SAID = "this processor lacks bmi2, fma; legal: an x86-64-v3 processor, as most are since 2013"
OLD = KNOWN.replace("bmi2 fma", "")


@pytest.fixture
def cpuinfo(tmp_path: Path) -> Path:
    return tmp_path / "cpuinfo"


def test_it_is_named_what_the_processor_lacks(
    cpuinfo: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(processor, "_CPUINFO", cpuinfo)
    monkeypatch.setattr(processor.platform, "machine", lambda: "x86_64")
    monkeypatch.setattr(sys, "excepthook", sys.excepthook)
    cpuinfo.write_text(KNOWN)
    processor.check()
    cpuinfo.write_text(OLD)
    with pytest.raises(ImportError, match=f"^{SAID}$"):
        processor.check()
    monkeypatch.setattr(processor.platform, "machine", lambda: "aarch64")
    processor.check()


def test_a_program_ends_with_a_line_and_status_2(cpuinfo: Path) -> None:
    cpuinfo.write_text(OLD)
    program = f"""
import pathlib
from rtg import processor
processor._CPUINFO = pathlib.Path({str(cpuinfo)!r})
processor.platform.machine = lambda: "x86_64"
processor.check()
"""
    done = time_limit.run(sys.executable, "-c", program)
    assert (done.returncode, done.stdout, done.stderr) == (2, "", f"rtg: {SAID}\n")
