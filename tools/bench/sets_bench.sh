#!/usr/bin/env bash
# How long a set of tasks takes to run on all robots, from `roscell apply` on, and what
# a set costs a coordinator that has nothing to do. One JSON line a figure; ends with 1
# if a bound is broken. Usage: tools/bench/sets_bench.sh BUILD_DIR [ROBOTS]
set -uo pipefail
cd "$(dirname "$0")/../.."
. tools/bench/on_nodes.sh "${1:?usage: tools/bench/sets_bench.sh BUILD_DIR [ROBOTS]}"
robots=${2:-20}
most_start_ms=2000
idle_s=30
use_skills
start_node head --coordinator --cell line --interface lo
mkdir -p "$scratch/data"
for ((n = 1; n <= robots; ++n)); do
  touch "$scratch/data/r$n.in"
  start_node "r$n" --join "$(discovery_of head)" --interface lo --label kind=robot
  await_joined head "r$n"
done

cat > "$scratch/patrol.yaml" << YAML
task: patrol
for_each: {node: {labels: {kind: robot}}}
pipeline:
  - {id: say, operation: echo, model: plain, parameters: {prefix: "\${node} "},
     input: "$scratch/data/\${node}.in", output: "$scratch/data/\${node}.out"}
YAML

apply() {
  "$ROSCELL" apply --to "$scratch/head/node.sock" "$scratch/patrol.yaml" \
    > "$scratch/applied" 2>&1 || fail "apply: $(cat "$scratch/applied")"
}

# Threads that rest have ended by then: with them goes the time that they ran.
settling_s=5

idle_ns() {
  local begin
  sleep "$settling_s"
  begin=$(cpu_ns head)
  sleep "$idle_s"
  echo $(($(cpu_ns head) - begin))
}

broken=0
without_ns=$(idle_ns)
begin=$(now_ms)
apply
start_ms=$(($(now_ms) - begin))
figure "a set of $robots tasks until all run" "$start_ms" ms
((start_ms <= most_start_ms)) || { echo "sets_bench: the start takes too long" >&2; broken=1; }
for ((n = 1; n <= robots; ++n)); do
  echo first >> "$scratch/data/r$n.in"
done
for ((n = 1; n <= robots; ++n)); do
  timeout "$deadline_s" grep -m 1 -x "r$n first" > /dev/null \
    < <(exec tail --pid=$$ -n +1 -F "$scratch/data/r$n.out" 2> /dev/null) \
    || fail "nothing comes out on r$n"
done
begin=$(now_ms)
apply
figure "apply of a set that does not differ" $(($(now_ms) - begin)) ms
figure "idle coordinator without the set" "$((without_ns / idle_s / 1000))" us/s
figure "idle coordinator with it" "$(($(idle_ns) / idle_s / 1000))" us/s
exit "$broken"
