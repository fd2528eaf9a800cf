#!/usr/bin/env bash
# What a thousand builds of skills cost the cell that knows them: time of
# `roscell skills`, memory of the coordinator and of the second keeper, CPU time while
# nothing happens. One JSON line a figure; ends with 1 if a bound is broken.
# Usage: tools/bench/builds_bench.sh BUILD_DIR [BUILDS]
set -uo pipefail
cd "$(dirname "$0")/../.."
. tools/bench/on_nodes.sh "${1:?usage: tools/bench/builds_bench.sh BUILD_DIR [BUILDS]}"
builds=${2:-1000}
most_list_ms=100
most_kib=2048
idle_s=20
use_skills
mkdir "$scratch/none"
skills=$scratch/none
start_node head --coordinator --cell line --interface lo
start_node arm --interface lo --join "$(discovery_of head)"
await_joined head arm

add_builds() {
  local n text
  for ((n = $1; n <= $2; ++n)); do
    text=$(jq --arg v "$n" '.version = $v' "$scratch/skills/echo/skill.json")
    echo "$text" > "$scratch/skills/echo/skill.json"
    "$ROSCELL" skill add "$scratch/skills/echo" --to "$scratch/head/node.sock" \
      > "$scratch/added" 2>&1 || fail "not added: $(cat "$scratch/added")"
  done
}

# The first ones have everything that is there once come into memory.
warm_up=20
add_builds 1 "$warm_up"
declare -A before grown
for node in head arm; do
  before[$node]=$(memory_kib "$node" Pss_Anon)
done
begin=$(now_ms)
add_builds $((warm_up + 1)) "$builds"
figure "adding a build" "$(jq -n "($(now_ms) - $begin) / ($builds - $warm_up)")" ms
for node in head arm; do
  grown[$node]=$(($(memory_kib "$node" Pss_Anon) - ${before[$node]}))
  figure "memory of $node for $((builds - warm_up)) builds" "${grown[$node]}" KiB
done
list_ms=$(for ((n = 0; n < 9; ++n)); do
  begin=$(now_ms)
  "$ROSCELL" skills --to "$scratch/head/node.sock" > "$scratch/listed"
  echo $(($(now_ms) - begin))
done | median)
figure "roscell skills" "$list_ms" ms
# Threads that rest have ended by then: with them goes the time that they ran.
settling_s=3
sleep "$settling_s"
begin=$(cpu_ns head)
sleep "$idle_s"
figure "coordinator, idle" \
  "$(jq -n "($(cpu_ns head) - $begin) / $idle_s / 1e7")" "% of a core"
broken=0
((list_ms <= most_list_ms)) \
  || { echo "builds_bench: the list takes too long" >&2; broken=1; }
((grown[head] <= most_kib && grown[arm] <= most_kib)) \
  || { echo "builds_bench: too much memory" >&2; broken=1; }
exit "$broken"
