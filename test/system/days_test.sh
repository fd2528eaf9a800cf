# Days that go wrong for a host or for the coordinator (scenes/days_scene.sh). Each
# counts pictures at three readers. The bounds are those of docs/protocols.md.

. test/system/scenes/days_scene.sh

slow=(test_data_flow_after_an_address_was_away test_data_flow_after_a_cable_was_out)

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
  unplug right 20
  await_member right
  day_ends 5
}

test_data_flow_after_a_cable_was_out_for_a_moment() {
  start_day
  unplug right 3
  day_ends 5
}

test_data_flow_after_an_address_has_changed() {
  start_day
  readdress right 10.231.7.13
  await_member right
  restart_guest
  day_ends 10
}

test_data_flow_after_a_host_came_back_at_another_address() {
  start_day
  kill_host right
  readdress right 10.231.7.13
  start_host right
  day_ends 5
}

test_data_flow_after_an_address_was_away() {
  start_day
  ip -n "${hosts[2]}" addr flush dev eth0
  sleep 40
  readdress right 10.231.7.3
  await_member right
  day_ends 5
}

test_data_flow_after_an_interface_was_made_anew() {
  start_day
  replug right 12
  await_member right
  day_ends 5
}

test_data_flow_after_the_address_of_a_coordinator_has_changed() {
  start_day
  readdress head 10.231.7.9
  await_anew head 10.231.7.9
  await_member left
  await_member right
  day_ends 10
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
  readdress head 10.231.7.9
  start_host head
  await_member left
  await_member right
  # Members notice its end when their lease of 8 s is over.
  day_ends 10
}
