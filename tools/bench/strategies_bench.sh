#!/usr/bin/env bash
# Measures the three deployment strategies of docs/examples on a coordinator and
# four hosts: the time of a frame in each scene, and from a request until all of
# it runs. One JSON line a figure.
# Usage: tools/bench/strategies_bench.sh BUILD_DIR [SECONDS [RATE_HZ]]
#   SECONDS  that each strategy is measured (60)
#   RATE_HZ  pictures per second of a camera (as the files say)
set -uo pipefail
cd "$(dirname "$0")/../.."
export ROSCELL_BUILD
ROSCELL_BUILD=$(realpath "${1:?usage: tools/bench/strategies_bench.sh BUILD_DIR [SECONDS [RATE_HZ]]}")
span_s=${2:-60}
rate_hz=${3:-null}
scratch=$(mktemp -d /tmp/roscell-bench.XXXXXX)
. test/system/lib.sh
trap 'clean_up 2> /dev/null; rm -rf "$scratch"' EXIT
use_skills
ask_no_cpu "$skills/image_source"
ask_no_cpu "$skills/pose_estimation"

now_ms() {
  date +%s%3N
}

# As machines of their own have, each host has cores of its own, if there are
# enough; else all share all.
cores_each=$(($(nproc) / 4))
# start_host NUMBER NAME: numbers count from 0.
start_host() {
  local name=$2 core=$(($1 * cores_each))
  ((cores_each == 0)) || inside=(taskset -c "$core-$((core + cores_each - 1))")
  start_node "$name" --interface lo --join "$server" --label "host=$name"
  inside=()
  await_joined head "$name"
}

# The request file with folders of this run in place of its own.
request_of() {
  jq --arg scratch "$scratch" --argjson rate_hz "$rate_hz" '
    (.. | .endpoint? // empty) |= sub("^/tmp/roscell-"; $scratch + "/")
    | (.pipeline[].parameters | select(has("rate_hz")).rate_hz)
      |= ($rate_hz // .)' "docs/examples/$1.json"
}

# await_frame FILE: waits until the estimator has written about a frame.
await_frame() {
  [[ -n $(timeout "$deadline_s" tail -n +1 -F "$1" 2> /dev/null | head -n 1) ]] \
    || fail "no frame in $1"
}

# frame_times STRATEGY SCENE FIRST_LINE: nearest-rank quantiles of the frames.
frame_times() {
  tail -n "+$3" "$scratch/poses/$1/$2.jsonl" \
    | jq -nc --arg strategy "$1" --arg scene "$2" --argjson span_s "$span_s" '
      [inputs | {ms: .processing_ms, tags: (.tags | length)}]
      | (map(.ms) | sort) as $ms
      | def quantile($q): $ms[($q * length | ceil) - 1];
      {bench: "strategies", $strategy, $scene, tags: (map(.tags) | max),
       frames: length, frames_per_s: (length / $span_s),
       median_ms: quantile(0.5), p95_ms: quantile(0.95),
       p99_ms: quantile(0.99)}'
}

run_strategy() {
  local strategy=$1 scene begin accepted
  local -A first
  mkdir -p "$scratch/poses/$strategy"
  request_of "$strategy" > "$scratch/$strategy.json"
  begin=$(now_ms)
  accepted=$(to head request "$scratch/$strategy.json") \
    || fail "$strategy was refused: $accepted"
  jq -c --arg strategy "$strategy" --argjson ms $(($(now_ms) - begin)) '
    {bench: "strategies", $strategy, instances: (.instances | length),
     nodes: ([.allocations[].node] | unique | length),
     request_to_running_ms: $ms}' <<< "$accepted"
  for scene in scene_{1,2,3,4}; do
    await_frame "$scratch/poses/$strategy/$scene.jsonl"
  done
  for scene in scene_{1,2,3,4}; do
    first[$scene]=$(($(wc -l < "$scratch/poses/$strategy/$scene.jsonl") + 1))
  done
  timeout "$span_s" tail -f /dev/null
  echo "{\"type\":\"task_termination\",\"task\":\"$strategy\"}" \
    | to head request > /dev/null || fail "$strategy was not terminated"
  for scene in scene_{1,2,3,4}; do
    frame_times "$strategy" "$scene" "${first[$scene]}"
  done
}

"$ROSCELL_BUILD/bin/render_scenes" "$scratch/scenes" > /dev/null \
  || fail "no scenes: build render_scenes first"
start_node head --interface lo --coordinator --cell line
server=$(discovery_of head)
start_host 0 one
start_host 1 two
start_host 2 three
start_host 3 four
for strategy in strategy_{1,2,3}; do
  run_strategy "$strategy"
done
