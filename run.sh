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
set_environment
exec "$VENV/bin/python" -m rtg.cli "$@"
