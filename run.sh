#!/usr/bin/env bash
# Everything from a clone to a trained policy: ./run.sh [gathering | FILE.yaml] [flags], ./run.sh --help.
# ./run.sh TOOL ... forwards to the `rtg` command of the virtual environment.
set -euo pipefail
# shellcheck source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

lock_setup
setup_packages "${PACKAGES[@]}"
setup_python
build_preset release rtg_run
unlock_setup
# The processes of a run share the cores, so that NumPy gets no threads, which would spin beside them. Freed memory stays
# with its process: to get it back from the system, page by page, took 3 % of a generation.
export OPENBLAS_NUM_THREADS=1
export GLIBC_TUNABLES=glibc.malloc.trim_threshold=268435456:glibc.malloc.mmap_threshold=33554432${GLIBC_TUNABLES:+:$GLIBC_TUNABLES}
exec "$VENV/bin/python" -m rtg.cli "$@"
