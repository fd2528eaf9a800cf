# A cell of three hosts on a day that goes wrong for one of them, mostly the third.
# A camera and a reader of another camera's pictures are there, a third stream is
# between the two others, and the pictures of a fourth pass through a program there
# that no task has started, as `roscell env` says. What counts are pictures that
# arrive, after the day and once more after each step was started anew. To be
# sourced by files of tests.

# The streams: who has the camera, and who looks at the pictures.
declare -A camera_on=([there]=left [from]=right [beside]=left [guest]=left)
declare -A reader_on=([there]=right [from]=left [beside]=head [guest]=head)
streams=(there from beside guest)

# start_day [OPTION...]: the cell, with these options of each node. Where it ends
# each stream flows.
start_day() {
  local name
  need_namespaces
  make_site_token
  bridge_hosts 3
  for name in image_source pose_estimation; do
    cp -r "$ROSCELL_BUILD/skills/$name" "$skills"
    ask_no_cpu "$skills/$name"
  done
  discovery_port=11811 http_port=8420
  day_options=("$@")
  start_host head
  start_host left
  start_host right
  for name in "${streams[@]}"; do start_stream "$name"; done
  start_guest
  all_flow "$deadline_s" "at first"
}

# start_guest: the program on the third host, as a person would start it.
start_guest() {
  (
    eval "$(to right env)"
    exec ip netns exec "${hosts[2]}" "$ROSCELL_BUILD/bin/stock_program" \
      sensor_msgs/msg/Image --ros-args -r in:=/guest/image \
      -r out:=/guest/passed_on
  ) > "$scratch/guest.log" 2>&1 &
  guest=$!
  echo "$guest" >> "$scratch/pids"
}

# restart_guest: what its person does where the address that it was started with
# is another one.
restart_guest() {
  kill -KILL "$guest"
  start_guest
}

declare -A number_of=([head]=1 [left]=2 [right]=3)

# start_host NAME: its node, on a host whose boot has the id in NAME.boot. Where
# the coordinator is, is in $head_at.
head_at=10.231.7.1
start_host() {
  local name=$1 number=${number_of[$1]} how=(--coordinator --cell hall)
  local host=${hosts[$((number - 1))]}
  [[ -f $scratch/$name.boot ]] \
    || cat /proc/sys/kernel/random/uuid > "$scratch/$name.boot"
  [[ $name == head ]] || how=(--join "$head_at:11811")
  inside=(ip netns exec "$host" bash -c
    'mount --bind "$0" /proc/sys/kernel/random/boot_id && exec "$@"'
    "$scratch/$name.boot")
  start_node "$name" --interface "${interface:-eth0}" --label "place=$name" \
    --site-token "$scratch/site.token" "${how[@]}" "${day_options[@]}"
  inside=()
  possible=$EPOCHREALTIME
  [[ $name == head ]] || await_member "$name"
  # Its person starts it again where the host was off.
  [[ $name != right || -z ${guest:-} ]] || kill -0 "$guest" 2> /dev/null \
    || start_guest
}

# await_member NAME: until it is in the cell, anew if it was before.
declare -A epoch
await_member() {
  await head ".event == \"node_joined\" and .subject == \"$1\"
    and .data.epoch > ${epoch[$1]:-0}" > "$scratch/joined.json"
  epoch[$1]=$(jq .data.epoch "$scratch/joined.json")
}

# start_stream NAME: pictures from a camera to a reader, five a second.
start_stream() {
  jq -n --arg name "$1" --arg photos "$PWD/test/data/apriltag_photos" \
    --arg camera "${camera_on[$1]}" --arg reader "${reader_on[$1]}" \
    --arg poses "$scratch/$1.poses" '
    def ros2($topic; $type):
      {protocol: "ros2", endpoint: "/\($name)/\($topic)",
       data_type: "sensor_msgs/msg/\($type)"};
    ros2("camera_info"; "CameraInfo") as $info
    | (if $name != "guest" then ros2("image"; "Image")
       else ros2("passed_on"; "Image") + {external: true} end) as $image
    | {type: "task_request", task: $name, pipeline: [
        {id: "camera", operation: "image_source", model: "folder",
         labels: {place: $camera}, parameters: {rate_hz: 5},
         input: {protocol: "file", endpoint: $photos, data_type: "image/jpeg"},
         output: [ros2("image"; "Image"), $info]},
        {id: "reader", operation: "pose_estimation", model: "apriltag3",
         labels: {place: $reader}, input: [$image, $info],
         output: {protocol: "file", endpoint: $poses,
                  data_type: "application/json"}}]}' \
    | to head request - > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
}

