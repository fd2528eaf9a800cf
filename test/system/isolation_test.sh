# Two cells whose skills use the same topic names, seen by each other and by a
# DDS implementation that is not ours.

# start_cell CELL HEAD_HOST ARM_HOST: a coordinator and a member on these hosts,
# and a camera on the member whose pictures the coordinator looks at. Topics have
# the same names in every cell; the frame of the pictures is the cell's name.
start_cell() {
  local cell=$1
  start_on "$2" "$cell-head" --coordinator --cell "$cell" --label place=head
  start_on "$3" "$cell-arm" --join "$(discovery_of "$cell-head")" \
    --label place=arm
  await_joined "$cell-head" "$cell-arm"
  scene_task "$cell" | to "$cell-head" request > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
}

scene_task() {
  jq -n --arg cell "$1" --arg photos "$PWD/test/data/apriltag_photos" \
    --arg poses "$scratch/$1.poses" '
    def ros2($topic; $type):
      {protocol: "ros2", endpoint: "/scene/\($topic)",
       data_type: "sensor_msgs/msg/\($type)"};
    [ros2("image"; "Image"), ros2("camera_info"; "CameraInfo")] as $scene
    | {type: "task_request", task: "scene", pipeline: [
        {id: "camera", operation: "image_source", model: "folder",
         labels: {place: "arm"}, parameters: {rate_hz: 2, frame_id: $cell},
         input: {protocol: "file", endpoint: $photos, data_type: "image/jpeg"},
         output: $scene},
        {id: "poses", operation: "pose_estimation", model: "apriltag3",
         labels: {place: "head"}, input: $scene,
         output: {protocol: "file", endpoint: $poses,
                  data_type: "application/json"}}]}'
}

# in_background HOST NAME COMMAND...: a program on that host, until the test
# ends. What it says is in NAME.out.
in_background() {
  local host=${hosts[$1 - 1]} name=$2
  shift 2
  ip netns exec "$host" "$@" > "$scratch/$name.out" 2> "$scratch/$name.log" &
  echo $! >> "$scratch/pids"
}

# await_line FILE PATTERN [COUNT]: until so many lines of the file match.
await_line() {
  timeout "$deadline_s" grep -m "${3:-1}" "$2" > "$scratch/matches" \
    < <(exec tail --pid=$$ -n +1 -F "$scratch/$1" 2> /dev/null) \
    || fail "$1 has not ${3:-1} '$2': $(tail -n 1 "$scratch/$1" | cut -c -200)"
}

# frames_come CELL: until some more pictures have arrived in that cell.
frames_come() {
  local before
  await_line "$1.poses" frame_id
  before=$(wc -l < "$scratch/$1.poses")
  await_line "$1.poses" frame_id $((before + 8))
}

# listen HOST NAME [PEER]: what Cyclone DDS sees there.
listen() {
  in_background "$1" "$2" "$ROSCELL_BUILD/bin/cyclone_listener" \
    "10.231.7.$1" /scene/camera_info ${3:+"$3"}
  await_line "$2.out" listening
}

# seen_by NAME: everything that the listener has seen.
seen_by() {
  grep '"seen"' "$scratch/$1.out"
}

# A camera outside of cells, which announces itself to everybody.
start_stray_camera() {
  in_background "$1" stray env ROSCELL_MODEL=folder \
    ROSCELL_PARAMETERS='{"rate_hz": 2, "loop": true, "frame_id": "stray"}' \
    ROSCELL_INPUTS="$(scene_task - | jq -c '[.pipeline[0].input]')" \
    ROSCELL_OUTPUTS="$(scene_task - | jq -c '.pipeline[0].output')" \
    "$skills/image_source/bin/image_source"
}

