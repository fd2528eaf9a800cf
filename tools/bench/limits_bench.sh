#!/usr/bin/env bash
# Measures what cgroups add to the start and the end of an instance that is a
# process: two nodes of one host, one without them, asked in turn. One JSON line a
# figure. Usage: tools/bench/limits_bench.sh BUILD_DIR [ROUNDS]
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${1:?usage: tools/bench/limits_bench.sh BUILD_DIR [ROUNDS]}"
rounds=${2:-40}
. tools/bench/on_nodes.sh
use_skills

for name in none auto; do
  start_node "$name" --coordinator --cell "$name" --interface lo --cgroup "$name"
done
get auto /v1/node | jq -c '{figure: "limits", value: .limits}'

# ask NAME DOCUMENT: how long the answer took, in ms.
ask() {
  curl -sS -o "$scratch/answer" -w '%{time_total}\n' --max-time "$deadline_s" \
    --unix-socket "$scratch/$1/node.sock" -H 'content-type: application/json' \
    --data-binary "@$2" http://node/v1/requests | awk '{print $1 * 1000}'
}

for ((round = 1; round <= rounds; ++round)); do
  echo_task "bench$round" > "$scratch/task.json"
  jq -n --arg task "bench$round" '{type: "task_termination", task: $task}' \
    > "$scratch/end.json"
  for name in none auto; do
    ask "$name" "$scratch/task.json" >> "$scratch/$name.starts"
    since=$(date +%s%N)
    ask "$name" "$scratch/end.json" > "$scratch/ignored"
    await "$name" ".event == \"task_terminated\" and .subject == \"bench$round\"" \
      > /dev/null
    echo $((($(date +%s%N) - since) / 1000000)) >> "$scratch/$name.ends"
  done
done
for name in none auto; do
  figure "order to running, cgroups $name" "$(median < "$scratch/$name.starts")" ms
  figure "order to end, cgroups $name" "$(median < "$scratch/$name.ends")" ms
done
