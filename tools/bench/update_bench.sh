#!/usr/bin/env bash
# What a change of a running task costs: of eight steps of echo one is changed, again
# and again. The gap in its output is that of ending and starting it, and what the
# coordinator takes in between; and what a parameter costs that changes while its step
# runs. One JSON line a figure; ends with 1 if a bound is
# broken. Usage: tools/bench/update_bench.sh BUILD_DIR [CHANGES]
set -uo pipefail
cd "$(dirname "$0")/../.."
. tools/bench/on_nodes.sh "${1:?usage: tools/bench/update_bench.sh BUILD_DIR [CHANGES]}"
changes=${2:-9}
most_between_ms=20
most_apply_ms=50
use_skills
start_node head --coordinator --cell line --interface lo

# eight VERSION: of which the fourth step has that version.
eight() {
  jq -n --arg dir "$scratch/data" --arg version "$1" '
    {task: "eight", update: {healthy_for_s: 0}, pipeline: [range(8)
      | {id: "s\(.)", operation: "echo", model: "plain",
         parameters: {prefix: (if . == 4 then $version else "0" end)},
         input: {protocol: "file", endpoint: "\($dir)/in", data_type: "text/plain"},
         output: {protocol: "file", endpoint: "\($dir)/\(.)", data_type: "text/plain"}}]}'
}

apply() {
  "$ROSCELL" apply --to "$scratch/head/node.sock" "$@" "$scratch/eight.json" \
    > "$scratch/applied" 2>&1 || fail "apply: $(cat "$scratch/applied")"
}

instances() {
  get head /v1/instances | jq -r '.instances[] | "\(.spec.step) \(.spec.instance)"' | sort
}

# at INSTANCE STATE: when it was first told to be so, in ms.
at() {
  jq -rn --arg x "$1" --arg state "$2" 'first(inputs
    | select(.subject == $x and .data.state == $state) | .time_unix_ms)' "$scratch/events.json"
}

mkdir -p "$scratch/data"
touch "$scratch/data/in"
eight 0 > "$scratch/eight.json"
apply
: > "$scratch/between" > "$scratch/gaps"
broken=0
for ((n = 1; n <= changes; ++n)); do
  instances > "$scratch/before"
  eight "$n" > "$scratch/eight.json"
  apply
  instances > "$scratch/after"
  [[ $(comm -12 "$scratch/before" "$scratch/after" | wc -l) -eq 7 ]] \
    || { echo "update_bench: not seven steps have stayed" >&2; broken=1; }
  old=$(comm -23 "$scratch/before" "$scratch/after" | cut -d' ' -f2)
  fresh=$(comm -13 "$scratch/before" "$scratch/after" | cut -d' ' -f2)
  "$ROSCELL" events --to "$scratch/head/node.sock" --since 0 --no-follow -o json \
    > "$scratch/events.json"
  echo $(($(at "$fresh" starting) - $(at "$old" stopped))) >> "$scratch/between"
  echo $(($(at "$fresh" running) - $(at "$old" stopping))) >> "$scratch/gaps"
done
between_ms=$(median < "$scratch/between")
figure "gap in the output of the changed step" "$(median < "$scratch/gaps")" ms
figure "of that neither ending nor starting it" "$between_ms" ms
((between_ms <= most_between_ms)) \
  || { echo "update_bench: too long between end and start" >&2; broken=1; }

written=$(stat -c %Y%s "$scratch"/head/*.db* 2> /dev/null | md5sum)
apply_ms=$(for ((n = 0; n < 9; ++n)); do
  begin=$(now_ms)
  apply
  echo $(($(now_ms) - begin))
done | median)
figure "apply of what does not differ" "$apply_ms" ms
((apply_ms <= most_apply_ms)) \
  || { echo "update_bench: apply takes too long" >&2; broken=1; }
[[ $(stat -c %Y%s "$scratch"/head/*.db* 2> /dev/null | md5sum) == "$written" ]] \
  || { echo "update_bench: apply of what does not differ has written" >&2; broken=1; }

set_ms=$(for ((n = 0; n < 9; ++n)); do
  begin=$(now_ms)
  "$ROSCELL" set --to "$scratch/head/node.sock" eight/s0 "prefix=$n" > "$scratch/set" \
    2>&1 || fail "set: $(cat "$scratch/set")"
  echo $(($(now_ms) - begin))
done | median)
figure "set of a parameter of a running step" "$set_ms" ms
exit "$broken"
