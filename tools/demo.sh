#!/usr/bin/env bash
# From pictures to robot poses, on a cell of four nodes on this machine: installs,
# builds, renders four scenes of AprilTags at known poses, lets four cameras and
# four pose estimators run on the cell, and compares their poses with the truth.
# Ctrl-C ends it and removes everything, at any time.
#
#   --once         end by itself; exit code 0 only if every tag is found and the
#                  median errors are at most 1 % of the distance and 2 degrees.
#                  So it does without a terminal, too
#   --images DIR   instead of the scenes take the PNG or JPEG pictures of DIR,
#                  with a calibration beside them (camera.json) for poses
#   --containers   run the skills in containers of Docker or Podman, if this
#                  user has an engine
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
    -h | --help) sed -n '2,15s/^# \{0,1\}//p' "$0"; exit ;;
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

# One line says what went wrong, and what to do.
fail() {
  echo "demo.sh: $*" >&2
  exit 1
}

[[ -t 1 ]] || once=true
. tools/building.sh
may_build || exit 1

say "installing what is missing"
wanted=()
$containers && [[ $(id -u) -eq 0 ]] && wanted=(--containers)
tools/install.sh "${wanted[@]}" || exit 1
say "building (the first time takes some minutes)"
build roscell instance_shim image_source_skill pose_estimation_skill \
  render_scenes compare_poses || exit 1

bin=$PWD/build/release/bin
dir=$(mktemp -d /tmp/roscell-demo.XXXXXX)
kept=$PWD/build/demo
nodes=()
task=
finish() {
  # It is short, and a second Ctrl-C would leave something behind.
  trap '' INT TERM HUP PIPE
  trap - EXIT
  [[ -z $task ]] || end_task > /dev/null 2>&1 || true
  kill "${nodes[@]}" 2> /dev/null || true
  wait "${nodes[@]}" 2> /dev/null || true
  [[ -z ${engine_socket:-} ]] || stop_engine || true
  rm -rf "$dir"
}
trap finish EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
trap 'exit 129' HUP
mkdir -p "$dir/out/pictures" "$kept"
# By it these nodes know each other, and it goes with them.
export ROSCELL_SITE_TOKEN=$dir/site.token

# user_engine: the socket of a container engine that this user may ask.
user_engine() {
  local socket
  for socket in "${DOCKER_HOST#unix://}" /var/run/docker.sock \
    "${XDG_RUNTIME_DIR:-/run/user/$(id -u)}/podman/podman.sock"; do
    [[ -S $socket && -w $socket ]] && echo "$socket" && return
  done
  return 1
}

# Root gets an engine of the demo's own; others use theirs.
runtime=process
if $containers && [[ $(id -u) -ne 0 ]]; then
  DOCKER_HOST=${DOCKER_HOST:-}
  if user_engine > /dev/null; then
    runtime=auto
  else
    say "no container engine that $(id -un) may use: skills run as processes"
  fi
elif $containers; then
  say "a Docker engine, and a plain Debian as the base image of the skills"
  engine_dir=$dir/engine
  base_tar=$PWD/build/base-images/bookworm.tar
  . tools/own_engine.sh
  if start_engine; then
    runtime=docker:$engine_socket
  else
    engine_socket=
    say "$(cat "$engine_dir.reason"): skills run as processes"
  fi
fi

public_domain=$((20 + $$ % 200))

# start NAME OPTION...: starts a node and waits until it says that it is ready.
start() {
  local name=$1 said=
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
  read -r -t 60 said < "$dir/$name.ready" || true
  [[ -n $said ]] || fail "node $name did not start: $(tail -n 1 "$dir/$name.log")"
}

# Waits until the cell has that many nodes.
await_size() {
  local line= events
  exec {events}< <(exec "$bin/roscell" events --since 0 -o json)
  local reader=$!
  while read -r -t 60 line <&"$events"; do
    [[ $line == *"\"size\":$1"* ]] && break
  done
  kill "$reader" 2> /dev/null || true
  exec {events}<&-
  [[ $line == *"\"size\":$1"* ]] \
    || fail "the cell did not get $1 nodes: $(tail -qn 1 "$dir"/*.log)"
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
    | "$bin/roscell" request --timeout 30 -
}

# What the newest reply says in its error, in one line.
refusal() {
  jq -r '.error | .message, .hint, (.rejected[0]? // empty
    | "\(.step) on \(.node): \(.reasons | join(", "))")' "$dir/reply.json" \
    | paste -sd ';'
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
server=$("$bin/roscell" cells -o json | jq -r '.[0].discovery_server')
for name in arm belt camera; do
  start "$name" --join "$server"
done
await_size 4
"$bin/roscell" nodes

say "one request: a camera and a pose estimator for each scene"
make_request "${folders[@]}" > "$dir/request.json"
task=fleet-poses
"$bin/roscell" request "$dir/request.json" > "$dir/reply.json" \
  || fail "the request was refused: $(refusal)"
jq -r '(.allocations[] | "\(.step)  on  \(.node)"),
  "score \(.score.total), balance \(.score.balance), load \(.score.load)"' \
  "$dir/reply.json"
[[ -z ${engine_socket:-} ]] || engine images

lines=()
for n in "${!folders[@]}"; do
  lines+=("${folders[n]}" "$dir/out/scene_$((n + 1)).jsonl")
done
where=$(jq -r '[.allocations[] | select(.step | startswith("poses_"))]
  | sort_by(.step) | map(.node) | join(",")' "$dir/reply.json")
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
           | jq -r '.[] | select(.spec.step == "camera_1") | .name')"; }
elif $once; then
  say "poses beside the truth"
  "$bin/compare_poses" --summary --wait 60 --frames 5 --nodes "$where" \
    "${lines[@]}" || code=$?
else
  say "poses beside the truth, of the last 5 frames; Ctrl-C ends"
  "$bin/compare_poses" --summary --watch --last 5 --nodes "$where" \
    "${lines[@]}" || true
fi
if [[ -z $images ]]; then
  "$bin/compare_poses" "${lines[@]}" > "$kept/tags.txt" || true
  say "each tag: $kept/tags.txt"
fi
cp "$dir"/out/pictures/*.png "$kept" 2> /dev/null \
  && say "annotated pictures: $kept"

say "one request removes it all"
end_task | jq -r '"\(.task): \(.instances | length) instances have ended"'
task=
"$bin/roscell" instances
exit "$code"
