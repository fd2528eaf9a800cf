#!/usr/bin/env bash
# What the life of instances takes in a cell of three hosts (network namespaces
# on one bridge): from a crash to the next start of the program and to its being
# ready, without a pause; from the death of a node to the start of its step
# elsewhere, and what of that is the wait (24 s) and what the fence keeps; a drain
# of eight instances. Medians, one JSON line a figure. Needs root.
# Usage: tools/bench/lives_bench.sh BUILD_DIR [ROUNDS=15]
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${1:?usage: tools/bench/lives_bench.sh BUILD_DIR [ROUNDS]}"
rounds=${2:-15}
. tools/bench/on_nodes.sh
. test/system/scenes/worker.sh
make_worker
forget_safety
bridge_hosts 3
make_site_token
start_on 1 head --coordinator --cell line --label place=head
for i in 2 3; do
  start_on "$i" "arm$i" --join "$(discovery_of head)" --label "place=arm$i" \
    --label movable=yes
  await_joined head "arm$i"
done

boot_s() {
  python3 -c 'import time; print(time.clock_gettime(time.CLOCK_BOOTTIME))'
}

# ms_between FROM TO: of two times in seconds.
ms_between() {
  jq -n "($2 - $1) * 1000 | round"
}

# crash_once: kills the program; prints milliseconds to its next start and to the
# moment that its node has taken it for ready.
crash_once() {
  local number begin seen
  number=$(awk '$2 == "crashing" { p = $4 } END { print p }' "$scratch/orders/starts")
  seen=$(to arm2 events --since 0 --no-follow -o json | tail -1 | jq .sequence)
  begin=$(boot_s)
  kill -KILL "$number"
  await arm2 '.event == "instance_changed" and .data.state == "running"' "$seen" \
    > "$scratch/running.json"
  echo "$(ms_between "$begin" "$(last_start crashing)")" \
    "$(($(jq .time_unix_ms "$scratch/running.json") - $(crashed_ms "$seen")))"
}

# crashed_ms SINCE: when the node was told of the crash, by its own clock.
crashed_ms() {
  to arm2 events --since "$1" --no-follow -o json \
    | jq -s 'map(select(.data.state == "backing_off"))[0].time_unix_ms'
}

work_task crashes '{"id": "crashing", "labels": {"place": "arm2"},
  "restart": {"delay_s": 0, "max_delay_s": 0}}' | to head request > /dev/null
for ((round = 1; round <= rounds; ++round)); do
  crash_once
done > "$scratch/crashes"
figure "crash: program started again" \
  "$(cut -d' ' -f1 "$scratch/crashes" | median)" ms
figure "crash: running again, from when the node knows" \
  "$(cut -d' ' -f2 "$scratch/crashes" | median)" ms
to head stop crashes > /dev/null

eight=()
for i in 1 2 3 4 5 6 7 8; do
  eight+=("{\"id\": \"drained$i\", \"labels\": {\"movable\": \"yes\"}}")
done
to head drain arm3 2> /dev/null
work_task drains "${eight[@]}" | to head request > /dev/null
to head undrain arm3 2> /dev/null
begin=$(now_ms)
to head drain arm2 --until-empty 2> /dev/null
figure "drain of eight: node empty" "$(($(now_ms) - begin))" ms
to head stop drains > /dev/null
to head undrain arm2 2> /dev/null
to head drain arm3 2> /dev/null
work_task lost '{"id": "lost", "labels": {"movable": "yes"},
  "on_node_loss": {"policy": "move", "after_s": 24}}' | to head request > /dev/null
to head undrain arm3 2> /dev/null
watch_end lost
begin=$(boot_s)
kill -KILL "${pid[arm2]}"
await head '.event == "instance_moved" and .data.task == "lost"' > /dev/null
figure "node killed: its instance has ended" \
  "$(ms_between "$begin" "$(cat "$scratch/end.lost")")" ms
figure "node killed: its step starts elsewhere" \
  "$(ms_between "$begin" "$(last_start lost)")" ms
figure "of that, the margin behind the fence" \
  "$(ms_between "$(cat "$scratch/end.lost")" "$(last_start lost)")" ms
