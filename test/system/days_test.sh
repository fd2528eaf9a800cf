# Days that go wrong for a host or for the coordinator (scenes/days_scene.sh). Each
# counts pictures at five readers. The bounds are those of docs/protocols.md. Longer
# times, which are in the whole matrix only, are the second ones of `of_matrix`; the
# days of a host with containers are in container_days_test.sh.

. test/system/scenes/days_scene.sh

slow=(test_data_flow_after_an_address_was_away test_data_flow_after_a_cable_was_out test_data_flow_after_an_address_has_changed test_data_flow_after_a_host_has_slept test_data_flow_after_a_coordinator_was_killed test_data_flow_after_all_hosts_were_off)

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

test_data_flow_after_all_that_runs_on_a_host_was_killed() {
  start_day
  kill_programs right
  start_host right
  day_ends 5
}

test_data_flow_after_the_power_of_a_host_was_cut() {
  start_day
  kill_host right
  start_host right
  day_ends 5
}

test_data_flow_after_a_host_was_shut_down() {
  start_day
  shut_down right
  start_host right
  day_ends 5
  day_begins "a coordinator was shut down"
  shut_down head
  start_host head
  await_member left
  await_member right
  day_ends 5
}

# A camera goes to the other host that has room for it, whose node dies then.
test_data_flow_after_a_host_was_drained() {
  local streams=(guest moving)
  start_day
  to head drain right > "$scratch/said" 2>&1 || true
  await head '.event == "instance_moved" and .data.task == "moving"
    and .data.to == "left"' > /dev/null
  to head undrain right > /dev/null
  day_ends 5
  day_begins "the node that has taken it was killed"
  kill_node left
  start_host left
  day_ends 5
}

# A site that is switched off in the evening and on in the morning, in any order.
test_data_flow_after_all_hosts_were_off() {
  local order name end=shut_down
  start_day
  while read -r order; do
    day_begins "all hosts were off ($end), and came as $order"
    for name in right left head; do "$end" "$name"; done
    for name in $order; do start_node_of "$name"; done
    await_member left
    await_member right
    start_guest
    day_ends 15
    [[ $end == shut_down ]] && end=kill_host || end=shut_down
  done < <(of_matrix $'head left right\nright left head' "$(orders_of_hosts)")
}

# What is started in the morning is to look for its cell where that is now.
test_data_flow_after_a_night_that_moved_the_coordinator() {
  local name
  start_day
  for name in right left head; do kill_host "$name"; done
  readdress head 10.231.7.9
  for name in left head right; do start_node_of "$name"; done
  await_member left
  await_member right
  start_guest
  day_ends 15
}

orders_of_hosts() {
  printf '%s\n' "head left right" "head right left" "left head right" \
    "right head left" "left right head" "right left head"
}

test_data_flow_after_a_cable_was_out() {
  local span_s
  start_day
  for span_s in $(of_matrix "1 7 12 20" "1 3 7 12 20 40 90"); do
    day_begins "a cable was out for $span_s s"
    unplug right "$span_s"
    # What is shorter than a lease may be noticed by nobody.
    [[ $span_s -lt 8 ]] || await_member right
    day_ends 5
  done
}

test_data_flow_after_a_host_started_without_a_cable() {
  start_day
  kill_host right down
  start_node_of right
  sleep 3
  plug right
  await_member right
  start_guest
  day_ends 5
}

test_data_flow_after_a_coordinator_started_without_a_cable() {
  start_day
  kill_host head down
  { sleep 5; ip link set "$(cable_of head)" up; } &
  # It is ready when it has the cable.
  start_host head
  await_member left
  await_member right
  day_ends 5
}

test_data_flow_after_a_host_has_slept() {
  local span_s
  start_day
  for span_s in $(of_matrix 45 "12 45"); do
    day_begins "a host has slept for $span_s s"
    send_to_sleep right "$span_s"
    await_member right
    day_ends 5
  done
}

test_data_flow_after_an_address_has_changed() {
  start_day
  readdress right 10.231.7.13
  await_member right
  restart_guest
  day_ends 10
  day_begins "an address has changed with a gap of 5 s"
  readdress right 10.231.7.14 5
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
  local span_s
  start_day
  for span_s in $(of_matrix 40 "3 12 40 90"); do
    day_begins "an address was away for $span_s s"
    readdress right 10.231.7.3 "$span_s"
    await_member right
    day_ends 5
  done
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
  day_begins "a coordinator was stopped and started"
  stop_node head
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
  day_ends 5
}
