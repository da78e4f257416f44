#!/usr/bin/env bash
# Runs the programs of one run over LCM, until its transitions are where they are wanted:
#
#   ./graph.sh FOLDER [trainer [--resume] [--log NAMES] | recorder]
#
# FOLDER/config.yaml is the resolved configuration (./run.sh TASK --print-config). FOLDER gets generation.json,
# logs/PROGRAM.log, and what the trainer writes or, of the recorder, transitions.npz alone; while the programs run also
# run.key, the secret of the run on the bus, a new one each time: with an old one, messages of then would count again.
# Environment: RTG_RUN, the name of the key (FOLDER's), RTG_KEY=given: FOLDER has it already, RTG_NODES
# (build/release/nodes), RTG_PYTHON (.venv/bin/python).
# Workers, server and logger are started again when they die before the coordinator has ended, and the coordinator when it
# is killed: it goes on from FOLDER/generation.journal, which the consumer removes in the end. Where another program fails,
# all end with its status; where the search falls short, with 1 after the consumer. SIGINT, SIGTERM or SIGHUP ends all, the
# trainer with a checkpoint; a second SIGINT or SIGTERM at once.
set -uo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
nodes=${RTG_NODES:-$root/build/release/nodes} python=${RTG_PYTHON:-$root/.venv/bin/python}
refuse() { # WHY
  echo "graph.sh: $1" >&2
  exit 2
}
[[ -f ${1:-}/config.yaml ]] || refuse "'${1:-}' is no folder with a config.yaml; legal: graph.sh FOLDER [trainer [--resume] [--log NAMES] | recorder]"
folder=$(cd -- "$1" && pwd)
consumer=${2:-trainer} flags=("${@:3}") config=$folder/config.yaml key=$folder/run.key logs=$folder/logs
journal=$folder/generation.journal journaled=0 # its size when the coordinator last died

program() { # NAME: becomes that program; by hand they can be started in any order
  # Out of the terminal's reach, but not longer than this script, which may end while it starts a program.
  local be=(exec setsid setpriv --pdeathsig KILL "$BASH" -c '((PPID == $1)) && exec "${@:2}"' _ $$)
  case $1 in
    forward_sim_server)
      if grep -qE '^  engine: (box2d|newton) ' "$config"; then "${be[@]}" "$nodes/rtg_forward_sim_server" "$config" "$key"; fi
      "${be[@]}" "$python" -m rtg.engines.server "$config" "$key"
      ;;
    reverse_worker_*) "${be[@]}" "$nodes/rtg_reverse_worker" "$config" "$key" "${1##*_}" ;;
    beam_coordinator) "${be[@]}" "$nodes/rtg_beam_coordinator" "$config" "$key" "$folder" ;;
    trainer) "${be[@]}" "$python" -m rtg.learn.trainer "$folder" "${flags[@]}" ;;
    recorder) "${be[@]}" "$python" -m rtg.bus.record "$config" "$key" "$folder/transitions.npz" ;;
    lcm_logger) "${be[@]}" "$python" -m rtg.bus.lcm_tools "$config" "$folder/lcm.log" ;;
  esac
}

declare -A running=() started=() deaths=() # name by pid; by name: when, and how often in a row soon after

start() { # NAME
  program "$1" </dev/null >>"$logs/$1.log" 2>&1 {held}>&- &
  running[$!]=$1 started[$1]=$SECONDS
}

stop() { # STATUS: ends all programs, at once on a further SIGINT or SIGTERM, and this script
  local pids deadline=$((SECONDS + 20))
  pids=$(jobs -p) # not those of `running` alone: a signal may come before start has noted the program
  trap 'kill -KILL $pids' INT TERM
  trap '' HUP # a terminal that closes sends it twice
  kill $pids
  while kill -0 $pids && ((SECONDS < deadline)); do sleep 0.1; done
  kill -KILL $pids
  wait
  if [[ ${RTG_KEY:-} != given ]]; then rm -f "$key"; fi
  exit "$1"
}

died_soon() { # NAME: whether it has done little since its start
  if [[ $1 != beam_coordinator ]]; then return $((SECONDS - started[$1] >= 5)); fi
  local before=$journaled
  journaled=$(stat -c %s "$journal" || echo 0)
  ((journaled <= before))
}

may_start_again() { # NAME STATUS
  case $1:$2 in
    *:2 | *:4 | "$consumer":*) false ;; # bad input, an engine that fails
    beam_coordinator:137) [[ -e $journal ]] ;;
    beam_coordinator:*) false ;;
  esac
}

