# Interfaces that trouble a node: another host with its address, one that flaps, a
# second one beside it.

. test/system/scenes/days_scene.sh

slow=(test_data_flow_after_an_interface_has_flapped)

# renewals_of NAME: how often its node was made anew.
renewals_of() {
  grep -c "is made anew" "$scratch/$1.log"
}

# what_it_holds NAME: threads and descriptors of its node.
what_it_holds() {
  local at=/proc/${pid[$1]}
  echo "$(ls "$at/task" | wc -l) threads, $(ls "$at/fd" | wc -l) descriptors"
}

# host_appears: a fourth host with the address of the third, whose packets all others
# hear, so that theirs to that address go there.
host_appears() {
  local host=${hosts[3]} n
  ip -n "$host" addr flush dev eth0
  ip -n "$host" addr add 10.231.7.3/24 dev eth0
  for n in 1 2; do
    ip netns exec "$host" bash -c "echo > /dev/udp/10.231.7.$n/9"
  done
}

# host_goes SECONDS: and nobody tells the others whose the address is now, but the
# third, once it has noticed that it is alone. Within so long pictures come.
host_goes() {
  local took
  ip link set "$(host_link 4)" down
  possible=$EPOCHREALTIME
  all_flow "$1" "after the other host has gone"
  await_member right
  took=$(jq "(.time_unix_ms / 1000 - $possible) * 100 | round / 100" \
    "$scratch/joined.json")
  jq -en "$took <= $1 + 1" > /dev/null || fail "right was back after $took s"
}

test_data_flow_after_another_host_had_the_same_address() {
  bridge_hosts 4
  start_day
  host_appears
  await head '.event == "node_lost" and .subject == "right"' > "$scratch/lost.json"
  host_goes 5
  day_ends 5
}

test_a_member_with_the_address_of_another_is_told() {
  bridge_hosts 4
  start_day
  host_appears
  inside=(ip netns exec "${hosts[3]}")
  start_node taker --interface eth0 --site-token "$scratch/site.token" \
    --join "$head_at:11811"
  inside=()
  await head '.event == "address_shared"' > "$scratch/told.json"
  jq -e '.data.address == "10.231.7.3:8420"' "$scratch/told.json" > /dev/null \
    || fail "$(cat "$scratch/told.json")"
  stop_node taker KILL
  # Its coordinator has to be silent for 8 s before it is missed.
  host_goes 8
  day_ends 8
}

test_data_flow_after_an_interface_has_flapped() {
  local before lines n host=${hosts[2]:-} held
  start_day
  host=${hosts[2]}
  before=$(what_it_holds right)
  lines=$(wc -l < "$scratch/right.log")
  for ((n = 0; n < ${ROSCELL_FLAPS:-15}; ++n)); do
    ip -n "$host" link set eth0 down
    timeout 0.5 tail -f /dev/null
    ip -n "$host" link set eth0 up
    ip -n "$host" route replace default dev eth0
    timeout 0.5 tail -f /dev/null
  done
  possible=$EPOCHREALTIME
  day_ends 5
  # What ends late has ended.
  for ((n = 0; n < 10; ++n)); do
    held=$(what_it_holds right)
    [[ $held != "$before" ]] || break
    await_change
  done
  expect "what the node holds" "$held" "$before"
  (($(renewals_of right) <= 1)) || fail "$(renewals_of right) renewals"
  lines=$(($(wc -l < "$scratch/right.log") - lines))
  ((lines < 60)) || fail "$lines lines in its log"
}

# second_interface ADDRESS/BITS: the third host has another cable to the bridge.
second_interface() {
  local host=${hosts[2]} link=${bridge/rcb/rcw}-3
  ip link add "$link" type veth peer name eth1 netns "$host"
  ip link set "$link" master "$bridge" up
  ip -n "$host" addr add "$1" dev eth1
  ip -n "$host" link set eth1 up
}

# nothing_changes WHEN: pictures go on, and its node stays as it is.
nothing_changes() {
  possible=$EPOCHREALTIME
  all_flow 5 "$1"
  loses_nobody head 2
  expect "renewals $1" "$(renewals_of right)" 0
}

test_a_second_interface_changes_nothing() {
  local host
  start_day
  host=${hosts[2]}
  second_interface 10.231.7.33/24
  nothing_changes "with a second interface in the same subnet"
  day_ends 5
  ip -n "$host" link del eth1
  nothing_changes "once that has gone"
  second_interface 10.231.8.3/24
  ip -n "$host" route replace default dev eth1
  nothing_changes "with the default route by another subnet"
  day_ends 5
  ip -n "$host" route replace default dev eth0
  nothing_changes "with the default route back"
  ip -n "$host" link del eth1
  day_ends 5
}

test_a_node_does_not_choose_between_interfaces_itself() {
  local code
  bridge_hosts 3
  second_interface 10.231.8.3/24
  timeout "$deadline_s" ip netns exec "${hosts[2]}" "$ROSCELL" node --name arm --data-dir "$scratch/arm" \
    --runtime process 2> "$scratch/stderr" < /dev/null
  expect "exit code" $? 2
  has_line "eth0 10.231.7.3, eth1 10.231.8.3" "$scratch/stderr" \
    || fail "$(cat "$scratch/stderr")"
}
