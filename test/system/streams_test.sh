# What is shown of data that do not flow although everything runs: a reader in one
# task, its camera in another, and packets that the kernel keeps back.

slow=(test_no_step_looks_well_over_dead_data)

# start_line: a camera on one host, and two that read on the other.
start_line() {
  local name
  bridge_hosts 2
  make_site_token
  for name in image_source pose_estimation; do
    cp -r "$ROSCELL_BUILD/skills/$name" "$skills"
    ask_no_cpu "$skills/$name"
  done
  discovery_port=11811
  start_on 1 head --coordinator --cell line --label place=head
  start_on 2 arm --join "$(discovery_of head)" --label place=arm
  await_joined head arm
  start_camera
  start_reader poses eye
  start_reader alone nobody
}

start_camera() {
  jq -n --arg photos "$PWD/test/data/apriltag_photos" '
    {type: "task_request", task: "camera", pipeline: [
      {id: "eye", operation: "image_source", model: "folder",
       labels: {place: "head"}, parameters: {rate_hz: 5},
       input: {protocol: "file", endpoint: $photos, data_type: "image/jpeg"},
       output: [{protocol: "ros2", endpoint: "/eye/image",
                 data_type: "sensor_msgs/msg/Image"},
                {protocol: "ros2", endpoint: "/eye/info",
                 data_type: "sensor_msgs/msg/CameraInfo"}]}]}' | accepted
}

# start_reader TASK CAMERA: a task that no camera is of.
start_reader() {
  jq -n --arg task "$1" --arg eye "$2" --arg poses "$scratch/$1.poses" '
    {type: "task_request", task: $task, pipeline: [
      {id: "look", operation: "pose_estimation", model: "apriltag3",
       labels: {place: "arm"},
       input: [{protocol: "ros2", endpoint: "/\($eye)/image", external: true,
                data_type: "sensor_msgs/msg/Image"},
               {protocol: "ros2", endpoint: "/\($eye)/info", external: true,
                data_type: "sensor_msgs/msg/CameraInfo"}],
       output: {protocol: "file", endpoint: $poses,
                data_type: "application/json"}}]}' | accepted
}

accepted() {
  to head request > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
}

# pictures_come TASK SECONDS: some more than there are.
pictures_come() {
  local file=$scratch/$1.poses before
  touch "$file"
  before=$(wc -l < "$file")
  timeout "$2" grep -m $((before + 3)) frame_id > "$scratch/matches" \
    < <(exec tail --pid=$$ -n +1 -F "$file" 2> /dev/null) \
    || fail "$1: $(($(wc -l < "$file") - before)) pictures in $2 s"
}

# keep_back RULE...: the reader's host does not hear these packets, until `pass`.
keep_back() {
  ip netns exec "${hosts[1]}" nft -f - << RULES
table inet wall {
  chain door {
    type filter hook prerouting priority -450
    $(printf '%s drop\n' "$@")
  }
}
RULES
}

pass() {
  ip netns exec "${hosts[1]}" nft delete table inet wall
}

# all_are_well: once their skills have told of what has come, in their own time.
all_are_well() {
  local end=$((SECONDS + 15)) ill
  until ill=$(get head /v1/instances | jq -c '[.instances[]
      | select((.health // "good") != "good") | {task: .spec.task, health_reason}]') \
    && [[ $ill == '[]' ]]; do
    ((SECONDS < end)) || fail "not well: $ill"
    sleep 0.5
  done
  expect "tasks" "$(get head /v1/tasks | jq -r '[.tasks[].state] | unique[]')" \
    running
}

# shows TASK PART...: wherever people look, each with a part of the reason.
shows() {
  local task=$1 where text
  shift
  for where in tasks instances doctor; do
    text=$(to head $where $([[ $where != doctor ]] || echo --only instances) 2>&1)
    has_line "$task.*$1" <<< "${text//$'\n'/ }" || fail "$where: $text"
  done
  curl -sS --unix-socket "$scratch/head/node.sock" http://node/metrics \
    | has_line "^roscell_instance_starved{.*task=\"$task\".*} 1\$" \
    || fail "no metric of $task"
}

test_no_step_looks_well_over_dead_data() {
  start_line
  pictures_come poses "$deadline_s"
  # What starts now is heard by nobody, not even by its own node's server. Those
  # that are known stay so for a lease.
  keep_back "ip saddr { 10.231.7.2, 127.0.0.1 } udp dport 11811"
  start_reader deaf eye
  await arm '.event == "instance_starved" and .data.task == "deaf"' \
    > "$scratch/deaf.json"
  shows deaf "not known to its node's discovery server"
  pass
  await arm '.event == "instance_recovered" and .data.task == "deaf"' \
    "$(jq .sequence "$scratch/deaf.json")" > /dev/null
  pictures_come deaf 10
  pictures_come poses 10
  all_are_well
  # Everybody is known, and what the camera sends does not come. Later parts of
  # datagrams alone would fill the kernel's memory for them for half a minute.
  keep_back "ip saddr 10.231.7.1 udp dport 7400-7649" \
    "ip saddr 10.231.7.1 ip frag-off & 0x1fff != 0"
  await head '.event == "instance_starved" and .data.task == "poses"' \
    > "$scratch/poses.json"
  jq -e '.data.reason | test("has had no frame for [0-9]+ s, though step .eye. "
    + "of task .camera. on node .head. goes on sending")' "$scratch/poses.json" \
    > /dev/null || fail "$(cat "$scratch/poses.json")"
  shows poses "has had no frame"
  pass
  pictures_come poses 10
  pictures_come deaf 10
  await head '.event == "instance_recovered" and .data.task == "poses"' \
    "$(jq .sequence "$scratch/poses.json")" > /dev/null
  # Nor is it a fault that nobody writes what the third one reads.
  all_are_well
}
