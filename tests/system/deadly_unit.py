"""A worker that dies at its first unit and is started again, five times: CONFIG.yaml KEY."""

import sys
import time

from rtg import _core
from rtg.bus.bus import open_bus

SILENCE = 2.5  # [s]; after 2 s without a beat a worker with a successor is lost
LIVES = 5  # that a unit may cost


def main(config: str, key: str) -> None:
    bus = open_bus(_core.Config.from_file(config).run.bus, _core.RunKey.read(key))
    servers, units = [], []
    bus.subscribe("RTG_REPLAY_BEAT", "worker_beat_t", servers.append)
    bus.subscribe("RTG_REVERSE_JOB", "reverse_job_t", units.append)

    def beat(incarnation: int, held: list[int]) -> None:
        if servers:  # all programs of a run have the same configuration
            state = {"config": servers[-1].config, "incarnation": incarnation, "capacity": 1}
            bus.publish("RTG_REVERSE_BEAT", "worker_beat_t", **state, held=held)
        bus.spin(0.05)

    for incarnation in range(1, LIVES + 1):
        while not (mine := [unit.job_id for unit in units if unit.to == incarnation]):
            beat(incarnation, [])
        beat(incarnation, mine)
        time.sleep(SILENCE)
    for _ in range(20):
        beat(LIVES + 1, [])


if __name__ == "__main__":
    main(*sys.argv[1:])
