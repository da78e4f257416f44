"""The recorder with a receive buffer of another size: CONFIG.yaml RUN FILE.npz [RECEIVE_BUFFER]."""

import sys

from rtg.bus import bus, record

if __name__ == "__main__":
    if len(sys.argv) > 4:
        bus.RECEIVE_BUFFER = int(sys.argv.pop())  # [bytes]
    sys.exit(record.main(sys.argv[1:]))
