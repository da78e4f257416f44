"""Runs a command beside a Ray cluster of two nodes on the loopback device, and kills one of them.

`python ray_cluster.py FILE FILE COMMAND...`: the second node, with whatever runs on it, is killed
once both files exist. "ADDRESS" in the command stands for the address of the cluster. The exit
status is that of the command.
"""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

from ray.cluster_utils import Cluster

_NODE = {"num_cpus": 1, "object_store_memory": 80_000_000, "node_ip_address": "127.0.0.1"}
_DETECTION = {  # of a dead node, within seconds
    "health_check_initial_delay_ms": 0,
    "health_check_period_ms": 1000,
    "health_check_failure_threshold": 3,
}


def main(files: list[Path], command: list[str]) -> int:
    cluster = Cluster(
        initialize_head=True,
        head_node_args={**_NODE, "include_dashboard": False, "_system_config": _DETECTION},
    )
    node = cluster.add_node(**_NODE)
    cluster.wait_for_nodes()
    words = [word.replace("ADDRESS", cluster.address) for word in command]
    with subprocess.Popen(words) as process:
        while process.poll() is None and not all(file.exists() for file in files):
            time.sleep(0.02)
        cluster.remove_node(node, allow_graceful=False)
        print("node killed", flush=True)
        status = process.wait(300.0)
    cluster.shutdown()
    return status


if __name__ == "__main__":
    sys.exit(main([Path(word) for word in sys.argv[1:3]], sys.argv[3:]))
