#!/usr/bin/env bash
# Measures the three deployment strategies of docs/examples/strategies on a
# coordinator and four hosts: the time of a frame in each scene, with and without
# its waiting, the rate that is kept up, and the time from a request until all of it runs.
# Each host has its own, equal share of this machine's CPU, so that strategy 3
# has four times what the others have, as it would on machines of its own. The
# strategies take turns, so that all meet the same state of the machine. One
# JSON line a figure; box_plots.py draws them. Needs root, for control groups.
# Usage: tools/bench/strategies_bench.sh BUILD_DIR [SECONDS [ROUNDS [RATE_HZ [CORES]]]]
#   SECONDS  that a turn of a strategy is measured (12)
#   ROUNDS   how often it has its turn (5)
#   RATE_HZ  pictures per second of a camera (as the files say)
#   CORES    of each host; by default a sixth of this machine's
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${1:?usage: tools/bench/strategies_bench.sh BUILD_DIR [SECONDS [ROUNDS [RATE_HZ [CORES]]]]}"
span_s=${2:-12}
rounds=${3:-5}
rate_hz=${4:-null}
cores=${5:-$(awk -v n="$(nproc)" 'BEGIN {print n / 6}')}
. tools/bench/on_nodes.sh
trap 'exec 2> /dev/null; clean_up; remove_shares; rm -rf "$scratch"' EXIT
use_skills image_source pose_estimation

# make_share NAME CORES: a control group that may use so many cores (0.4).
# Prints its folder; nothing where this machine's cgroups cannot be written.
make_share() {
  local root=/sys/fs/cgroup folder period_us=100000
  local quota_us
  quota_us=$(awk -v cores="$2" -v period="$period_us" \
    'BEGIN {print int(cores * period)}')
  if [[ -w $root/cgroup.subtree_control ]]; then
    echo +cpu > "$root/cgroup.subtree_control" 2> /dev/null
    folder=$root/roscell-bench-$$-$1
    mkdir "$folder" && echo "$quota_us $period_us" > "$folder/cpu.max"
  elif [[ -w $root/cpu ]]; then
    folder=$root/cpu/roscell-bench-$$-$1
    mkdir "$folder" && echo "$period_us" > "$folder/cpu.cfs_period_us" \
      && echo "$quota_us" > "$folder/cpu.cfs_quota_us"
  else
    return 1
  fi 2> /dev/null && echo "$folder"
}

# The command prefix that begins a program in a share.
in_share() {
  inside=(sh -c 'echo $$ > "$0/cgroup.procs" && exec "$@"' "$1")
}

# The groups that are empty again.
remove_shares() {
  rmdir /sys/fs/cgroup/roscell-bench-$$-* /sys/fs/cgroup/cpu/roscell-bench-$$-* \
    2> /dev/null
}

# start_host NAME
start_host() {
  local name=$1 share
  share=$(make_share "$name" "$cores") \
    || fail "no control group for the CPU can be made here; are you root?"
  in_share "$share"
  start_node "$name" --interface lo --join "$server" --label "host=$name"
  inside=()
  await_joined head "$name"
}

# The request file with folders of this run in place of its own.
request_of() {
  jq --arg scratch "$scratch" --argjson rate_hz "$rate_hz" '
    (.. | .endpoint? // empty) |= sub("^/tmp/roscell-"; $scratch + "/")
    | (.pipeline[].parameters | select(has("rate_hz")).rate_hz)
      |= ($rate_hz // .)' "docs/examples/strategies/$1.json"
}

# await_frame FILE: waits until the estimator has written about a frame.
await_frame() {
  [[ -n $(timeout "$deadline_s" tail -n +1 -F "$1" 2> /dev/null | head -n 1) ]] \
    || fail "no frame in $1"
}

# run_strategy STRATEGY: one turn. What is measured begins when each scene has
# given a frame; it goes to $scratch/STRATEGY.jsonl and $scratch/STRATEGY.SCENE.
run_strategy() {
  local strategy=$1 poses=$scratch/poses/$1 scene begin accepted
  local -A first
  rm -rf "$poses"
  mkdir -p "$poses"
  request_of "$strategy" > "$scratch/task.json"
  begin=$(now_ms)
  accepted=$(to head request "$scratch/task.json") \
    || fail "$strategy was refused: $accepted"
  jq -c --argjson ms $(($(now_ms) - begin)) '
    {$ms, instances: (.instances | length),
     nodes: ([.allocations[].node] | unique | length)}' <<< "$accepted" \
    >> "$scratch/$strategy.jsonl"
  for scene in "${scenes[@]}"; do
    await_frame "$poses/$scene.jsonl"
  done
  for scene in "${scenes[@]}"; do
    first[$scene]=$(($(wc -l < "$poses/$scene.jsonl") + 1))
  done
  timeout "$span_s" tail -f /dev/null
  get head /v1/instances | jq -c '[.instances[]
      | select(.spec.step | startswith("pose")) | .figures.dropped // 0] | add' \
    >> "$scratch/$strategy.dropped"
  echo "{\"type\":\"task_termination\",\"task\":\"$strategy\"}" \
    | to head request > /dev/null || fail "$strategy was not terminated"
  for scene in "${scenes[@]}"; do
    tail -n "+${first[$scene]}" "$poses/$scene.jsonl" \
      | jq -c '{ms: .age_ms, work_ms: .processing_ms, tags: (.tags | length)}' \
        >> "$scratch/$strategy.$scene"
  done
}

# A share $q of all values is not above the quantile (nearest rank).
quantile='def quantile($q): sort | .[($q * length | ceil) - 1];'

tell_start() {
  jq -sc --arg strategy "$1" "$quantile"'
    {bench: "strategies", $strategy, instances: .[0].instances,
     nodes: .[0].nodes, request_to_running_ms: (map(.ms) | quantile(0.5)),
     each_ms: map(.ms), cores_of_a_host: ($cores | tonumber),
     dropped: $dropped}' \
    --arg cores "$cores" \
    --argjson dropped "$(jq -sc . "$scratch/$1.dropped")" "$scratch/$1.jsonl"
}

tell_frames() {
  jq -sc --arg strategy "$1" --arg scene "$2" \
    --argjson seconds $((span_s * rounds)) "$quantile"'
    map(.ms) as $ms
    | {bench: "strategies", $strategy, $scene, tags: (map(.tags) | max),
       frames: length, frames_per_s: (length / $seconds),
       p5_ms: ($ms | quantile(0.05)), p25_ms: ($ms | quantile(0.25)),
       median_ms: ($ms | quantile(0.5)), p75_ms: ($ms | quantile(0.75)),
       p95_ms: ($ms | quantile(0.95)), p99_ms: ($ms | quantile(0.99)),
       work_median_ms: (map(.work_ms) | quantile(0.5))}' "$scratch/$1.$2"
}

strategies=(strategy_{1,2,3})
scenes=(scene_{1,2,3,4})
"$ROSCELL_BUILD/bin/render_scenes" "$scratch/scenes" > /dev/null \
  || fail "no scenes: build render_scenes first"
start_node head --interface lo --coordinator --cell line
server=$(discovery_of head)
for name in one two three four; do
  start_host "$name"
done
for ((round = 0; round < rounds; ++round)); do
  for strategy in "${strategies[@]}"; do
    run_strategy "$strategy"
  done
done
for strategy in "${strategies[@]}"; do
  tell_start "$strategy"
  for scene in "${scenes[@]}"; do
    tell_frames "$strategy" "$scene"
  done
done
