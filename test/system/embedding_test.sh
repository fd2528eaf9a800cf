# A robot controller with a node inside, docs/examples/robot_controller.

. test/system/scenes/ros2_scene.sh

# start_controller NAME HOST_NUMBER [OPTION...]: joins the cell of the node head;
# what it says goes to $scratch/NAME.said.
start_controller() {
  local name=$1 host=${hosts[$2 - 1]}
  shift 2
  ip netns exec "$host" "$ROSCELL_BUILD/bin/robot_controller" --name "$name" \
    --data-dir "$scratch/$name" --interface eth0 --port "$http_port" \
    --public-domain "$public_domain" --site-token "$scratch/site.token" \
    --shim "$ROSCELL_BUILD/bin/roscell-instance-shim" \
    --join "$(discovery_of head)" "$@" \
    > "$scratch/$name.figures" 2> "$scratch/$name.said" &
  pid[$name]=$!
  echo "${pid[$name]}" >> "$scratch/pids"
}

start_line() {
  need_namespaces
  make_site_token
  bridge_hosts 2
  take_skills
  discovery_port=11811 http_port=8420
  start_on 1 head --coordinator --cell line
  start_controller arm 2
  await_joined head arm
}

# The pose of a tag moves the arm of the other host.
pick_task() {
  "$ROSCELL_BUILD/bin/render_scenes" --tags 4 --frames 4 --width 640 \
    --height 480 "$scratch/scenes" > /dev/null || fail "no scenes"
  jq -n --arg pictures "$scratch/scenes/scene_1" \
    --arg poses "$scratch/poses" '
    def ros2($topic; $type): {protocol: "ros2", endpoint: "/pick/\($topic)",
                              data_type: $type};
    {type: "task_request", task: "pick", pipeline: [
      {id: "camera", operation: "image_source", model: "folder",
       parameters: {rate_hz: 5, loop: true, follow: false},
       input: {protocol: "file", endpoint: $pictures, data_type: "image/png"},
       output: [ros2("image"; "sensor_msgs/msg/Image"),
                ros2("camera_info"; "sensor_msgs/msg/CameraInfo")]},
      {id: "poses", operation: "pose_estimation", model: "apriltag3",
       input: [ros2("image"; "sensor_msgs/msg/Image"),
               ros2("camera_info"; "sensor_msgs/msg/CameraInfo")],
       output: [ros2("poses"; "tf2_msgs/msg/TFMessage"),
                {protocol: "file", endpoint: $poses,
                 data_type: "application/json"}]},
      {id: "move", operation: "move_to", model: "six_axis",
       input: ros2("poses"; "tf2_msgs/msg/TFMessage"),
       output: ros2("wrist"; "geometry_msgs/msg/PointStamped")}]}'
}

test_a_pose_moves_the_arm_of_a_controller_that_embeds_a_node() {
  start_line
  pick_task | to head request - > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  expect "where it moves" "$(jq -r '.allocations[] | select(.step == "move").node' \
    "$scratch/reply.json")" arm
  poses_come
  ip netns exec "${hosts[0]}" timeout "$deadline_s" "$ROSCELL" echo /pick/wrist --count 3 -o json \
    --to "$scratch/head/node.sock" > "$scratch/wrist" \
    || fail "the wrist says nothing: $(cat "$scratch/wrist")"
  [[ $(jq -r .point.x "$scratch/wrist" | sort -u | wc -l) -gt 1 ]] \
    || fail "the arm does not move: $(head -n 3 "$scratch/wrist")"
  local instance
  instance=$(jq -r '.instances[] | select(.step == "move").instance' \
    "$scratch/reply.json")
  expect "its state" "$(get head "/v1/instances/$instance" \
    | jq -r '.instances[0].state')" running
  to head logs "$instance" | has_line 'moves the arm' || fail "no log"
  jq -n '{type: "task_termination", task: "pick"}' | to head request - \
    > "$scratch/end.json" || fail "$(cat "$scratch/end.json")"
  expect "what is left" "$(get head /v1/tasks | jq '.tasks | length')" 0
  kill -TERM "${pid[arm]}"
  timeout 20 tail --pid="${pid[arm]}" -f /dev/null || fail "it does not end"
  has_line 'the wrist is at' < "$scratch/arm.said" || fail "$(cat "$scratch/arm.said")"
}

test_a_controller_that_dies_takes_its_actors_along_and_the_cell_is_told() {
  start_line
  pick_task | to head request - > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  local instance
  instance=$(jq -r '.instances[] | select(.step == "move").instance' \
    "$scratch/reply.json")
  poses_come
  kill -KILL "${pid[arm]}"
  await head '.event == "node_lost" and .subject == "arm"' > /dev/null
  start_controller arm 2
  await head '.event == "node_joined" and .subject == "arm"
    and .data.epoch == 2' > /dev/null
  # They begin anew in the new process.
  await head ".event == \"instance_changed\" and .subject == \"$instance\"
    and .data.restarts == 1 and .data.state == \"running\"" > /dev/null
}
