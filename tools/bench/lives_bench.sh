#!/usr/bin/env bash
# How long it takes until what has gone wrong is well again; hosts are network
# namespaces on one bridge. One JSON line a figure. Needs root.
#
# Instances, in a cell of three hosts: from a crash to the next start of the program and
# to its being ready, without a pause (medians); a drain of eight instances; from the
# death of a node to the start of its step elsewhere, and what of that is the wait (24 s)
# and what the fence keeps.
#
# A morning: one host has the coordinator, each other one has a camera whose pictures the
# next one reads, two a second. In the evening all are shut down as systemd does it; in
# the morning they are switched on in a random order, each up to a second after the one
# before. From the last one being switched on to a picture at each reader; on standard
# error what the coordinator publishes of it.
#
# Usage: tools/bench/lives_bench.sh BUILD_DIR [ROUNDS=15 [HOSTS=12 [SEED]]]
#   ROUNDS  crashes
#   HOSTS   3 to 60; 0 leaves the morning out
#   SEED    of the order in which they are switched on
set -uo pipefail
cd "$(dirname "$0")/../.."
build=${1:?usage: tools/bench/lives_bench.sh BUILD_DIR [ROUNDS [HOSTS [SEED]]]}
rounds=${2:-15} count=${3:-12} seed=${4:-$$}
[[ $count =~ ^(0|[3-9]|[1-5][0-9]|60)$ ]] || { echo "HOSTS is 0, or 3 to 60" >&2; exit 2; }

boot_s() {
  python3 -c 'import time; print(time.clock_gettime(time.CLOCK_BOOTTIME))'
}

# ms_between FROM TO: of two times in seconds.
ms_between() {
  jq -n "($2 - $1) * 1000 | round"
}

# crash_once: kills the program; prints milliseconds to its next start and, from when
# its node knows, to the moment that it has taken it for ready. Events that repeat
# themselves come only to who follows them already, as the first line shows.
crash_once() {
  local number seen begin killed_ms events reader line state at_ms crashed_ms
  number=$(awk '$2 == "crashing" { p = $4 } END { print p }' "$scratch/orders/starts")
  seen=$(to arm2 events --since 0 --no-follow -o json | tail -1 | jq .sequence)
  exec {events}< <(exec "$ROSCELL" events --to "$scratch/arm2/node.sock" \
    --since $((seen - 1)) -o json)
  reader=$!
  read -r -t "$deadline_s" line <&"$events" || fail "no event of arm2"
  begin=$(boot_s) killed_ms=$(now_ms)
  kill -KILL "$number"
  while read -r -t "$deadline_s" line <&"$events"; do
    read -r state at_ms < <(jq -r '"\(.data.state) \(.time_unix_ms)"' <<< "$line")
    [[ $at_ms -lt $killed_ms || $state != backing_off ]] || crashed_ms=$at_ms
    [[ $at_ms -lt $killed_ms || $state != running ]] || break
  done
  kill "$reader"
  exec {events}<&-
  echo "$(ms_between "$begin" "$(last_start crashing)")" \
    "$((at_ms - crashed_ms))"
}

measure_crashes() {
  local round
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
}

measure_drain() {
  local i begin eight=()
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
}

measure_node_loss() {
  local begin
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
}

repair_instances() {
  local i
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
  measure_crashes
  measure_drain
  measure_node_loss
}

# await_picture NAME: until one comes that none has counted yet; prints the time.
await_picture() {
  local before
  before=$(< "$scratch/data/$1.before")
  timeout 120 grep -m $((before + 1)) frame_id > "$scratch/data/$1.matches" \
    < <(exec tail --pid=$$ -n +1 -F "$scratch/data/$1" 2> /dev/null) \
    || echo "stream $1: no picture in 120 s" >&2
  now_ms
}

# start_site: each host with a stream to the next one, as in a cell of the system tests
# (test/system/scenes/days_scene.sh), whose first host has the name head.
start_site() {
  local i
  names=(head) streams=()
  for ((i = 2; i <= count; ++i)); do
    names+=("host$i")
    number_of[host$i]=$i
    streams+=("stream$i")
    camera_on[stream$i]=host$i
    reader_on[stream$i]=host$((i < count ? i + 1 : 2))
  done
  take_day_skills
  for i in "${names[@]}"; do start_host "$i"; done
  for i in "${streams[@]}"; do start_stream "$i"; done
}

# switch_on: in the order that the seed gives; sets the moment of the last one.
switch_on() {
  local pause name
  while read -r _ pause name; do
    sleep "$pause"
    echo "$name is switched on" >&2
    last_on=$(now_ms)
    start_node_of "$name"
  done < <(printf '%s\n' "${names[@]}" | awk -v seed="$seed" 'BEGIN {srand(seed)}
    {printf "%.6f %.3f %s\n", rand(), rand(), $0}' | sort -n)
}

live_through_a_morning() {
  local name ends=() skills=$scratch/skills
  . test/system/scenes/days_scene.sh
  bridge_hosts "$count"
  make_site_token
  discovery_port=11811 http_port=8420
  start_site
  for name in "${names[@]}"; do
    shut_down "$name" &
    ends+=($!)
  done
  wait "${ends[@]}"
  for name in "${streams[@]}"; do
    grep -c frame_id "$scratch/data/$name" > "$scratch/data/$name.before"
  done
  switch_on
  ends=()
  for name in "${streams[@]}"; do
    await_picture "$name" > "$scratch/data/$name.came" &
    ends+=($!)
  done
  wait "${ends[@]}"
  sort -n "$scratch"/data/*.came > "$scratch/came"
  figure "morning of $count hosts: median reader has a picture" \
    "$(($(median < "$scratch/came") - last_on))" ms
  figure "morning of $count hosts: last reader has a picture" \
    "$(($(tail -n 1 "$scratch/came") - last_on))" ms
  to head events --since 0 --no-follow >&2
}

(. tools/bench/on_nodes.sh "$build" && repair_instances) || exit
[[ $count == 0 ]] || (. tools/bench/on_nodes.sh "$build" && live_through_a_morning)
