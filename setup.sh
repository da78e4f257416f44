# Set-up shared by run.sh and test.sh; sourced, never run. Every step is idempotent, says on stderr what it
# does, and costs nothing once it is done. Calls at the same time wait for each other.

ROOT=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
VENV=$ROOT/.venv
MADE_FROM=$VENV/.made-from # stamp of a finished .venv

# Debian and Ubuntu names; "a|b" is satisfied by either (Ubuntu 24.04 renamed some).
PACKAGES=(
  g++ python3-venv python3-dev 'libglib2.0-0|libglib2.0-0t64'
  libeigen3-dev libsuitesparse-dev libbox2d-dev libgeos-dev libsleef-dev libsodium-dev libyaml-cpp-dev libutfcpp-dev nlohmann-json3-dev
  libgtest-dev libbenchmark-dev # one configuration of the build serves both commands
)
TEST_PACKAGES=(ccache iproute2 nftables util-linux)
FUZZ_PACKAGES=(clang-19 libclang-rt-19-dev) # GCC has no libFuzzer; Clang 14, which is Debian's default, lacks CTAD of aggregates

say() { printf 'rtg: %s\n' "$*" >&2; }

fail() {
  say "$*"
  exit 1
}

# The processes of a run share the cores, so that NumPy gets no threads, which would spin beside them. Freed memory stays
# with its process: to get it back from the system, page by page, took 3 % of a generation.
set_environment() {
  export OPENBLAS_NUM_THREADS=${OPENBLAS_NUM_THREADS:-1}
  export GLIBC_TUNABLES=glibc.malloc.trim_threshold=268435456:glibc.malloc.mmap_threshold=33554432${GLIBC_TUNABLES:+:$GLIBC_TUNABLES}
}

# One set-up at a time in this checkout; released by unlock_setup or by the end of the process.
lock_setup() {
  if ! { mkdir -p "$ROOT/build" && exec 9>"$ROOT/build/.setup.lock"; } 2>/dev/null; then
    say "$ROOT/build cannot be written; legal: a checkout in a folder to write to"
    exit 2
  fi
  if ! flock --nonblock 9; then
    say "waiting for another set-up in $ROOT"
    flock 9
  fi
  if [[ ! -f $MADE_FROM ]]; then
    say "first call: sets everything up, which takes five to ten minutes; a second one starts at once"
  fi
}

unlock_setup() { exec 9>&-; }