# flows STREAM SECONDS WHEN: some more pictures come within this time after what
# has made it possible, which is told for people who compare days.
possible=$EPOCHREALTIME
flows() {
  local file=$scratch/$1.poses before took
  touch "$file"
  before=$(wc -l < "$file")
  # What is left of it once the cell has said that the day is over.
  timeout "$(jq -n "[$2 - $(seconds_since "$possible"), 1] | max")" \
    grep -m $((before + 3)) frame_id > "$scratch/$1.matches" \
    < <(exec tail --pid=$$ -n +1 -F "$file" 2> /dev/null) \
    || fail "stream '$1': $(($(wc -l < "$file") - before)) pictures in $2 s $3;" \
      "$(to head topics 2>&1 | grep "/$1/")"
  took=$(seconds_since "$possible")
  echo "    stream '$1': pictures after $took s $3"
  jq -nc --arg day "${FUNCNAME[3]#test_}" --arg stream "$1" --arg when "$3" \
    --argjson s "$took" '$ARGS.named' >> "$kept/days.jsonl"
}

# all_flow SECONDS WHEN
all_flow() {
  local name waits=()
  for name in "${streams[@]}"; do
    flows "$name" "$@" &
    waits+=($!)
  done
  for name in "${waits[@]}"; do
    wait "$name" || exit 1
  done
}

# day_ends SECONDS: pictures come within this time, only ends that live are named
# as such, and that is so again after each step was started anew.
day_ends() {
  local name step
  all_flow "$1" "after the day"
  names_living_ends_only
  for name in "${streams[@]}"; do
    for step in camera reader; do
      to head restart "$(instance "$name" "$step")" > "$scratch/restart" 2>&1 \
        || fail "not restarted: $(cat "$scratch/restart")"
    done
  done
  possible=$EPOCHREALTIME
  all_flow 10 "after each step was started anew"
  names_living_ends_only
  for name in "${streams[@]}"; do none_is_doubled "$name"; done
}

instance() {
  get head "/v1/tasks/$1" \
    | jq -r --arg step "$2" '.tasks[0].instances[]
        | select(.spec.step == $step) | .spec.instance'
}

# Each topic has one writer and one reader, which run, within the time that it
# takes to notice who does not.
names_living_ends_only() {
  local until=$((SECONDS + 15)) ends
  while :; do
    ends=$(to head topics -o json 2>&1 | jq -c '[.[]
      | select((.writers | length) != 1 or (.readers | length) != 1)]')
    [[ $ends != '[]' ]] || return 0
    [[ $SECONDS -lt $until ]] || fail "ends that do not live: $ends"
    await_change
  done
}

# await_change: until the cell says something, for a second at most.
await_change() {
  timeout 1 "$ROSCELL" events --to "$scratch/head/node.sock" -o json \
    2> /dev/null | head -n 1 > /dev/null
}

none_is_doubled() {
  local stamps=$scratch/$1.stamps
  jq -R 'fromjson? | .stamp' "$scratch/$1.poses" | sort | uniq -d > "$stamps"
  [[ ! -s $stamps ]] || fail "stream '$1': twice: $(head -n 3 "$stamps")"
}

# kill_host NAME: all that runs there at once, as when its power is cut: nobody
# is told, and the next boot has another id.
kill_host() {
  ip link set "$(host_link "${number_of[$1]}")" down
  ip netns pids "${hosts[$((number_of[$1] - 1))]}" | xargs -r kill -KILL
  timeout "$deadline_s" tail --pid="${pid[$1]}" -f /dev/null
  ip link set "$(host_link "${number_of[$1]}")" up
  cat /proc/sys/kernel/random/uuid > "$scratch/$1.boot"
}

# await_anew NAME ADDRESS: until its node is made anew there.
await_anew() {
  local anew
  anew=$(grep -c "listens on $2:" "$scratch/$1.log")
  timeout "$deadline_s" grep -m $((anew + 1)) "listens on $2:" \
    > "$scratch/matches" \
    < <(exec tail --pid=$$ -n +1 -F "$scratch/$1.log" 2> /dev/null) \
    || fail "$1 is not made anew: $(tail -n 3 "$scratch/$1.log")"
}

# readdress NAME ADDRESS: the host has this one from now on, instead of its own.
readdress() {
  local host=${hosts[$((number_of[$1] - 1))]}
  ip -n "$host" addr flush dev eth0
  ip -n "$host" addr add "$2/24" dev eth0
  ip -n "$host" route replace default dev eth0
  possible=$EPOCHREALTIME
}

# unplug NAME SECONDS: its cable is out for so long.
unplug() {
  ip link set "$(host_link "${number_of[$1]}")" down
  sleep "$2"
  ip link set "$(host_link "${number_of[$1]}")" up
  possible=$EPOCHREALTIME
}

# replug NAME SECONDS: its interface is gone for so long, and is another one then.
replug() {
  local n=${number_of[$1]}
  local host=${hosts[$((n - 1))]}
  ip -n "$host" link del eth0
  sleep "$2"
  ip link add "$(host_link "$n")" type veth peer name eth0 netns "$host"
  ip link set "$(host_link "$n")" master "$bridge" up
  ip -n "$host" link set eth0 up
  readdress "$1" "10.231.7.$n"
}

# kill_node NAME: the node alone; its skills go on.
kill_node() {
  stop_node "$1" KILL
}
