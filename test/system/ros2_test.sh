# Stock ROS 2 programs in a cell: beside skills, with nothing but the output of
# `roscell env`, and as skills.

# start_scene [STEP]: a cell of two hosts; a camera on the second, and on the
# first what finds tags in pictures that something else passes on from the
# camera: STEP, or else a program that no task has started.
start_scene() {
  need_namespaces
  make_site_token
  bridge_hosts 2
  local name
  for name in image_source pose_estimation; do
    cp -r "$ROSCELL_BUILD/skills/$name" "$skills"
    ask_no_cpu "$skills/$name"
  done
  discovery_port=11811 http_port=8420
  start_on 1 head --coordinator --cell hall --label place=head
  start_on 2 arm --join "$(discovery_of head)" --label place=arm
  await_joined head arm
  scene "${1:-}" | to head request - > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
}

scene() {
  jq -n --arg photos "$PWD/test/data/apriltag_photos" --arg step "$1" \
    --arg poses "$scratch/poses" '
    def ros2($topic; $type):
      {protocol: "ros2", endpoint: "/scene/\($topic)",
       data_type: "sensor_msgs/msg/\($type)"};
    {type: "task_request", task: "scene", pipeline: ([
      {id: "camera", operation: "image_source", model: "folder",
       labels: {place: "arm"}, parameters: {rate_hz: 5},
       input: {protocol: "file", endpoint: $photos, data_type: "image/jpeg"},
       output: [ros2("image"; "Image"), ros2("camera_info"; "CameraInfo")]},
      {id: "poses", operation: "pose_estimation", model: "apriltag3",
       labels: {place: "head"},
       input: [ros2("passed_on"; "Image")
               + (if $step == "" then {external: true} else {} end),
               ros2("camera_info"; "CameraInfo")],
       output: {protocol: "file", endpoint: $poses,
                data_type: "application/json"}}]
      + (if $step == "" then [] else [$step | fromjson] end))}'
}

# poses_come: until pictures have got through a few times more.
poses_come() {
  local before
  before=$(cat "$scratch/poses" 2> /dev/null | wc -l)
  timeout "$deadline_s" grep -m $((before + 5)) corners > "$scratch/matches" \
    < <(exec tail --pid=$$ -n +1 -F "$scratch/poses" 2> /dev/null) \
    || fail "only $(wc -l < "$scratch/poses") pictures got through"
}

# start_guest NAME HOST_NUMBER [COMMAND...]: the stock program on that host, as
# a person would start it, behind a command such as setpriv.
start_guest() {
  local name=$1 node=head host=${hosts[$2 - 1]}
  [[ $2 -eq 1 ]] || node=arm
  shift 2
  (
    eval "$(to "$node" env)"
    exec ip netns exec "$host" "$@" "$ROSCELL_BUILD/bin/stock_program" \
      sensor_msgs/msg/Image --ros-args -r in:=/scene/image \
      -r out:=/scene/passed_on
  ) > "$scratch/$name.guest" 2>&1 &
  guest=$!
  echo "$guest" >> "$scratch/pids"
}

stop_guest() {
  kill -INT "$guest"
  timeout 20 tail --pid="$guest" -f /dev/null || fail "the guest does not end"
}

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

# A workspace as colcon would install it, with one package of one program.
make_workspace() {
  local package=$scratch/workspace/lib/stock_demo
  mkdir -p "$package" "$scratch/workspace/share/ament_index/resource_index/packages"
  touch "$scratch/workspace/share/ament_index/resource_index/packages/stock_demo"
  cp "$ROSCELL_BUILD/bin/stock_program" "$package/relay"
  echo "export AMENT_PREFIX_PATH=$scratch/workspace" \
    > "$scratch/workspace/setup.bash"
}

relay_descriptor() {
  jq -n --arg setup "$scratch/workspace/setup.bash" '
    {data_types: ["sensor_msgs/msg/Image"], protocols: ["ros2"]} as $port
    | {operation: "relay", engine: "ros2_standalone",
       ros2: {package: "stock_demo", executable: "relay", setup: [$setup],
              arguments: ["sensor_msgs/msg/Image"],
              topics: {in: "input", out: "output"}},
       input: $port, output: $port,
       models: [{name: "stock", parameters: {level: 1},
         deployments: [{name: "host", base_image: "debian:bookworm-slim",
           architectures: ["amd64", "arm64"],
           resources: {cpu: 0, memory_mib: 64, disk_mib: 1}}]}]}'
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
  # Its own end is a failure of the step at once, also without signs of life.
  pkill -KILL -f "enclave /${instance//-/_}"
  await arm ".event == \"instance_changed\" and .subject == \"$instance\"
    and .data.state == \"failed\"" > /dev/null
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
