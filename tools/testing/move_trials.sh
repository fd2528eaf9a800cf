#!/usr/bin/env bash
# Random sites whose nodes are lost in the middle of moves, drains, restarts and
# preemptions, on virtual time: never two of a step run at once, and in the end
# nothing hangs. What fails prints its seed; ROSCELL_SEED=N with the same test
# program tells what happens in that one.
# Usage: tools/testing/move_trials.sh BUILD_DIR [SEEDS [FIRST [PROGRAMS]]]
#   SEEDS     how many (200000)
#   FIRST     the first one (1)
#   PROGRAMS  at a time (as many as there are processors)
set -uo pipefail
build=${1:?usage: tools/testing/move_trials.sh BUILD_DIR [SEEDS [FIRST [PROGRAMS]]]}
seeds=${2:-200000}
first=${3:-1}
programs=${4:-$(nproc)}
share=$(((seeds + programs - 1) / programs))
name='Never two of a step run at once\, whatever is lost and asked for'
children=()
for ((i = 0; i < programs; ++i)); do
  ROSCELL_FIRST=$((first + i * share)) ROSCELL_MOVE_SEEDS=$share \
    nice "$build/bin/test_actors" "$name" > /dev/null &
  children+=($!)
done
bad=0
for child in "${children[@]}"; do
  wait "$child" || bad=1
done
exit "$bad"
