#!/usr/bin/env bash
# The paper's tables of overhead: what a node costs that has nothing to do, as
# coordinator and as member of a cell of six. One JSON line a figure.
#
# Method: six hosts (network namespaces on one bridge), one node on each, a new
# cell for each round. 15 s after the last one has joined the counters are read,
# and SECONDS later again: CPU time of all threads (schedstat), bytes written to
# the disk (/proc/PID/io), bytes and packets of the host's only interface, in
# both directions; and at the end the proportional set size. A figure is the
# median over rounds, of a member over rounds and members. Disk space is that of
# the programs and skills as built, stripped, and of a data directory at the
# end. Where the paper rotates devices, rounds are repeated: all hosts here are
# one machine, so its other load must be small.
#
# Needs root. Usage: tools/bench/overhead_bench.sh BUILD_DIR [SECONDS] [ROUNDS]
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${1:?usage: tools/bench/overhead_bench.sh BUILD_DIR [SECONDS] [ROUNDS]}"
span_s=${2:-120}
rounds=${3:-3}
. tools/bench/on_nodes.sh
. tools/bench/idle_nodes.sh
use_skills
bridge_hosts 6
make_site_token

start_cell() {
  local i
  names=(head)
  start_on 1 head --coordinator --cell line
  for i in 2 3 4 5 6; do
    start_on "$i" "node$i" --join "$(discovery_of head)"
    await_joined head "node$i"
    names+=("node$i")
  done
}

for ((round = 1; round <= rounds; ++round)); do
  start_cell
  timeout 15 tail -f /dev/null
  idle_figures >> "$scratch/all.jsonl"
  for name in "${names[@]}"; do
    stop_node "$name"
    used_kib=$(du -sk "$scratch/$name" | cut -f 1)
    figure "$name: data directory" "$(jq -n "$used_kib / 1024")" MiB \
      >> "$scratch/all.jsonl"
    rm -r "${scratch:?}/$name"
  done
done
# Its name begins with that of the node.
jq -sc '
  map(.figure |= sub("^head:"; "coordinator:")
    | .figure |= sub("^node[0-9]+:"; "member:"))
  | group_by(.figure)[] | sort_by(.value)
  | .[((length - 1) / 2 | floor)] + {of: length}' "$scratch/all.jsonl"
tools/launch/pack.sh "$ROSCELL_BUILD" "$scratch/packed"
figure "programs, light skills and their libraries" \
  "$(jq -n "$(du -sk "$scratch/packed" | cut -f 1) / 1024")" MiB
