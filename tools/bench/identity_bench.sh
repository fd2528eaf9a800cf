#!/usr/bin/env bash
# What identities cost beside the token, in one run: a member's join, a request by TCP, a
# task from request to running, and the wire of an idle member. Two cells of two hosts
# each, one with a token and one with identities; the rounds of both take turns. One JSON
# line a figure; ends with 1 if a bound is broken. Needs root, for the hosts.
# Usage: tools/bench/identity_bench.sh BUILD_DIR [ROUNDS]
set -uo pipefail
cd "$(dirname "$0")/../.."
. tools/bench/on_nodes.sh "${1:?usage: tools/bench/identity_bench.sh BUILD_DIR [ROUNDS]}"
. test/system/scenes/identities.sh
[[ $(id -u) -eq 0 ]] || skip "hosts take root"
rounds=${2:-11}
idle_s=240
most_join_ms=200
most_task_ms=10
most_wire_bytes_s=3

use_skills
make_site hall
make_site_token
issue coordinator head
issue coordinator crowd
issue node arm
issue operator anna
bridge_hosts 4

# on_host N NAME [OPTION...]
on_host() {
  local number=$1 name=$2
  shift 2
  inside=(ip netns exec "${hosts[$((number - 1))]}")
  start_node "$name" --interface "10.231.7.$number" --label "place=$name" "$@"
  inside=()
}

start_member() {
  if [[ $1 == arm ]]; then
    on_host 4 arm --join "$(discovery_of head)" --identity "$scratch/arm.pem"
  else
    on_host 2 guest --join "$(discovery_of plain)" --site-token "$scratch/site.token"
  fi
}

declare -A leads=([guest]=plain [arm]=head)
on_host 1 plain --coordinator --cell plain --site-token "$scratch/site.token"
on_host 3 head --coordinator --cell line --identity "$scratch/head.pem"

# join_ms MEMBER: from its start to its row in the cell.
join_ms() {
  local began since
  since=$("$ROSCELL" events --to "$scratch/${leads[$1]}/node.sock" --no-follow -o json \
    2> /dev/null | tail -n 1 | jq .sequence)
  began=$(now_ms)
  start_member "$1"
  await "${leads[$1]}" ".event == \"node_joined\" and .subject == \"$1\"" "${since:-0}" \
    | jq "(.time_unix_ms - $began)"
}

# ask_ms MEMBER: a request by TCP to its coordinator, from its host.
ask_ms() {
  local began to=10.231.7.1 how=(--token-file "$scratch/plain/token") host=1
  [[ $1 == guest ]] \
    || { to=10.231.7.3 how=(--identity "$scratch/anna.pem") host=3; }
  to=$(tcp_of "${leads[$1]}")
  began=$(date +%s%N)
  ip netns exec "${hosts[$host]}" "$ROSCELL" cells --to "$to" "${how[@]}" > /dev/null \
    || fail "no answer by TCP"
  echo $((($(date +%s%N) - began) / 1000)) | awk '{print $1 / 1000}'
}

# task_ms MEMBER N: until its step runs.
task_ms() {
  local began head=${leads[$1]}
  echo_task "pick-$2" "$1" > "$scratch/task.json"
  began=$(date +%s%N)
  to "$head" run "$scratch/task.json" > /dev/null 2>&1 || fail "no task"
  echo $((($(date +%s%N) - began) / 1000)) | awk '{print $1 / 1000}'
  to "$head" stop "pick-$2" > /dev/null 2>&1
}

for ((i = 1; i <= rounds; i++)); do
  for name in guest arm; do
    join_ms "$name" >> "$scratch/$name.join"
    ask_ms "$name" >> "$scratch/$name.ask"
    task_ms "$name" "$i" >> "$scratch/$name.task"
    ((i == rounds)) || stop_node "$name"
  done
done

# As many as a cell has members, at a coordinator of one host: what else a member says
# when it comes back is not among it.
members=250
most_storm_ms=15000
start_node crowd --coordinator --cell crowd --interface lo \
  --identity "$scratch/crowd.pem"
read -r storm_ms unanswered again < <(python3 tools/bench/identities_at_once.py \
  "$(tcp_of crowd | cut -d: -f2)" "$members" "$scratch/anna.pem")
stop_node crowd

# wire_bytes HOST: what its cable has carried.
wire_bytes() {
  ip netns exec "${hosts[$(($1 - 1))]}" cat /proc/net/dev \
    | awk '$1 == "eth0:" {print $2 + $10}'
}
sleep 15
before=("$(wire_bytes 2)" "$(wire_bytes 4)")
sleep "$idle_s"
wire_guest=$((($(wire_bytes 2) - before[0]) / idle_s))
wire_arm=$((($(wire_bytes 4) - before[1]) / idle_s))

broken=0
# compare FIGURE FILE UNIT [MOST]
compare() {
  local by_token by_identity more
  by_token=$(median < "$scratch/guest.$2")
  by_identity=$(median < "$scratch/arm.$2")
  more=$(echo "$by_identity $by_token" | awk '{print $1 - $2}')
  figure "$1, by token" "$by_token" "$3"
  figure "$1, by identity" "$by_identity" "$3"
  awk -v more="$more" -v most="${4:-$more}" 'BEGIN {exit more > most}' \
    || { echo "identity_bench: $1: $more $3 more" >&2; broken=1; }
}
compare "join of a node, from its start" join ms "$most_join_ms"
compare "request by TCP, with its program" ask ms
compare "task, from request to running" task ms "$most_task_ms"
figure "$members who prove themselves at once, until all are answered" "$storm_ms" ms
figure "how often one of them had to come again" "$again" ""
((storm_ms <= most_storm_ms && unanswered == 0)) \
  || { echo "identity_bench: $unanswered of $members unanswered" >&2; broken=1; }
figure "wire of an idle member, by token" "$wire_guest" B/s
figure "wire of an idle member, by identity" "$wire_arm" B/s
((wire_arm - wire_guest <= most_wire_bytes_s)) \
  || { echo "identity_bench: the wire of an idle member" >&2; broken=1; }
exit "$broken"
