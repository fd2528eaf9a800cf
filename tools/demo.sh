#!/usr/bin/env bash
# From pictures to robot poses, on a cell of four nodes on this machine: installs,
# builds, renders four scenes of AprilTags at known poses, lets four cameras and
# four pose estimators run on the cell, and compares their poses with the truth.
#
#   --once         end by itself; exit code 0 only if every tag is found and the
#                  median errors are at most 1 % of the distance and 2 degrees
#   --images DIR   instead of the scenes take the PNG or JPEG pictures of DIR,
#                  with a calibration beside them (camera.json) for poses
#   --containers   run the skills in containers of Docker or Podman
set -euo pipefail
cd "$(dirname "$0")/.."

once=false
containers=false
images=
while [[ $# -gt 0 ]]; do
  case $1 in
    --once) once=true ;;
    --containers) containers=true ;;
    --images) images=$(realpath -m "${2:?--images needs a folder}"); shift ;;
    -h | --help) sed -n '2,11s/^# \{0,1\}//p' "$0"; exit ;;
    *) echo "demo.sh: unknown option $1 (--help tells more)" >&2; exit 2 ;;
  esac
  shift
done

if [[ -n $images ]] && ! compgen -G "$images/*.[pPjJ][nNpP]*[gG]" > /dev/null
then
  echo "demo.sh: no PNG or JPEG picture in $images" >&2
  exit 2
fi

say() {
  printf '\n== %s\n' "$*"
}

say "installing what is missing"
wanted=()
$containers && wanted=(--containers)
tools/install.sh "${wanted[@]}"
say "building (the first time takes some minutes)"
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1 \
  CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
[[ -f build/release/build.ninja ]] || cmake --preset release > /dev/null
ninja -C build/release roscell instance_shim image_source_skill \
  pose_estimation_skill render_scenes compare_poses | tail -n 1

bin=$PWD/build/release/bin
dir=$(mktemp -d /tmp/roscell-demo.XXXXXX)
kept=$PWD/build/demo
mkdir -p "$dir/out" "$kept"
nodes=()
task=
finish() {
  trap - EXIT INT TERM
  [[ -z $task ]] || end_task > /dev/null 2>&1 || true
  kill "${nodes[@]}" 2> /dev/null || true
  wait "${nodes[@]}" 2> /dev/null || true
  [[ -z ${engine_socket:-} ]] || stop_engine || true
  rm -rf "$dir"
}
trap finish EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# Root gets an engine of the demo's own; others use theirs.
runtime=process
if $containers; then
  runtime=docker
  if [[ $(id -u) -eq 0 ]]; then
    say "a Docker engine, and a plain Debian as the base image of the skills"
    engine_dir=$dir/engine
    base_tar=$PWD/build/base-images/bookworm.tar
    . tools/own_engine.sh
    start_engine || { cat "$engine_dir.reason"; exit 1; }
    runtime=docker:$engine_socket
  fi
fi

public_domain=$((20 + $$ % 200))

# start NAME OPTION...: starts a node and waits until it says that it is ready.
start() {
  local name=$1
  shift
  mkfifo "$dir/$name.ready"
  # In a session of its own: Ctrl-C is for this script, which ends its nodes.
  # In a public domain of its own: two demos do not see each other. With half of
  # the cores to count on, it also runs beside a compiler that takes them all.
  setsid "$bin/roscell" node --name "$name" --interface lo --port 0 \
    --public-domain "$public_domain" \
    --discovery-port 0 --data-dir "$dir/$name" --skills build/release/skills \
    --capacity cpu=2,memory_mib=2048,disk_mib=4096 --cpu-floor 0.5 --runtime "$runtime" \
    --ready-fd 5 "$@" 5> "$dir/$name.ready" 2> "$dir/$name.log" &
  nodes+=($!)
  read -r -t 20 _ < "$dir/$name.ready" || { cat "$dir/$name.log"; exit 1; }
}

# Waits until the cell has that many nodes.
await_size() {
  local line events
  exec {events}< <(exec "$bin/roscell" events --since 0 -o json)
  local reader=$!
  while read -r -t 20 line <&"$events"; do
    [[ $line == *"\"size\":$1"* ]] && break
  done
  kill "$reader"
  exec {events}<&-
}

