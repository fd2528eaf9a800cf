#!/usr/bin/env bash
# busy.sh COMMAND...: runs the command beside a busy loop on every core, as on a
# machine that has other work.
set -uo pipefail
loops=()
trap 'kill "${loops[@]}"' EXIT
trap 'exit 130' INT TERM
for ((core = 0; core < $(nproc); ++core)); do
  setpriv --pdeathsig KILL -- bash -c 'while :; do :; done' &
  loops+=($!)
done
"$@"