is_installed() { # "a|b" of Debian packages
  local name
  for name in ${1//|/ }; do
    if [[ $(dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null) == installed ]]; then
      return 0
    fi
  done
  return 1
}

apt_install() {
  local as_root=()
  if ((EUID != 0)); then as_root=(sudo); fi
  "${as_root[@]}" apt-get update -qq || say "apt-get update failed; trying with the lists at hand"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "$@"
}

may_install() {
  ((EUID == 0)) || { command -v sudo && { [[ -t 0 ]] || sudo -n true; }; } &>/dev/null
}

# setup_packages NAME...: Debian packages, through apt when root or sudo.
setup_packages() {
  if ! command -v dpkg-query >/dev/null; then
    say "no Debian or Ubuntu: taking for granted what these packages hold: $*"
    return
  fi
  local package missing=()
  for package in "$@"; do
    is_installed "$package" || missing+=("${package%%|*}")
  done
  ((${#missing[@]})) || return 0
  may_install || fail "missing Debian packages, and neither root nor sudo to install them. Ask for:
  apt-get install ${missing[*]}"
  say "installing Debian packages, a minute or two: ${missing[*]}"
  mkdir -p "$ROOT/build"
  if ! apt_install "${missing[@]}" >"$ROOT/build/apt.log" 2>&1 9>&-; then
    tail -n 20 "$ROOT/build/apt.log" >&2
    fail "apt-get could not install: ${missing[*]} (whole log: build/apt.log)"
  fi
}

find_python() {
  local python
  for python in python3 python3.11 python3.12 python3.13 python3.14; do
    if "$python" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 15))' 2>/dev/null; then
      command -v "$python"
      return
    fi
  done
  fail "no Python 3.11 to 3.14 found. Debian 12 and Ubuntu 24.04 have one: apt-get install python3"
}

pip_install() {
  if ! "$VENV/bin/python" -m pip install --quiet --disable-pip-version-check "$@" \
    >"$ROOT/build/pip.log" 2>&1 9>&-; then
    tail -n 20 "$ROOT/build/pip.log" >&2
    fail "pip could not install the Python packages (whole log: build/pip.log)"
  fi
}

# .venv with the pinned packages of train/requirements.txt; it finds the package rtg where it lies, in train/.
# The stamp holds what the environment was made from; a moved checkout is made anew.
setup_python() {
  local wanted
  wanted="$ROOT $(sha256sum <"$ROOT/train/requirements.txt")"
  if [[ -x $VENV/bin/python && -f $MADE_FROM && $(<"$MADE_FROM") == "$wanted" ]]; then return; fi
  local python
  python=$(find_python) || exit 1
  if [[ ! -f $MADE_FROM || $(<"$MADE_FROM") != "$ROOT "* ]] || ! "$VENV/bin/python" -c '' 2>/dev/null; then
    [[ ! -L $VENV ]] || fail ".venv is a link to $(readlink "$VENV"), whose content would go; remove the link"
    say "creating .venv with $("$python" --version)"
    "$python" -m venv --clear "$VENV" 9>&- || fail "$python -m venv failed"
  fi
  say "installing the Python packages of train/requirements.txt, about two minutes (torch is 200 MB)"
  pip_install -r "$ROOT/train/requirements.txt"
  printf '%s\n' "$ROOT/train" >"$("$VENV/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/rtg.pth"
  printf '%s\n' "$wanted" >"$MADE_FROM"
}

# build_progress PRESET LOG: says on stderr how many steps ninja has to do, if any; on a terminal, shows each as one
# changing line. ninja's output goes to LOG.
build_progress() {
  local line steps= cores
  cores=$(nproc)
  while IFS= read -r line; do
    printf '%s\n' "$line" >>"$2"
    if [[ ! $line =~ ^\[[1-9][0-9]*/([0-9]+)\]\ (.*) ]]; then continue; fi # [0/2]: ninja looks for new files
    if [[ ${BASH_REMATCH[2]} == Re-running* ]]; then continue; fi
    if [[ -z $steps ]]; then
      steps=${BASH_REMATCH[1]}
      say "building build/$1: $steps steps, about $((steps / 30 / cores + 1)) min on $cores cores" # 2 s of a core each
    fi
    if [[ -t 2 ]]; then printf '\r\033[K%s' "${line:0:100}" >&2; fi
  done
  if [[ -t 2 ]]; then printf '\r\033[K' >&2; fi
}

# build_preset PRESET TARGET [CMAKE_OPTION...]: configures where presets are newer, builds what changed, quiet unless it fails.
build_preset() {
  local preset=$1 target=$2
  shift 2
  local folder=$ROOT/build/$preset log=$ROOT/build/$preset.log
  export PATH=$VENV/bin:$PATH
  : >"$log"
  if [[ ! -f $folder/build.ninja || $ROOT/CMakePresets.json -nt $folder/build.ninja ]]; then
    say "configuring build/$preset"
    if ! (cd "$ROOT" && cmake --preset "$preset" "$@") >"$log" 2>&1 9>&-; then
      tail -n 30 "$log" >&2
      fail "cmake could not configure (whole log: build/$preset.log)"
    fi
    touch "$folder/build.ninja" # CMake leaves it as old as it was where nothing changed
  fi
  if ! (set -o pipefail && ninja -C "$folder" "$target" 2>&1 9>&- | build_progress "$preset" "$log"); then
    grep -vE '^\[[0-9]+/[0-9]+\] ' "$log" | tail -n 60 >&2
    fail "the build failed (whole log: build/$preset.log)"
  fi
}
