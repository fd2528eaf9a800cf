#!/usr/bin/env bash
# Measures what six idle hosts send and receive, for a ROSCell of a coordinator
# and five members and, at the same time on a bridge of its own, for a Docker
# Swarm of a manager and five workers; then, in the same configuration, how long
# it takes until the loss of a host is noticed. JSON lines. Needs root and dockerd.
# Usage: tools/bench/wire_bench.sh BUILD_DIR [SECONDS=600] [ROUNDS=3]
set -uo pipefail
cd "$(dirname "$0")/../.."
export ROSCELL_BUILD
ROSCELL_BUILD=$(realpath "${1:?usage: tools/bench/wire_bench.sh BUILD_DIR [SECONDS] [ROUNDS]}")
span_s=${2:-600}
rounds=${3:-3}
bench=$(mktemp -d /tmp/roscell-bench.XXXXXX)
. test/system/lib.sh
. tools/bench/metrics.sh

# counters N: bytes sent and received, packets sent and received, time in ms.
counters() {
  ip netns exec "${hosts[$1 - 1]}" sh -c 'cd /sys/class/net/eth0/statistics
    echo $(cat tx_bytes rx_bytes tx_packets rx_packets) $(date +%s%3N)'
}

# measure_wire SYSTEM: all hosts, once both systems are at rest.
measure_wire() {
  local n order before after
  echo "$1" > "$bench/ready"
  read -r order < "$bench/$1.go"
  [[ $order == go ]] || exit 1
  for n in 1 2 3 4 5 6; do before[n]=$(counters "$n"); done
  timeout "$span_s" tail -f /dev/null
  for n in 1 2 3 4 5 6; do after[n]=$(counters "$n"); done
  for n in 1 2 3 4 5 6; do
    jq -nc --arg system "$1" --argjson n "$n" --arg a "${before[n]}" \
      --arg b "${after[n]}" '
      def rate: . * 100 | round / 100;
      ([$a, $b] | map(split(" ") | map(tonumber)) | transpose
        | map(.[1] - .[0])) as [$tx, $rx, $ptx, $prx, $ms]
      | ($ms / 1000) as $s
      | {figure: "idle wire", system: $system, host: $n,
         sent_bytes_per_s: ($tx / $s | rate),
         received_bytes_per_s: ($rx / $s | rate),
         sent_packets_per_s: ($ptx / $s | rate),
         received_packets_per_s: ($prx / $s | rate), seconds: ($s | round)}'
  done
}

# noticed SYSTEM FAULT MS
noticed() {
  jq -nc --arg system "$1" --arg fault "$2" --argjson ms "$3" \
    '{figure: "noticed after", system: $system, fault: $fault, ms: $ms}'
}

# end_link N, mend_link N: pulls a host's cable out, and puts it in.
end_link() {
  ip link set "$(host_link "$1")" down
}

mend_link() {
  ip link set "$(host_link "$1")" up
}

# lose_node FAULT COMMAND...: what the command does to host 2, until the
# coordinator tells that it has lost the node. Each waits for an event after the
# one before.
since=0
lose_node() {
  local fault=$1 begin lost
  shift
  begin=$(now_ms)
  "$@"
  lost=$(await head '.event == "node_lost"' "$since") || exit 1
  since=$(jq .sequence <<< "$lost")
  noticed roscell "$fault" $(($(jq .time_unix_ms <<< "$lost") - begin))
}

await_return() {
  since=$(await head '.event == "node_joined" and .subject == "node2"' \
    "$since" | jq .sequence)
}

start_member() {
  start_on "$1" "node$1" --join "$server"
}

roscell_side() {
  local n
  scratch=$bench/roscell
  trap 'end_side clean_up' EXIT
  use_skills
  bridge_hosts 6
  make_site_token
  start_on 1 head --coordinator --cell line
  server=$(discovery_of head)
  for n in 2 3 4 5 6; do
    start_member "$n"
    await_joined head "node$n"
  done
  measure_wire roscell
  await_return
  for ((n = 0; n < rounds; ++n)); do
    lose_node SIGSTOP kill -STOP "${pid[node2]}"
    kill -CONT "${pid[node2]}"
    await_return
    lose_node "link down" end_link 2
    mend_link 2
    await_return
    lose_node SIGKILL kill -KILL "${pid[node2]}"
    start_member 2
    await_return
  done
}

