# Days that go wrong for a host or for the coordinator (scenes/days_scene.sh). Each
# counts pictures at three readers. The bounds are those of docs/protocols.md.

. test/system/scenes/days_scene.sh

slow=(test_data_flow_after_a_cable_was_out)

test_data_flow_after_a_node_was_stopped_and_started() {
  start_day
  stop_node right
  start_host right
  day_ends 5
}

test_data_flow_after_a_node_was_killed() {
  start_day
  kill_node right
  start_host right
  day_ends 5
}

test_data_flow_after_the_power_of_a_host_was_cut() {
  start_day
  kill_host right
  start_host right
  day_ends 5
}

test_data_flow_after_a_cable_was_out() {
  start_day
  ip link set "$(host_link 3)" down
  await head '.event == "node_lost"' > /dev/null
  sleep 12
  ip link set "$(host_link 3)" up
  await_member right
  day_ends 5
}

test_data_flow_after_a_coordinator_was_killed() {
  start_day
  kill_node head
  start_host head
  await_member left
  await_member right
  day_ends 5
}

test_data_flow_after_a_coordinator_has_moved() {
  start_day
  kill_host head
  ip -n "${hosts[0]}" addr flush dev eth0
  ip -n "${hosts[0]}" addr add 10.231.7.9/24 dev eth0
  ip -n "${hosts[0]}" route add default dev eth0
  start_host head
  await_member left
  await_member right
  day_ends 5
}
