#!/usr/bin/env bash
# How fast a new topic is found in a cell of six hosts (network namespaces on one
# bridge): from the start of a camera's process to the first picture that a stock
# ROS 2 program, which waits for it, passes on; on another host and on the same
# one. Beside it what of that the start of such a process takes. Medians, one
# JSON line a figure. The stock program looks at nothing but the output of
# `roscell env`. Needs root.
# Usage: tools/bench/topic_discovery_bench.sh BUILD_DIR [ROUNDS=9]
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${1:?usage: tools/bench/topic_discovery_bench.sh BUILD_DIR [ROUNDS]}"
rounds=${2:-9}
. tools/bench/on_nodes.sh
use_skills image_source
bridge_hosts 6
make_site_token
start_on 1 head --coordinator --cell line
for i in 2 3 4 5 6; do
  start_on "$i" "arm$i" --join "$(discovery_of head)"
  await_joined head "arm$i"
done

# become_guest I COMMAND...: this shell becomes the command on that host, with
# the surroundings that its node tells.
become_guest() {
  eval "$(to "arm$1" env)"
  exec ip netns exec "${hosts[$1 - 1]}" "${@:2}"
}

# After this a reader has been told to all that are there.
settled_s=1.5
camera=$ROSCELL_BUILD/skills/image_source/bin/image_source

# become_camera I TOPIC: pictures of a folder, 100 a second.
become_camera() {
  become_guest "$1" env ROSCELL_MODEL=folder \
    ROSCELL_PARAMETERS='{"rate_hz": 100, "loop": true}' \
    ROSCELL_INPUTS="$(jq -nc --arg folder "$PWD/test/data/apriltag_photos" \
      '[{protocol: "file", endpoint: $folder, data_type: "image/jpeg"}]')" \
    ROSCELL_OUTPUTS="$(jq -nc --arg topic "$2" '[
      {protocol: "ros2", endpoint: "\($topic)/image",
       data_type: "sensor_msgs/msg/Image"},
      {protocol: "ros2", endpoint: "\($topic)/camera_info",
       data_type: "sensor_msgs/msg/CameraInfo"}]')" \
    "$camera" > /dev/null 2>&1
}

# await_line FD WORD: until a program has written a line that begins so.
await_line() {
  local line
  while read -r -t 10 line <&"$1"; do
    [[ $line == "$2"* ]] && return
  done
  echo "no line begins with '$2'" >&2
  exit 1
}

# find_topic WRITER_HOST READER_HOST TOPIC: milliseconds to the first picture.
find_topic() {
  local begin reader writer says
  exec {says}< <(become_guest "$2" "$ROSCELL_BUILD/bin/stock_program" \
    sensor_msgs/msg/Image --ros-args -r "in:=$3/image" -r out:=/passed_on 2>&1)
  reader=$!
  await_line "$says" 'relays from'
  timeout "$settled_s" tail -f /dev/null
  begin=$(now_ms)
  become_camera "$1" "$3" &
  writer=$!
  await_line "$says" relayed
  echo $(($(now_ms) - begin))
  kill "$writer" "$reader"
  exec {says}<&-
}

# start_alone I: milliseconds for the same camera to find that it has no model.
start_alone() {
  local begin
  begin=$(now_ms)
  (become_guest "$1" "$camera" > /dev/null 2>&1)
  echo $(($(now_ms) - begin))
}

# in_rounds COMMAND...: the median, with the number of the round as last word.
in_rounds() {
  local round
  for ((round = 1; round <= rounds; ++round)); do
    "$@" "/scene_$round$2$3"
  done | median
}

figure "new topic, other host: first picture" "$(in_rounds find_topic 3 6)" ms
figure "new topic, same host: first picture" "$(in_rounds find_topic 3 3)" ms
figure "of that, environment and start of the camera" \
  "$(in_rounds start_alone 3 '')" ms
