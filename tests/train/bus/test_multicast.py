"""Checks what is said about networks that LCM cannot use."""

import os
import subprocess
import sys

import pytest
from rtg import paths
from rtg.bus.multicast import defect

URL = "udpm://239.255.76.67:7667?ttl=0"
SAY = ["-c", f"from rtg.bus.multicast import defect; print(defect({URL!r}))"]


def said(*wrapper):
    done = subprocess.run(
        [*wrapper, sys.executable, *SAY],
        env={**os.environ, "PYTHONPATH": str(paths.ROOT / "train")},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode == 77 or "unshare" in done.stderr:
        pytest.skip("this machine forbids network namespaces")
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_a_network_with_a_multicast_route_has_no_defect():
    assert said(paths.ROOT / "tests/support/private_network.sh") == "None"


def test_a_machine_without_any_network_has_one():
    assert said("unshare", "--map-root-user", "--net") == (
        "multicast to 239.255.76.67: no such device. To mend it: "
        "sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo"
    )


def test_a_bus_of_one_process_is_none_for_a_process_graph():
    words = "memq:// is for one process only; run.bus = udpm://… is for several"
    assert defect("memq://") == words
