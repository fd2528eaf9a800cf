#!/usr/bin/env bash
# run.sh PROGRAM DICTIONARY SEED...: lets a fuzzer run for $ROSCELL_FUZZ_SECONDS.
# It begins from the seeds and from what earlier runs have found worth keeping,
# in $ROSCELL_CORPUS/NAME, and keeps there what it finds.
set -euo pipefail
program=$1 dictionary=$2
corpus=${ROSCELL_CORPUS:-$(dirname "$dictionary")/corpus}/$(basename "$program")
mkdir -p "$corpus"
exec "$program" -max_total_time="${ROSCELL_FUZZ_SECONDS:-30}" -timeout=20 \
  -dict="$dictionary" -print_final_stats=1 "$corpus" "${@:3}"