# cells_are_isolated A_HEAD A_ARM B_HEAD B_ARM LISTENER STRAY: hosts of what is
# named so. The second from which on both cells were at work is in $formed.
cells_are_isolated() {
  local cell
  start_cell a "$1" "$2"
  start_cell b "$3" "$4"
  listen "$5" bystander
  for cell in a b; do frames_come "$cell"; done
  formed=$(date +%s)
  for cell in a b; do frames_come "$cell"; done
  expect "what a bystander sees of two cells" "$(seen_by bystander)" ""
  start_stray_camera "$6"
  await_line bystander.out '"sample"' 5
  for cell in a b; do frames_come "$cell"; done
  expect "what a bystander reads" "$(seen_by bystander \
    | jq -r 'select(.seen == "sample") | .frame_id' | sort -u)" stray
  expect "participants that it sees" "$(seen_by bystander \
    | grep -c '"participant"')" 1
  for cell in a b; do
    expect "pictures in cell $cell" \
      "$(jq -r .frame_id "$scratch/$cell.poses" | sort -u)" "$cell"
  done
}

# guest_receives HOST CELL: the same listener, given the discovery server of
# that cell. A server of Fast DDS hears its own vendor only, hence the gate.
guest_receives() {
  local server
  server=$(discovery_of "$2-head")
  in_background "$1" gate "$ROSCELL_BUILD/bin/server_gate" "10.231.7.$1" \
    "${server%:*}" "${server#*:}"
  await_line gate.out .
  listen "$1" guest "10.231.7.$1:$(cat "$scratch/gate.out")"
  await_line guest.out "\"sample\".*\"$2\"" 5
  await_line guest.out '"sample".*"stray"' 5
  expect "what the guest reads" "$(seen_by guest \
    | jq -r 'select(.seen == "sample") | .frame_id' | sort -u | xargs)" \
    "$2 stray"
  seen_by guest | grep '"writer"' | has_line '"rt/scene/camera_info"' \
    || fail "it does not see the writer"
}

need_bystander() {
  local name
  for name in cyclone_listener server_gate; do
    [[ -x $ROSCELL_BUILD/bin/$name ]] \
      || skip "built without Cyclone DDS: install cyclonedds-dev, cyclonedds-tools"
  done
  command -v tcpdump > /dev/null || skip "tcpdump is missing"
  make_site_token
  rm -r "$skills"
  use_skills image_source pose_estimation
}

# packets FILTER [SINCE]: how many were captured, since that second.
packets() {
  tcpdump -r "$scratch/capture" -nn -tt "$1" 2> /dev/null \
    | awk -v since="${2:-0}" '$1 >= since' | wc -l
}

test_two_cells_on_a_bridge_and_a_bystander_share_no_data() {
  need_bystander
  bridge_hosts 6
  tcpdump -i "$bridge" -w "$scratch/capture" -U --immediate-mode \
    2> "$scratch/tcpdump.log" &
  local capture=$! hosts_of_cells="(src 10.231.7.1 or src 10.231.7.2
    or src 10.231.7.3 or src 10.231.7.4)"
  await_line tcpdump.log listening
  cells_are_isolated 1 2 3 4 5 6
  kill "$capture"
  wait "$capture"
  expect "announcements to the ROS domain by cells" \
    "$(packets "$hosts_of_cells and dst 239.255.0.1 and dst port 7400")" 0
  expect "what members announce to everybody" "$(packets \
    "(src 10.231.7.2 or src 10.231.7.4) and dst net 239.0.0.0/8" "$formed")" 0
  expect "packets between a member and the other cell" "$(packets "ip and
    ((host 10.231.7.2 and (host 10.231.7.3 or host 10.231.7.4))
     or (host 10.231.7.4 and (host 10.231.7.1 or host 10.231.7.2)))")" 0
  # What would have been seen.
  [[ $(packets "host 10.231.7.1 and host 10.231.7.2") -gt 50 \
    && $(packets "src 10.231.7.6 and dst 239.255.0.1 and dst port 7400") -gt 0 ]] \
    || fail "the capture is not complete"
  guest_receives 5 a
}

test_two_cells_and_a_bystander_on_one_host_share_no_data() {
  need_bystander
  bridge_hosts 1
  cells_are_isolated 1 1 1 1 1 1
  guest_receives 1 b
}
