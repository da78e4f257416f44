"""Three workers, one after the other, that fall silent at their first unit: CONFIG.yaml KEY."""

import sys
import time

from rtg import _core
from rtg.bus.bus import open_bus

SILENCE = 2.5  # [s]; 2 s without a beat and a worker is lost


def main(config: str, key: str) -> None:
    bus = open_bus(_core.Config.from_file(config).run.bus, _core.RunKey.read(key))
    servers, units = [], []
    bus.subscribe("RTG_REPLAY_BEAT", "worker_beat_t", servers.append)
    bus.subscribe("RTG_REVERSE_JOB", "reverse_job_t", units.append)
    for incarnation in range(1, 4):
        while not any(unit.to == incarnation for unit in units):
            if servers:  # all programs of a run have the same configuration
                beat = {"config": servers[-1].config, "capacity": 1, "incarnation": incarnation}
                bus.publish("RTG_REVERSE_BEAT", "worker_beat_t", **beat)
            bus.spin(0.05)
        time.sleep(SILENCE)


if __name__ == "__main__":
    main(*sys.argv[1:])
