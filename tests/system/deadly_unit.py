"""Three workers, one after the other, that fall silent at their first unit: CONFIG.yaml RUN."""

import sys
import time

from rtg import _core
from rtg.bus.bus import Bus
from rtg.bus.messages import message_type

SILENCE = 2.5  # [s]; 2 s without a beat and a worker is lost


def main(config: str, run: str) -> None:
    bus = Bus(_core.Config.from_file(config).run.bus, run)
    servers, units = [], []
    bus.subscribe("RTG_REPLAY_BEAT", message_type("worker_beat_t"), servers.append)
    bus.subscribe("RTG_REVERSE_JOB", message_type("reverse_job_t"), units.append)
    beat = message_type("worker_beat_t")()
    beat.capacity = 1
    for beat.incarnation in range(1, 4):
        while not any(unit.to == beat.incarnation for unit in units):
            if servers:
                beat.config = servers[-1].config  # all programs of a run have the same one
                bus.publish("RTG_REVERSE_BEAT", beat)
            bus.spin(0.05)
        time.sleep(SILENCE)


if __name__ == "__main__":
    main(*sys.argv[1:])
