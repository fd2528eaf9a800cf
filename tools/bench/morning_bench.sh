#!/usr/bin/env bash
# A site that is switched off in the evening and on in the morning: N hosts (network
# namespaces on one bridge), of which one has the coordinator. Each other one has a
# camera whose pictures the next one reads, two a second. In the evening each host is
# shut down as systemd does it; in the morning they are switched on in a random order,
# each up to a second after the one before. Seconds from the last one being switched on
# to the first picture at each reader, and to all of them; and what the coordinator
# tells of it, on standard error. One JSON line a figure. Needs root.
# Usage: tools/bench/morning_bench.sh BUILD_DIR [N=12] [MORNINGS=3] [SEED]
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${1:?usage: tools/bench/morning_bench.sh BUILD_DIR [N] [MORNINGS] [SEED]}"
count=${2:-12} mornings=${3:-3} RANDOM=${4:-$$}
[[ $count =~ ^[0-9]+$ && $count -ge 3 && $count -le 60 ]] \
  || { echo "N is a number of 3 to 60 hosts" >&2; exit 2; }
. tools/bench/on_nodes.sh "$1"
use_skills image_source pose_estimation
mkdir "$scratch/data"
bridge_hosts "$count"
make_site_token
discovery_port=11811 http_port=8420
# Each node says here that it is ready.
mkfifo "$scratch/ready"
exec {ready}<> "$scratch/ready"

# switch_on I: its node, in a boot of its own. The first host is the coordinator's.
switch_on() {
  local name=host$1 how=(--join 10.231.7.1:11811)
  [[ $1 != 1 ]] || how=(--coordinator --cell site)
  cat /proc/sys/kernel/random/uuid > "$scratch/$name.boot"
  ip netns exec "${hosts[$1 - 1]}" bash -c \
    'mount --bind "$0" /proc/sys/kernel/random/boot_id && exec "$@"' \
    "$scratch/$name.boot" "$ROSCELL" node --name "$name" \
    --data-dir "$scratch/$name" --interface eth0 --label "place=$name" \
    --site-token "$scratch/site.token" --skills "$skills" --runtime process \
    --port "$http_port" --discovery-port "$discovery_port" \
    --public-domain "$public_domain" "${how[@]}" --ready-fd 5 \
    5>&"$ready" 2>> "$scratch/$name.log" &
  pid[$name]=$!
  echo "${pid[$name]}" >> "$scratch/pids"
}

# switch_off: all hosts at once: first the nodes end, then all else is told to.
switch_off() {
  local i number
  for ((i = 1; i <= count; ++i)); do kill -TERM "${pid[host$i]}"; done
  for ((i = 1; i <= count; ++i)); do
    timeout "$deadline_s" tail --pid="${pid[host$i]}" -f /dev/null
    ip netns pids "${hosts[i - 1]}" | xargs -r kill -TERM
  done
  for ((i = 1; i <= count; ++i)); do
    for number in $(ip netns pids "${hosts[i - 1]}"); do
      timeout 15 tail --pid="$number" -f /dev/null || kill -KILL "$number"
    done
  done
}

# stream I: from a camera on host I to a reader on the next one.
stream() {
  jq -n --arg task "stream$1" --arg camera "host$1" --arg reader "host$2" \
    --arg photos "$PWD/test/data/apriltag_photos" --arg poses "$scratch/data/$1" '
    def ros2($topic; $type):
      {protocol: "ros2", endpoint: "/\($task)/\($topic)",
       data_type: "sensor_msgs/msg/\($type)"};
    [ros2("image"; "Image"), ros2("camera_info"; "CameraInfo")] as $pictures
    | {type: "task_request", task: $task, pipeline: [
        {id: "camera", operation: "image_source", model: "folder",
         labels: {place: $camera}, parameters: {rate_hz: 2},
         input: {protocol: "file", endpoint: $photos, data_type: "image/jpeg"},
         output: $pictures},
        {id: "reader", operation: "pose_estimation", model: "apriltag3",
         labels: {place: $reader}, input: $pictures,
         output: {protocol: "file", endpoint: $poses,
                  data_type: "application/json"}}]}' \
    | to host1 request - > "$scratch/reply.json" \
    || { cat "$scratch/reply.json" >&2; exit 1; }
}

# await_picture I: until one comes that none has counted yet.
await_picture() {
  local before
  before=$(< "$scratch/data/$1.before")
  timeout 120 grep -m $((before + 1)) frame_id > "$scratch/data/$1.matches" \
    < <(exec tail --pid=$$ -n +1 -F "$scratch/data/$1" 2> /dev/null) \
    || echo "stream $1: no picture in 120 s" >&2
  now_ms
}

for ((i = 1; i <= count; ++i)); do
  switch_on "$i"
  read -r -t "$deadline_s" <&"$ready" || { tail "$scratch/host$i.log" >&2; exit 1; }
done
for ((i = 2; i <= count; ++i)); do await_joined host1 "host$i"; done
for ((i = 2; i <= count; ++i)); do
  touch "$scratch/data/$i"
  stream "$i" $((i < count ? i + 1 : 2))
done

for ((morning = 1; morning <= mornings; ++morning)); do
  switch_off
  for ((i = 2; i <= count; ++i)); do
    grep -c frame_id "$scratch/data/$i" > "$scratch/data/$i.before"
  done
  mapfile -t order < <(seq "$count" | shuf --random-source=<(
    for ((i = 0; i < 4096; ++i)); do printf '%d' "$RANDOM"; done))
  for i in "${order[@]}"; do
    sleep "0.$((RANDOM % 1000 + 1000))"
    switch_on "$i"
  done
  begin=$(now_ms)
  for ((i = 2; i <= count; ++i)); do await_picture "$i" > "$scratch/data/$i.came" & done
  wait $(jobs -p | grep -vxFf "$scratch/pids")
  sort -n "$scratch"/data/*.came > "$scratch/came"
  figure "morning $morning: median reader has a picture" \
    "$(($(median < "$scratch/came") - begin))" ms
  figure "morning $morning: last reader has a picture" \
    "$(($(tail -n 1 "$scratch/came") - begin))" ms
  { echo "morning $morning, switched on in the order ${order[*]}:"
    to host1 events --since 0 --no-follow; } >&2
done