on_failure() { # NAME STATUS
  local how="ended with exit status $2"
  if (($2 > 128)); then how="was killed by SIG$(kill -l $(($2 - 128)))"; fi
  if died_soon "$1"; then deaths[$1]=$((${deaths[$1]:-0} + 1)); else deaths[$1]=0; fi
  if ! may_start_again "$1" "$2" || ((deaths[$1] == 10)); then
    echo "$1 $how; the end of $logs/$1.log:"
    tail -n 30 "$logs/$1.log"
    stop "$2"
  fi
  if [[ $1 != beam_coordinator ]] && ! is_running beam_coordinator; then return; fi
  echo "$1 $how, started again"
  start "$1"
}

shortfalls() { # what the search did not find, a line each
  sed -n 's/.*"shortfalls":\["\([^]]*\)"\].*/\1/p' "$folder/generation.json" | sed 's/","/\n/g'
}

fell_short() { # whether the coordinator has ended because of that: its last line says so
  [[ $(tail -n 1 "$logs/beam_coordinator.log") == "rtg_beam_coordinator: $(shortfalls | tail -n 1)" ]]
}

setting() { sed -n "/^run:/,\$ s/^  $1: \([^ ]*\).*/\1/p" "$config"; } # KEY: its value in the section run
listens() { (($(ls -l "/proc/$1/fd" | grep -c socket:) > 1)); }         # PID: LCM has a socket to send and, then, one to receive
is_running() { [[ " ${running[*]} " == *" $1 "* ]]; }                   # NAME

case "$consumer ${flags[*]}" in
  'trainer ' | 'trainer --resume' | 'recorder ' | 'trainer --log '* | 'trainer --resume --log '*) ;;
  *) refuse "no consumer '$consumer${flags[*]:+ ${flags[*]}}'; legal: trainer, trainer --resume, either with --log NAMES, recorder" ;;
esac
workers=$(setting workers)
[[ $workers =~ ^[1-9][0-9]*$ ]] || refuse "$config: run.workers is '$workers'; legal: a file that ./run.sh TASK --print-config has printed"
unwritable="'$folder' cannot be written (.graph.lock, logs/, generation.json); legal: a folder to write to"
# The lock is held by this script alone: the kernel releases it at once when it ends.
{ exec {held}>"$folder/.graph.lock"; } 2>/dev/null || refuse "$unwritable"
# Who only asks whether it is held has it for a moment, too.
flock --wait 1 "$held" || refuse "another graph.sh works in '$folder'; legal: another folder, or wait"
{ mkdir -p "$logs" && [[ -w $logs ]] && rm -f "$folder/generation.json"; } 2>/dev/null || refuse "$unwritable"
if [[ ${RTG_KEY:-} != given ]]; then
  rm -f "$key"
  "$python" -m rtg.bus.new_key "$key" "${RTG_RUN:-${folder##*/}}" || exit
fi
exec 2>/dev/null # bash's own words about programs that have ended
trap 'stop 130' INT
trap 'stop 143' TERM
trap 'stop 129' HUP # which nohup keeps from it
if [[ $(setting record) == true ]]; then
  start lcm_logger
  for ((k = 0; k < 100; ++k)); do # until it hears the others
    if listens $!; then break; fi
    sleep 0.1
  done
fi
for ((k = 0; k < workers; ++k)); do start "reverse_worker_$k"; done
start forward_sim_server
start beam_coordinator
start "$consumer"
deadline=
while is_running "$consumer" || is_running beam_coordinator; do
  sleep 0.2
  for pid in "${!running[@]}"; do
    if kill -0 "$pid"; then continue; fi
    wait "$pid"
    status=$? name=${running[$pid]}
    unset "running[$pid]"
    case $name:$status in
      *:0) ;;
      beam_coordinator:1) fell_short || on_failure "$name" "$status" ;;
      beam_coordinator:3) tail -n 1 "$logs/$name.log" ;; # the data are whole, but units of work were given up
      *) on_failure "$name" "$status" ;;
    esac
  done
  if is_running "$consumer"; then continue; fi
  # The consumer's last acknowledgements may be lost. The coordinator then waits in vain.
  if ((SECONDS > ${deadline:=$((SECONDS + 5))})); then break; fi
done
lacks=$(shortfalls)
if [[ $lacks ]]; then
  echo "$lacks"
  stop 1
fi
stop 0
