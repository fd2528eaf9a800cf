# Stock ROS 2 programs in a cell: beside skills, with nothing but the output of
# `roscell env`, and as skills.

. test/system/scenes/ros2_scene.sh

test_a_stock_program_exchanges_images_with_skills_by_roscell_env_alone() {
  start_scene
  start_guest beside 2
  poses_come
  to head topics > "$scratch/topics"
  has_line '/scene/passed_on .*sensor_msgs/msg/Image .*/ (reliable)' \
    < "$scratch/topics" || fail "not shown: $(cat "$scratch/topics")"
  ip netns exec "${hosts[0]}" "$ROSCELL" hz /scene/passed_on --seconds 2 \
    -o json --to "$scratch/head/node.sock" > "$scratch/rate" \
    || fail "its rate cannot be measured"
  has_line '"rate_hz":' < "$scratch/rate" || fail "$(cat "$scratch/rate")"
  stop_guest
  # On the coordinator's host, as somebody else.
  start_guest desk 1 setpriv --reuid 65534 --regid 65534 --clear-groups
  poses_come
  stop_guest
}

# start_relay FROM TO [OPTION...]: a stock program between topics of head's cell.
start_relay() {
  (
    eval "$(to head env)"
    exec "$ROSCELL_BUILD/bin/stock_program" std_msgs/msg/String --ros-args \
      -r in:="$1" -r out:="$2" "${@:3}"
  ) > "$scratch/relay.log" 2>&1 &
  echo $! >> "$scratch/pids"
}

# await_finding VERDICT TEXT: until the doctor finds that of the topics, for
# nobody tells when a program has been discovered.
await_finding() {
  local end=$((SECONDS + deadline_s))
  until "$ROSCELL" doctor --only topics -o json --data-dir "$scratch/head" \
    --to "$scratch/head/node.sock" > "$scratch/found" 2> "$scratch/doctor.err" \
    ; jq -e --arg how "$1" --arg seen "$2" 'any(.[]; .verdict == $how
      and (.seen | test($seen)))' "$scratch/found" > /dev/null; do
    ((SECONDS < end)) || fail "no '$2': $(cat "$scratch/found" \
      "$scratch/doctor.err" "$scratch/relay.log")"
    sleep 0.5
  done
}

test_doctor_tells_of_topics_whose_ends_are_alone_or_do_not_match() {
  start_node head --coordinator --cell line --interface lo
  start_relay /a /b -p qos_overrides./b.publisher.reliability:=best_effort
  await_finding warning "^nobody reads /b$"
  await_finding warning "^nobody writes /a$"
  start_relay /b /a
  await_finding ok "topics have ends that match"
  start_relay /b /a -p qos_overrides./b.subscription.reliability:=reliable
  await_finding broken "^/b: .* wants reliable, but .* offers best_effort"
}

test_a_camera_may_send_yuv_or_bayer_and_what_nobody_can_use_is_told_before() {
  local sends
  start_scene
  for sends in yuv422_yuy2 bayer_grbg16 nv12; do
    start_guest "$sends" 2
    poses_come
    stop_guest
  done
  sends=jpeg_of_mine
  start_guest strange 2
  await head '.event == "instance_changed" and .data.step == "poses"
    and .data.exit_code == 3' > /dev/null
  to head logs scene > "$scratch/said"
  has_line "brings images in encoding 'jpeg_of_mine'" "$scratch/said" \
    || fail "$(cat "$scratch/said")"
  ip netns exec "${hosts[0]}" "$ROSCELL" doctor --only cameras \
    --to "$scratch/head/node.sock" > "$scratch/found" 2>&1
  has_line jpeg_of_mine "$scratch/found" || fail "$(cat "$scratch/found")"
  stop_guest
  sends=rgb8
  start_guest again 2
  poses_come
}

test_a_stock_program_runs_as_a_step_and_is_told_to_end_as_ros_2_does() {
  make_workspace
  mkdir "$skills/relay"
  relay_descriptor > "$skills/relay/skill.json"
  start_scene "$(jq -nc '
    {id: "relay", operation: "relay", model: "stock", labels: {place: "arm"},
     input: {protocol: "ros2", endpoint: "/scene/image",
             data_type: "sensor_msgs/msg/Image"},
     output: {protocol: "ros2", endpoint: "/scene/passed_on",
              data_type: "sensor_msgs/msg/Image"}}')"
  poses_come
  local instance
  instance=$(jq -r '.instances[] | select(.step == "relay").instance' \
    "$scratch/reply.json")
  expect "state" "$(get head "/v1/instances/$instance" \
    | jq -r '.instances[0].state')" running
  to head topics | has_line "/scene/passed_on .*/${instance//-/_} (reliable)" \
    || fail "not known by its enclave: $(to head topics)"
  to head logs "$instance" > "$scratch/log"
  has_line "relays from /scene/image to /scene/passed_on" < "$scratch/log" \
    || fail "its log: $(cat "$scratch/log")"
  # Its own end is noticed at once, also without signs of life.
  pkill -KILL -f "enclave /${instance//-/_}"
  await arm ".event == \"instance_changed\" and .subject == \"$instance\"
    and .data.state == \"backing_off\"" > /dev/null
}

test_a_step_of_a_package_that_is_not_there_fails_with_the_remedy_in_its_log() {
  make_workspace
  mkdir "$skills/relay"
  relay_descriptor | jq '.ros2.package = "missing_demo"' \
    > "$skills/relay/skill.json"
  start_node head --coordinator --interface lo
  jq -n '{type: "task_request", task: "t", pipeline: [
    {id: "relay", operation: "relay", model: "stock",
     input: {protocol: "ros2", endpoint: "/a", external: true,
             data_type: "sensor_msgs/msg/Image"},
     output: {protocol: "ros2", endpoint: "/b",
              data_type: "sensor_msgs/msg/Image"}}]}' \
    | to head request - > "$scratch/reply.json"
  expect "code" "$(jq -r .error.code "$scratch/reply.json")" engine_failed
  jq -r '.error.log_tail' "$scratch/reply.json" \
    | has_line "there is no package 'missing_demo' in AMENT_PREFIX_PATH" \
    || fail "$(cat "$scratch/reply.json")"
}
