# A camera, a skill that finds tags, and between them a stock ROS 2 program that
# passes the pictures on. To be sourced by files of tests.

# start_scene [STEP]: a cell of two hosts; a camera on the second, and on the
# first what finds tags in pictures that something else passes on from the
# camera: STEP, or else a program that no task has started.
start_scene() {
  need_namespaces
  make_site_token
  bridge_hosts 2
  take_skills
  discovery_port=11811 http_port=8420
  start_on 1 head --coordinator --cell hall --label place=head
  start_on 2 arm --join "$(discovery_of head)" --label place=arm
  await_joined head arm
  scene "${1:-}" | to head request - > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
}

take_skills() {
  local name
  for name in image_source pose_estimation; do
    cp -r "$ROSCELL_BUILD/skills/$name" "$skills"
    ask_no_cpu "$skills/$name"
  done
}

# scene STEP: the request; the pictures come to the file `poses`.
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

# start_guest NAME HOST_NUMBER [COMMAND...]: the stock program on that host, or
# where there is but one on this, as a person would start it, behind a command
# such as setpriv. It sends images in the encoding $sends, if that is set.
start_guest() {
  local name=$1 node=head there=()
  [[ $2 -eq 1 ]] || node=arm
  [[ -z ${hosts[*]:-} ]] || there=(ip netns exec "${hosts[$2 - 1]}")
  shift 2
  (
    eval "$(to "$node" env)"
    exec "${there[@]}" "$@" "$ROSCELL_BUILD/bin/stock_program" \
      sensor_msgs/msg/Image --ros-args -r in:=/scene/image \
      -r out:=/scene/passed_on ${sends:+-p encoding:="$sends"}
  ) > "$scratch/$name.guest" 2>&1 &
  guest=$!
  echo "$guest" >> "$scratch/pids"
}

stop_guest() {
  kill -INT "$guest"
  timeout 20 tail --pid="$guest" -f /dev/null || fail "the guest does not end"
}

# make_workspace [FOLDER [PREFIX]]: as colcon would install it, with one package
# of one program, to be found at PREFIX.
make_workspace() {
  local folder=${1:-$scratch/workspace}
  local index=share/ament_index/resource_index/packages
  mkdir -p "$folder/lib/stock_demo" "$folder/$index"
  touch "$folder/$index/stock_demo"
  cp "$ROSCELL_BUILD/bin/stock_program" "$folder/lib/stock_demo/relay"
  echo "export AMENT_PREFIX_PATH=${2:-$folder}" > "$folder/setup.bash"
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
           resources: {cpu: 0, memory_mib: 0, disk_mib: 1}}]}]}'
}
