#!/usr/bin/env bash
# Measures an idle cell of six hosts (network namespaces on one bridge): CPU,
# memory and wire of its nodes, and how long joining and starting take. One JSON
# line a figure. Needs root. Usage: tools/bench/idle_bench.sh BUILD_DIR [SECONDS]
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${1:?usage: tools/bench/idle_bench.sh BUILD_DIR [SECONDS]}"
span_s=${2:-60}
. tools/bench/on_nodes.sh
use_skills

# cpu_ns NAME: time that all threads of the node have run.
cpu_ns() {
  cat /proc/"${pid_of[$1]}"/task/*/schedstat | awk '{sum += $1} END {print sum}'
}

memory_kib() {
  awk -v key="$2:" '$1 == key {print $2}' "/proc/${pid_of[$1]}/smaps_rollup"
}

tx_bytes() {
  ip netns exec "${hosts[$1]}" cat /sys/class/net/eth0/statistics/tx_bytes
}

# Processes behind `ip netns exec`, which replaces itself by the node.
declare -A pid_of
note_pid() {
  pid_of[$1]=${pid[$1]}
}

bridge_hosts 6
make_site_token
begin=$(now_ms)
start_on 1 head --coordinator --cell line
figure "coordinator: start to ready" $(($(now_ms) - begin)) ms
note_pid head
server=$(discovery_of head)
names=(head)
for i in 2 3 4 5 6; do
  begin=$(now_ms)
  start_on "$i" "node$i" --join "$server"
  await_joined head "node$i"
  joined=$(await head ".event == \"node_joined\" and .subject == \"node$i\"" \
    | jq .time_unix_ms)
  figure "member $i: start to joined" $((joined - begin)) ms
  note_pid "node$i"
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
for i in "${!names[@]}"; do
  cpu[i]=$(cpu_ns "${names[i]}")
  tx[i]=$(tx_bytes "$i")
done
timeout "$span_s" tail -f /dev/null
for i in "${!names[@]}"; do
  name=${names[i]}
  figure "$name: idle CPU" \
    "$(jq -n "($(cpu_ns "$name") - ${cpu[i]}) / 1e9 / $span_s * 100")" \
    "% of a core over $span_s s"
  figure "$name: idle wire" \
    "$(jq -n "($(tx_bytes "$i") - ${tx[i]}) / $span_s")" "B/s sent"
  figure "$name: PSS" "$(jq -n "$(memory_kib "$name" Pss) / 1024")" MiB
  figure "$name: Private_Dirty" \
    "$(jq -n "$(memory_kib "$name" Private_Dirty) / 1024")" MiB
  figure "$name: RSS" "$(jq -n "$(memory_kib "$name" Rss) / 1024")" MiB
done
