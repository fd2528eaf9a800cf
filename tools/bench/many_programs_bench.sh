#!/usr/bin/env bash
# Measures how one host bears many ROS 2 programs: a camera and N - 1 readers of its
# pictures, all on one node, of which the last M are stock programs and not skills.
# How many hear the camera, and again after it was started anew; what doctor says of
# the host's ports; CPU of the node and of all programs while a picture comes every
# two seconds, and their memory. One JSON line a figure. Needs root.
# Usage: tools/bench/many_programs_bench.sh N [--stock M] [--binary-dir BUILD_DIR]
set -uo pipefail
cd "$(dirname "$0")/../.."
usage="usage: tools/bench/many_programs_bench.sh N [--stock M] [--binary-dir DIR]"
programs=
stock=0
build=build/release
while [[ $# -gt 0 ]]; do
  case $1 in
    --stock) stock=${2:?$usage}; shift ;;
    --binary-dir) build=${2:?$usage}; shift ;;
    *) programs=$1 ;;
  esac
  shift
done
[[ $programs =~ ^[0-9]+$ && $stock =~ ^[0-9]+$ && $programs -gt $((stock + 1)) ]] \
  || { echo "$usage, with a camera and a reader beside the M" >&2; exit 2; }

. tools/bench/on_nodes.sh "$build"
. tools/bench/idle_nodes.sh
hear_s=20
span_s=30
steps_a_task=32
readers=$((programs - 1 - stock))

# take_skills: what makes pictures and reads them, so that a host has room for any
# number of them.
take_skills() {
  local name text
  skills=$scratch/skills
  mkdir "$skills" "$scratch/pictures" "$scratch/heard"
  cp test/fuzz/seeds/image_file_fuzz/tag.jpg "$scratch/pictures"
  for name in image_source pose_estimation; do
    cp -r "$ROSCELL_BUILD/skills/$name" "$skills"
    text=$(jq '.models[].deployments[].resources
      = {cpu: 0, memory_mib: 0, disk_mib: 0}' "$skills/$name/skill.json")
    echo "$text" > "$skills/$name/skill.json"
  done
}

topics='
  def topic($name; $type):
    {protocol: "ros2", endpoint: "/many/\($name)",
     data_type: "sensor_msgs/msg/\($type)"};
  def pictures: [topic("image"; "Image"), topic("camera_info"; "CameraInfo")];'

# start_readers FIRST LAST: in one task.
start_readers() {
  jq -n --argjson first "$1" --argjson last "$2" --arg heard "$scratch/heard" "
    $topics"'
    {type: "task_request", task: "readers\($first)",
     pipeline: [range($first; $last + 1) | {
       id: "reader\(.)", operation: "pose_estimation", model: "apriltag3",
       input: [pictures[] | .external = true],
       output: {protocol: "file", endpoint: "\($heard)/\(.)",
                data_type: "application/json"}}]}' \
    | to host request - > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
}

start_camera() {
  jq -n --arg pictures "$scratch/pictures" "$topics"'
    {type: "task_request", task: "camera", pipeline: [
       {id: "camera", operation: "image_source", model: "folder",
        parameters: {rate_hz: 0.5},
        input: {protocol: "file", endpoint: $pictures, data_type: "image/jpeg"},
        output: pictures}]}' \
    | to host request - > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
}

# start_stock: programs as a person would start them.
start_stock() {
  local i
  for ((i = 1; i <= stock; ++i)); do
    (
      eval "$(to host env)"
      exec ip netns exec "${hosts[0]}" "$ROSCELL_BUILD/bin/stock_program" \
        sensor_msgs/msg/Image --ros-args -r in:=/many/image \
        -r "out:=/many/passed_on_$i"
    ) > "$scratch/stock.$i" 2>&1 &
    echo $! >> "$scratch/pids"
  done
}

# lines FILE...: of each that is there.
lines() {
  wc -l "$@" 2> /dev/null | awk '$2 != "total" {print $2, $1}' | sort
}

lines_now() {
  lines "$scratch"/heard/* > "$scratch/lines.skills.$1"
  for ((i = 1; i <= stock; ++i)); do
    echo "$i $(grep -c '^relayed' "$scratch/stock.$i")"
  done | sort > "$scratch/lines.stock.$1"
}

# heard KIND: how many have got more between two looks.
heard() {
  join -a 2 "$scratch/lines.$1.before" "$scratch/lines.$1.after" \
    | awk '(NF == 3 && $3 > $2) || (NF == 2 && $2 > 0) {++n} END {print n + 0}'
}

# listen WHEN: who hears the camera within some seconds.
listen() {
  lines_now before
  timeout "$hear_s" tail -f /dev/null
  lines_now after
  figure "skills that hear the camera $1" "$(heard skills)" "of $readers"
  [[ $stock -eq 0 ]] \
    || figure "stock programs that hear the camera $1" "$(heard stock)" "of $stock"
}

program_ids() {
  ip netns pids "${hosts[0]}" | grep -vx "${pid[host]}"
}

# cpu_of_programs_ns: of all threads that live.
cpu_of_programs_ns() {
  local id
  for id in $(program_ids); do
    cat /proc/"$id"/task/*/schedstat 2> /dev/null
  done | awk '{sum += $1} END {print sum}'
}

pss_of_programs_kib() {
  local id
  for id in $(program_ids); do
    awk '$1 == "Pss:" {print $2}' "/proc/$id/smaps_rollup" 2> /dev/null
  done | awk '{sum += $1} END {print sum}'
}

rest_figures() {
  local node programs_before
  node=$(cpu_ns host)
  programs_before=$(cpu_of_programs_ns)
  timeout "$span_s" tail -f /dev/null
  figure "node: CPU" "$(jq -n "($(cpu_ns host) - $node) / 1e7 / $span_s")" \
    "% of a core"
  figure "all programs: CPU" "$(jq -n \
    "($(cpu_of_programs_ns) - $programs_before) / 1e7 / $span_s")" "% of a core"
  figure "node: Pss" "$(jq -n "$(memory_kib host Pss) / 1024")" MiB
  figure "all programs and shims: Pss" \
    "$(jq -n "$(pss_of_programs_kib) / 1024")" MiB
}

bridge_hosts 1
make_site_token
take_skills
start_on 1 host --coordinator --cell line
begin=$(now_ms)
for ((i = 1; i <= readers; i += steps_a_task)); do
  last=$((i + steps_a_task - 1))
  start_readers "$i" "$((last < readers ? last : readers))"
done
start_stock
start_camera
figure "programs: all started" $(($(now_ms) - begin)) ms
figure "node: CPU of all starts" "$(jq -n "$(cpu_ns host) / 1e9")" s
listen "at first"
rest_figures
to host restart "$(get host /v1/tasks/camera \
  | jq -r '.tasks[0].instances[0].spec.instance')" > /dev/null
listen "after it was started anew"
ip netns exec "${hosts[0]}" "$ROSCELL" doctor --only dds-ports -o json \
  > "$scratch/doctor.json" 2> "$scratch/doctor.err"
jq -c '{figure: "doctor", value: .}' "$scratch/doctor.json"