# use_engine_of N: the dockerd of that host is meant from now on.
use_engine_of() {
  engine_dir=$scratch/engine$1
  engine_socket=$engine_dir.sock
  engine_inside=(nsenter --net="/run/netns/${hosts[$1 - 1]}")
}

engine_of() {
  local n=$1
  shift
  docker -H "unix://$scratch/engine$n.sock" "$@"
}

start_engine_of() {
  use_engine_of "$1"
  mkdir -p "$engine_dir"
  launch_engine || fail "dockerd of host $1: $(tail -n 1 "$engine_dir/log")"
}

stop_swarm() {
  local n stops=()
  for ((n = 1; n <= ${#hosts[@]}; ++n)); do
    (
      use_engine_of "$n"
      kill -CONT "$(cat "$engine_dir/pid")"
      stop_engine
    ) &
    stops+=($!)
  done
  wait "${stops[@]}"
  clean_up
}

# end_side CLEANING: what a side does at its end, however it comes to it.
end_side() {
  trap '' INT TERM
  echo ended > "$bench/ready"
  "$1" 2> /dev/null
}

# await_worker STATE: until the manager says that of the worker on host 2.
await_worker() {
  local line=
  until [[ $line == *"state.new=$1"* ]]; do
    read -r -t 180 line <&"$node_events" || fail "no swarm node became $1"
  done
  engine_of 1 node ls --format '{{.ID}} {{.Status}}' \
    | grep -qi "$worker $1" || fail "docker node ls does not say $1"
}

lose_worker() {
  local fault=$1 begin
  shift
  begin=$(now_ms)
  "$@"
  await_worker down
  noticed swarm "$fault" $(($(now_ms) - begin))
}

swarm_side() {
  local n token
  scratch=$bench/swarm
  engine_dir=$scratch/engine
  base_tar=
  . tools/own_engine.sh
  trap 'end_side stop_swarm' EXIT
  bridge_hosts 6
  for n in 1 2 3 4 5 6; do start_engine_of "$n"; done
  engine_of 1 swarm init --advertise-addr 10.231.7.1 > /dev/null \
    || fail "no swarm"
  token=$(engine_of 1 swarm join-token -q worker)
  for n in 2 3 4 5 6; do
    engine_of "$n" swarm join --token "$token" --advertise-addr "10.231.7.$n" \
      10.231.7.1:2377 > /dev/null || fail "worker $n does not join"
  done
  worker=$(engine_of 2 info --format '{{.Swarm.NodeID}}')
  measure_wire swarm
  exec {node_events}< <(exec docker -H "unix://$scratch/engine1.sock" events \
    --filter type=node --filter "node=$worker")
  for ((n = 0; n < rounds; ++n)); do
    use_engine_of 2
    lose_worker SIGSTOP kill -STOP "$(cat "$engine_dir/pid")"
    kill -CONT "$(cat "$engine_dir/pid")"
    await_worker ready
    lose_worker "link down" end_link 2
    mend_link 2
    await_worker ready
    lose_worker SIGKILL kill -KILL "$(cat "$engine_dir/pid")"
    stop_engine
    start_engine_of 2
    await_worker ready
  done
}

# Each side is a subshell that cleans up after itself, also when it is ended.
trap 'wait; rm -rf "$bench"' EXIT
trap 'kill "${sides[@]}" 2> /dev/null; exit 130' INT TERM
mkfifo "$bench/ready"
exec {ready}<> "$bench/ready"
declare -A sides
for side in roscell swarm; do
  mkdir "$bench/$side"
  mkfifo "$bench/$side.go"
  "${side}_side" 2> "$bench/$side.errors" &
  sides[$side]=$!
done
order=go
for side in roscell swarm; do
  read -r -t 180 said <&"$ready"
  [[ $said != ended ]] || order=stop
done
# What is measured begins once both are at rest.
[[ $order == stop ]] || timeout 30 tail -f /dev/null
for side in roscell swarm; do
  echo "$order" 1<> "$bench/$side.go"
done
failed=0
for side in roscell swarm; do
  wait "${sides[$side]}" || { cat "$bench/$side.errors" >&2; failed=1; }
done
exit "$failed"
