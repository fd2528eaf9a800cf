#!/usr/bin/env bash
# Whether skills hold out on a computer that has no time for them: 20 instances
# as processes, four busy loops on every core beside them. Tells how many of them
# still run after that, and still do their work. One JSON line a figure.
# Usage: tools/bench/starvation_bench.sh BUILD_DIR [SECONDS]
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${1:?usage: tools/bench/starvation_bench.sh BUILD_DIR [SECONDS]}"
span_s=${2:-600}
count=20
. tools/bench/on_nodes.sh
use_skills

start_node head --coordinator --cell line --interface lo --cpu-floor 0.5
for ((i = 0; i < count; ++i)); do
  echo_task "t$i" > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || { cat "$scratch/reply.json" >&2; exit 1; }
done
for ((i = 0; i < 4 * $(nproc); ++i)); do
  (while :; do :; done) &
  echo $! >> "$scratch/pids"
done
sleep "$span_s"
figure "busy for" "$span_s" s
figure "load" "$(cut -d' ' -f1 /proc/loadavg)" threads
get head /v1/instances > "$scratch/instances.json"
running=$(jq '[.instances[] | select(.state == "running")] | length' \
  "$scratch/instances.json")
figure "instances that run" "$running" of_20
figure "instances that have ended" $((count - running)) of_20
for ((i = 0; i < count; ++i)); do
  echo hello >> "$scratch/data/t$i.in"
done
sleep 5
worked=0
for ((i = 0; i < count; ++i)); do
  if grep -q hello "$scratch/data/t$i.out" 2> /dev/null; then
    worked=$((worked + 1))
  fi
done
figure "instances that did their work within 5 s" "$worked" of_20
jq -c '.instances[] | select(.state != "running") | {instance, state, reason}' \
  "$scratch/instances.json" >&2
[[ $running -eq $count && $worked -eq $count ]]
