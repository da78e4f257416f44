"""The first signal asks, the second does not."""

import os
import signal
import sys

import pytest
from rtg.errors import StoppedError
from rtg.processes.interrupts import Interrupts
from time_limit import run

TWO_SIGNALS = """
import os, signal
from rtg.processes.interrupts import Interrupts
with Interrupts(on_second_signal=lambda: print("at once", flush=True)) as interrupts:
    os.kill(os.getpid(), signal.SIGINT)
    print("asked", interrupts.requested(), flush=True)
    os.kill(os.getpid(), signal.SIGTERM)
    print("never said")
"""


def test_the_first_signal_only_asks():
    before = signal.getsignal(signal.SIGTERM)
    with Interrupts(on_second_signal=lambda: pytest.fail("too early")) as interrupts:
        interrupts.raise_if_requested()
        os.kill(os.getpid(), signal.SIGTERM)
        assert interrupts.requested() and interrupts.number == signal.SIGTERM
        with pytest.raises(StoppedError):
            interrupts.raise_if_requested()
    assert signal.getsignal(signal.SIGTERM) is before


def test_what_nohup_started_does_not_hear_that_the_terminal_closed():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with Interrupts() as interrupts:
            os.kill(os.getpid(), signal.SIGHUP)
            assert not interrupts.requested()
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_closing_terminal_says_it_twice_and_means_it_once():
    with Interrupts(on_second_signal=lambda: pytest.fail("it is the same one")) as interrupts:
        os.kill(os.getpid(), signal.SIGHUP)
        os.kill(os.getpid(), signal.SIGHUP)
        assert interrupts.number == signal.SIGHUP


def test_the_second_signal_ends_the_process():
    done = run(sys.executable, "-c", TWO_SIGNALS)
    assert done.stdout == "asked True\nat once\n"
    assert done.returncode == 128 + signal.SIGTERM
