#!/usr/bin/env bash
# Builds and runs the tests.
#   ./test.sh             release build, ctest, pytest with the system tests
#   ./test.sh debug       C++ tests in a debug build with AddressSanitizer and UndefinedBehaviorSanitizer
#   ./test.sh tsan        C++ tests that use threads under ThreadSanitizer
#   ./test.sh coverage    line coverage of the physics and the solver by their own tests
#   ./test.sh bench       benchmarks and gates: JSON and Markdown in build/bench/ (40 minutes; --smoke: briefly, no gates on time)
#   ./test.sh bits        the same transitions from builds for several processors (five minutes and a build)
#   ./test.sh chaos       runs beside losses, kills, pauses, strangers, full disks (two hours; --smoke: briefly, no gates on time)
#   ./test.sh fuzz        a million inputs to each fuzz target, with Clang and libFuzzer (an hour; --smoke: 5,000 inputs each)
#   ./test.sh peer        the reverse solver against CasADi and IPOPT (ten minutes)
# bench and peer install CasADi, whose package also holds HPIPM.
set -euo pipefail
# shellcheck source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

usage() { sed -n '3,11s/^# *//p' "${BASH_SOURCE[0]}"; }

set_up() { # PRESET TARGET [REQUIREMENTS]
  lock_setup
  setup_packages "${PACKAGES[@]}" "${TEST_PACKAGES[@]}"
  setup_python
  if (($# > 2)); then pip_install -r "$3"; fi
  build_preset "$1" "$2"
  unlock_setup
}

run_ctest() { # PRESET [CTEST_OPTION...]
  local preset=$1
  shift
  say "ctest, build/$preset"
  (cd "$ROOT" && ctest --preset "$preset" --parallel "$(nproc)" "$@")
}

run_pytest() {
  say "pytest"
  (cd "$ROOT" && "$VENV/bin/python" -m pytest \
    --numprocesses "$(nproc)" --dist loadfile --no-loadscope-reorder)
}

coverage() {
  local folder=$ROOT/build/coverage subject='core/(math|energy|forward|reverse)/'
  find "$folder" -name '*.gcda' -delete
  run_ctest coverage --tests-regex "^${subject//\//.}"
  (cd "$ROOT" && "$VENV/bin/gcovr" --root . --object-directory "$folder" \
    --filter "$subject" --exclude-throw-branches \
    --gcov-ignore-parse-errors --sort uncovered-percent \
    --txt --txt-summary --html-details "$folder/coverage.html" --fail-under-line 95)
}

run_benches() { # OUT [--smoke]
  local out=$1 status=0
  shift
  cd "$ROOT/tests/bench"
  "$VENV/bin/python" table.py "$ROOT/build/release" "$out" "$@" || status=1
  "$VENV/bin/python" learner.py "$@" | tee "$out/learner.txt" || status=1
  "$VENV/bin/python" binding.py "$ROOT/build/release" "$@" | tee "$out/binding.txt" || status=1
  "$VENV/bin/python" generation.py "$ROOT/build/release" "$@" | tee "$out/generation.txt" || status=1
  "$VENV/bin/python" whole.py "$out/whole" --seeds 1,2,3 "$@" || status=1
  return $status
}

bench() { # [--smoke]
  local out=$ROOT/build/bench status=0
  rm -rf "$out"
  mkdir -p "$out"
  run_benches "$out" "$@" | tee "$out/all.txt" || status=1
  say "gates: $(grep -c '^gate .* PASS$' "$out/all.txt") hold, $(grep -c '^gate .* FAIL$' "$out/all.txt") fail"
  grep '^gate .* FAIL$' "$out/all.txt" >&2 || true
  return $status
}

case $* in # all words, so that one too many is unknown
  '' | all)
    set_up release all
    status=0
    run_ctest release || status=1
    run_pytest || status=1
    exit $status
    ;;
  debug)
    set_up debug rtg_cpp_tests
    run_ctest debug
    ;;
  tsan)
    set_up tsan rtg_thread_tests
    run_ctest tsan --label-regex threads
    ;;
  coverage)
    set_up coverage rtg_cpp_tests
    coverage
    ;;
  bench | 'bench --smoke')
    set_up release all "$ROOT/tests/bench/requirements.txt"
    set_environment
    bench "${@:2}"
    ;;
  bits)
    set_up release generate_bench
    setup_packages qemu-user
    set_environment
    exec "$VENV/bin/python" "$ROOT/tests/bench/same_bits.py" "$ROOT/build/release"
    ;;
  chaos | 'chaos '*)
    set_up release rtg_run
    set_environment
    export PYTHONPATH=$ROOT/train:$ROOT/tests/support:$ROOT/tests/system:$ROOT/tests/bench
    exec "$VENV/bin/python" "$ROOT/tests/chaos/chaos.py" "${@:2}"
    ;;
  fuzz | 'fuzz --smoke')
    TEST_PACKAGES+=("${FUZZ_PACKAGES[@]}")
    set_up fuzz rtg_fuzz
    exec "$VENV/bin/python" "$ROOT/tests/fuzz/fuzz.py" "${@:2}"
    ;;
  peer | 'peer '*)
    set_up release peer_dump "$ROOT/tests/bench/requirements.txt"
    exec "$VENV/bin/python" "$ROOT/tests/bench/peer.py" "$ROOT/build/release" "${@:2}"
    ;;
  -h | --help) usage ;;
  *)
    say "unknown: $*"
    usage >&2
    exit 2
    ;;
esac
