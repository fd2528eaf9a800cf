#!/usr/bin/env bash
# What a node inside a robot controller costs its control loop: how late the
# cycles of docs/examples/robot_controller at 1 kHz begin, without a node, with
# an idle one, and with one that joins a cell, is transferred to another one and
# back, and runs instances. The three take turns. The loop has the last core,
# with SCHED_FIFO where that is permitted; the node and all else the first.
# One JSON line a figure: medians over the turns and their spread (the distance
# of the quartiles), and whether a thread of the node was ever on the loop's core.
# Needs root and two cores.
# Usage: tools/bench/controller_bench.sh BUILD_DIR [TURNS=20] [SECONDS=10]
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${1:?usage: tools/bench/controller_bench.sh BUILD_DIR [TURNS] [SECONDS]}"
turns=${2:-20}
span_s=${3:-10}
. tools/bench/on_nodes.sh
use_skills echo
loop_core=$(($(nproc) - 1))
# Other programs keep away from the loop's core, too.
taskset -pc 0 $$ > /dev/null
bridge_hosts 3
make_site_token
discovery_port=11811 http_port=8420
start_on 1 alpha --coordinator --cell alpha
start_on 2 beta --coordinator --cell beta
await alpha '.event == "peer_joined"' > /dev/null

# controller KIND OPTION...: one turn; its figures, with the kind.
controller() {
  local kind=$1
  shift
  rm -rf "$scratch/arm"
  ip netns exec "${hosts[2]}" taskset -c "0-$loop_core" \
    "$ROSCELL_BUILD/bin/robot_controller" --name arm \
    --data-dir "$scratch/arm" --interface eth0 --port "$http_port" \
    --public-domain "$public_domain" --site-token "$scratch/site.token" \
    --shim "$ROSCELL_BUILD/bin/roscell-instance-shim" --skills "$skills" \
    --loop-core "$loop_core" --node-core 0 --seconds "$span_s" "$@" \
    2> "$scratch/arm.said" | jq -c --arg kind "$kind" '. + {$kind}'
}

# cores: the cores that threads of the controller but its loop may run on, and
# those that they were last seen on.
cores() {
  local task status
  for task in /proc/"$(pgrep -f "bin/robot_controller --name arm" | tail -n 1)"/task/*; do
    status=$(cat "$task/status" 2> /dev/null) || continue
    awk '/^Cpus_allowed_list/ {print $2}' <<< "$status"
  done | sort | uniq -c | awk '{printf "%s%sx%s", sep, $2, $1; sep = " "}'
}

# work: what the node goes through while the loop runs.
work() {
  await_joined alpha arm
  cores > "$scratch/cores"
  local i
  for ((i = 0; i < 2; ++i)); do
    transfer alpha arm beta > /dev/null
    transfer beta arm alpha > /dev/null
    echo_task "t$i" | jq '.pipeline[0].labels = {}' | to alpha request - \
      > /dev/null
    jq -n --arg task "t$i" '{type: "task_termination", $task}' \
      | to alpha request - > /dev/null
  done
}

for ((turn = 1; turn <= turns; ++turn)); do
  controller "without a node" --without-node
  controller "an idle node" --join "$(discovery_of alpha)"
  work 2> /dev/null &
  worker=$!
  controller "a working node" --join "$(discovery_of alpha)"
  kill "$worker" 2> /dev/null
  wait "$worker" 2> /dev/null
done > "$scratch/turns.jsonl"

jq -sc '
  def at($q): sort | .[((length - 1) * $q | round)];
  group_by(.kind)[] | .[0].kind as $kind | . as $all
  | ("median_us", "p99_9_us", "worst_us")
  | . as $name | [$all[][$name]]
  | {figure: "cycle late, \($kind): \($name | sub("_us$"; ""))",
     value: at(0.5), unit: "us", spread: (at(0.75) - at(0.25)),
     turns: length, real_time: $all[0].real_time}' "$scratch/turns.jsonl"
figure "cores of the working controller's threads" \
  "$(jq -Rn --arg x "$(cat "$scratch/cores")" '$x')" "core x threads"
