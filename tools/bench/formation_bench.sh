#!/usr/bin/env bash
# Measures how cells form: the sizes after 64 processes have started at one
# moment over 4 coordinators, and how long joins, a formation of 20 by name and
# transfers take between hosts (network namespaces on one bridge). One JSON line
# a figure. Needs root.
# Usage: tools/bench/formation_bench.sh BUILD_DIR [BATCHES=10] [TRANSFERS=100]
set -uo pipefail
cd "$(dirname "$0")/../.."
export ROSCELL_BUILD
ROSCELL_BUILD=$(realpath "${1:?usage: tools/bench/formation_bench.sh BUILD_DIR [BATCHES] [TRANSFERS]}")
batches=${2:-10}
transfers=${3:-100}

. tools/bench/metrics.sh

# in_scratch FUNCTION...: runs it with processes and files of its own.
in_scratch() {
  (
    scratch=$(mktemp -d /tmp/roscell-bench.XXXXXX)
    . test/system/lib.sh
    . test/system/formation_test.sh
    trap 'clean_up 2> /dev/null; rm -rf "$scratch"' EXIT
    use_skills
    "$@"
  ) 2> >(grep -v Killed >&2) # What the shell says of nodes that have been ended.
}

# One coordinator of the four dies in the middle of every third batch, and in
# every other third they start after the nodes.
batch() {
  local begin cells=(alpha beta gamma delta) kind=$1
  begin=$(now_ms)
  if [[ $kind == late ]]; then
    start_batch 64
    start_cells "${cells[@]}"
  else
    start_cells "${cells[@]}"
    begin=$(now_ms)
    start_batch 64
  fi
  if [[ $kind == death ]]; then
    await beta '.event == "node_joined"' > /dev/null
    stop_node beta KILL
    cells=(alpha gamma delta)
    await_settled "${cells[@]}"
  else
    await_even 68 "${cells[@]}"
  fi
  figure "batch of 64 over 4, $kind: sizes" \
    "$(for cell in "${cells[@]}"; do active_rows "$cell"; done | jq -sc .)" nodes
  figure "batch of 64 over 4, $kind: all in" $(($(now_ms) - begin)) ms
}

# await_settled CELL...: until every node that is not an orphan of the dead cell
# has joined one of these, evenly.
await_settled() {
  local end=$((SECONDS + deadline_s)) orphans sizes
  watch_cells "$@"
  while read -r -t $((end - SECONDS)) _ <&"$changes"; do
    orphans=$(get "$1" /v1/cell \
      | jq '[.free[]? | select(.state == "orphaned")] | length')
    sizes=$(for cell in "$@"; do active_rows "$cell"; done)
    [[ $(awk '{s += $1} END {print s}' <<< "$sizes") -eq $((67 - orphans)) ]] \
      || continue
    [[ $(sort -n <<< "$sizes" | sed -n '1h;${G;s/\n/ /p}' \
      | awk '{print $1 - $2}') -le 1 ]] && return
  done
  fail "orphans $orphans, sizes" $sizes
}

hosts_bench() {
  local begin i times=() names=()
  bridge_hosts 22
  make_site_token
  start_on 1 alpha --coordinator --cell alpha
  start_on 2 beta --coordinator --cell beta
  await alpha '.event == "peer_joined"' > /dev/null
  for ((i = 3; i <= 22; ++i)); do
    start_on $i "n$i" --wait
    names+=("n$i")
  done
  for ((i = 3; i <= 22; ++i)); do
    await alpha ".event == \"node_appeared\" and .subject == \"n$i\"" > /dev/null
  done
  begin=$(now_ms)
  form alpha "${names[@]}" > "$scratch/formed.json"
  figure "formation of 20 by name" \
    $(($(now_ms) - begin)) ms
  figure "formation of 20 by name: joined" \
    "$(jq '[.outcomes[] | select(.result == "joined")] | length' \
      "$scratch/formed.json")" nodes
  for name in "${names[@]}"; do
    release alpha "$name" > /dev/null
  done
  begin=$(now_ms)
  form alpha "${names[@]}" > "$scratch/formed.json"
  figure "formation of 20 by name, again" $(($(now_ms) - begin)) ms
  for ((i = 0; i < transfers; ++i)); do
    local from=alpha to=beta
    ((i % 2)) && from=beta to=alpha
    begin=$(now_ms)
    transfer $from n3 $to > "$scratch/transfer.json"
    times+=($(($(now_ms) - begin)))
    [[ $(jq -r .to "$scratch/transfer.json") == "$to" ]] \
      || fail "transfer $i: $(cat "$scratch/transfer.json")"
  done
  figure "transfer, client included: median of $transfers" \
    "$(printf '%s\n' "${times[@]}" | sort -n | sed -n "$((transfers / 2))p")" ms
  figure "transfer, client included: worst of $transfers" \
    "$(printf '%s\n' "${times[@]}" | sort -n | tail -1)" ms
  moved=$(timeout 5 "$ROSCELL" events --to "$scratch/n3/node.sock" --since 0 \
    -o json | jq -s '
      [.[] | select(.event == "switch_accepted" or .event == "cell_joined")]
      | [range(1; length) as $i
         | select(.[$i].event == "cell_joined"
                  and .[$i - 1].event == "switch_accepted")
         | .[$i].time_unix_ms - .[$i - 1].time_unix_ms] | sort')
  figure "switch accepted to joined, on the node: median" \
    "$(jq '.[length / 2 | floor]' <<< "$moved")" ms
  figure "switch accepted to joined, on the node: worst" \
    "$(jq '.[-1]' <<< "$moved")" ms
}

for ((run = 0; run < batches; ++run)); do
  kinds=(together late death)
  in_scratch batch "${kinds[run % 3]}"
done
in_scratch hosts_bench