# A camera and a pose estimator for each folder of pictures.
make_request() {
  local folders=("$@") n
  for n in "${!folders[@]}"; do
    jq -n --arg n $((n + 1)) --arg folder "${folders[n]}" --arg out "$dir/out" \
      --argjson estimation "$estimation" '
      def ros2($topic; $type):
        {protocol: "ros2", endpoint: "/scene_\($n)/\($topic)",
         data_type: "sensor_msgs/msg/\($type)"};
      {id: "camera_\($n)", operation: "image_source", model: "folder",
       input: {protocol: "file", endpoint: $folder, data_type: "image/png"},
       output: [ros2("image"; "Image"), ros2("camera_info"; "CameraInfo")]},
      {id: "poses_\($n)", operation: "pose_estimation", model: "apriltag3",
       parameters: $estimation,
       input: [ros2("image"; "Image"), ros2("camera_info"; "CameraInfo")],
       output: [
         {protocol: "ros2", endpoint: "/scene_\($n)/tf",
          data_type: "tf2_msgs/msg/TFMessage"},
         {protocol: "file", endpoint: "\($out)/scene_\($n).jsonl",
          data_type: "application/json"},
         {protocol: "file", endpoint: "\($out)/pictures",
          data_type: "image/png"}]}'
  done | jq -s '{type: "task_request", task: "fleet-poses", pipeline: .}'
}

end_task() {
  echo '{"type": "task_termination", "task": "fleet-poses"}' \
    | "$bin/roscell" request -
}

if [[ -n $images ]]; then
  folders=("$images")
  estimation='{"decimation": 1, "refine": false}'
else
  say "four scenes with 4, 8, 24 and 48 tags, rendered at known poses"
  "$bin/render_scenes" "$dir/scenes"
  folders=("$dir"/scenes/scene_{1,2,3,4})
  estimation='{"tag_size_m": 0.16}'
fi

say "a coordination node and three primary nodes, each a process of its own"
start head --coordinator --cell demo
export ROSCELL_TO=$dir/head/node.sock
server=$("$bin/roscell" cells -o json | jq -r '.cells[0].discovery_server')
for name in arm belt camera; do
  start "$name" --join "$server"
done
await_size 4
"$bin/roscell" nodes

say "one request: a camera and a pose estimator for each scene"
mkdir -p "$dir/out/pictures"
make_request "${folders[@]}" > "$dir/request.json"
task=fleet-poses
"$bin/roscell" request "$dir/request.json" > "$dir/reply.json" \
  || { jq -r '.error | .message, (.rejected[]? | "\(.step) on \(.node): \(.reasons | join(", "))")' "$dir/reply.json"; exit 1; }
jq -r '(.allocations[] | "\(.step)  on  \(.node)"),
  "score \(.score.total), balance \(.score.balance), load \(.score.load)"' \
  "$dir/reply.json"
"$bin/roscell" instances
[[ -z ${engine_socket:-} ]] || engine images

lines=()
for n in "${!folders[@]}"; do
  lines+=("${folders[n]}" "$dir/out/scene_$((n + 1)).jsonl")
done
code=0
# From here on Ctrl-C ends what is shown, not the cleaning up.
trap : INT
if [[ -n $images ]]; then
  say "what the estimator sees"
  # Twelve frames take longer than the second after which a picture is drawn.
  shown=(cat)
  $once && shown=(timeout 30 head -n 12)
  "${shown[@]}" < <(exec tail --pid=$$ -n +1 -F "$dir/out/scene_1.jsonl" \
    2> /dev/null) | jq -r --unbuffered '
      "\(.frame): \(.tags | length) tags: " + ([.tags[] | "\(.id)"
        + (if .pose then " at \(.pose.position)" else "" end)]
        | join(", "))' || true
  [[ -s $dir/out/scene_1.jsonl ]] \
    || { echo "no picture could be read; the log of camera_1:"; code=1
         "$bin/roscell" logs "$("$bin/roscell" instances -o json \
           | jq -r '.instances[] | select(.spec.step == "camera_1")
             | .spec.instance')"; }
elif $once; then
  say "poses beside the truth"
  "$bin/compare_poses" --wait 60 --frames 5 "${lines[@]}" || code=$?
else
  say "poses beside the truth; Ctrl-C ends"
  "$bin/compare_poses" --watch --last 5 "${lines[@]}" || true
fi
cp "$dir"/out/pictures/*.png "$kept" 2> /dev/null \
  && say "annotated pictures: $kept"

say "one request removes it all"
end_task
task=
"$bin/roscell" instances
exit "$code"
