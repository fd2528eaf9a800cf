#!/usr/bin/env bash
# Measures an idle cell of six hosts (network namespaces on one bridge): CPU,
# memory and wire of its nodes, and how long joining and starting take. One JSON
# line a figure. Needs root. Usage: tools/bench/idle_bench.sh BUILD_DIR [SECONDS]
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${1:?usage: tools/bench/idle_bench.sh BUILD_DIR [SECONDS]}"
span_s=${2:-60}
. tools/bench/on_nodes.sh
. tools/bench/idle_nodes.sh
use_skills

bridge_hosts 6
make_site_token
begin=$(now_ms)
start_on 1 head --coordinator --cell line
figure "coordinator: start to ready" $(($(now_ms) - begin)) ms
server=$(discovery_of head)
names=(head)
for i in 2 3 4 5 6; do
  begin=$(now_ms)
  start_on "$i" "node$i" --join "$server"
  await_joined head "node$i"
  joined=$(await head ".event == \"node_joined\" and .subject == \"node$i\"" \
    | jq .time_unix_ms)
  figure "member $i: start to joined" $((joined - begin)) ms
  names+=("node$i")
done

for round in 1 2 3 4 5; do
  echo_task "bench$round" > "$scratch/task.json"
  begin=$(now_ms)
  to head request "$scratch/task.json" > /dev/null
  figure "request to running, client included, run $round" \
    $(($(now_ms) - begin)) ms
  echo "{\"type\":\"task_termination\",\"task\":\"bench$round\"}" \
    | to head request > /dev/null
done

# What is measured begins once the cell is at rest.
timeout 15 tail -f /dev/null
idle_figures
