#!/usr/bin/env bash
# How long a skill takes to come to ten nodes at once, as a multiple of the time to
# one, where each host's link carries 100 Mbit/s each way. One JSON line a figure; ends
# with 1 if a bound is broken. Hosts are network namespaces, which needs root.
# Usage: tools/bench/fetch_bench.sh BUILD_DIR [MEBIBYTES]
set -uo pipefail
cd "$(dirname "$0")/../.."
usage="usage: tools/bench/fetch_bench.sh BUILD_DIR [MEBIBYTES]"
. tools/bench/on_nodes.sh "${1:?$usage}"
mebibytes=${2:-50}
nodes=10
most_ratio=1.5
use_skills
mkdir "$scratch/none"
skills=$scratch/none

bridge_hosts $((nodes + 2))
shape_links 100mbit
make_site_token
discovery_port=11811
start_on 1 head --coordinator --cell line --label place=head
start_on 2 keeper --join 10.231.7.1 --label place=keeper
await_joined head keeper
head -c "${mebibytes}MiB" /dev/urandom > "$scratch/skills/echo/model"
"$ROSCELL" skill add "$scratch/skills/echo" --to "$scratch/head/node.sock" \
  > "$scratch/added" || fail "not added"
first_ms=$(await keeper '.event == "build_fetched"' | jq .data.took_ms)
for ((n = 1; n <= nodes; ++n)); do
  start_on $((n + 2)) "n$n" --join 10.231.7.1 --label "place=n$n"
  await_joined head "n$n"
done
for ((n = 1; n <= nodes; ++n)); do
  echo_task "t$n" "n$n" | jq --arg id "s$n" '.pipeline[0] + {id: $id}'
done | jq -s '{type: "task_request", task: "all", pipeline: .}' > "$scratch/task.json"
begin=$(now_ms)
to head request "$scratch/task.json" > "$scratch/reply.json" \
  || fail "refused: $(cat "$scratch/reply.json")"
all_ms=$(($(now_ms) - begin))
slowest_ms=$(for ((n = 1; n <= nodes; ++n)); do
  await "n$n" '.event == "build_fetched"' | jq .data.took_ms
done | sort -n | tail -n 1)
figure "first copy of $mebibytes MiB" "$first_ms" ms
figure "slowest of $nodes copies at once" "$slowest_ms" ms
figure "task on $nodes nodes, from request to running" "$all_ms" ms
ratio=$(jq -n "$slowest_ms / $first_ms")
figure "slowest of $nodes to the first" "$ratio" ""
for ((n = 1; n <= nodes; ++n)); do
  await "n$n" '.event == "build_fetched"' | jq -c '.data.pieces' >&2
done
[[ $(jq -n "$ratio <= $most_ratio") == true ]] \
  || { echo "fetch_bench: more than $most_ratio times the first copy" >&2; exit 1; }
