# A cell of three hosts on a day that goes wrong for one of them, mostly the third
# (bad_days.sh). A camera and a reader of another camera's pictures are there, a third
# stream is between the two others, the pictures of a fourth pass through a program
# there that no task has started, as `roscell env` says, and a fifth has a camera there
# that moves to the second host if the third is lost for long. What counts are pictures
# that arrive, after the day and once more after each step was started anew. To be
# sourced by files of tests.

# The streams: who has the camera, and who looks at the pictures.
declare -A camera_on=([there]=left [from]=right [beside]=left [guest]=left [moving]=)
declare -A reader_on=([there]=right [from]=left [beside]=head [guest]=head
  [moving]=head)
streams=(there from beside guest moving)

# of_matrix SUITE WHOLE: what the tests do in the suite, and what where the whole
# matrix is asked for (tools/testing/days.sh).
of_matrix() {
  [[ ${ROSCELL_DAYS:-suite} == whole ]] && echo "$2" || echo "$1"
}

. test/system/scenes/bad_days.sh
. test/system/scenes/day_metrics.sh

# After so long the camera that may move is placed elsewhere, and ends 8 s before: in
# the suite no day is so long, in the whole matrix the long ones are.
move_after_s=$(of_matrix 60 24)

# start_day: the cell. Where it ends each stream flows, and the day is as the test
# is named.
start_day() {
  local name test
  need_namespaces
  make_site_token
  [[ ${#hosts[@]} -gt 0 ]] || bridge_hosts 3
  take_day_skills
  discovery_port=11811 http_port=8420
  start_host head
  start_host right
  # Its camera has no other place yet.
  start_stream moving
  start_host left
  for name in "${streams[@]}"; do [[ $name == moving ]] || start_stream "$name"; done
  start_guest
  day="at first" possible=$EPOCHREALTIME
  all_flow "$deadline_s" "at first"
  for test in "${FUNCNAME[@]}"; do [[ $test != test_* ]] || break; done
  test=${test#test_data_flow_after_}
  day_begins "${test//_/ }"
}

# give_clock FOLDER: what is run from this skill folder goes by its host's wall clock
# (clock_test.sh).
give_clock() {
  local text
  text=$(jq '.models[].deployments[].environment += {
      LD_PRELOAD: env.LD_PRELOAD, CLOCK_FILE: env.CLOCK_FILE,
      ASAN_OPTIONS: env.ASAN_OPTIONS}' "$1/skill.json")
  echo "$text" > "$1/skill.json"
}

# give_skills BUILD FOLDER: what makes and reads pictures.
give_skills() {
  local name
  mkdir -p "$2"
  for name in image_source pose_estimation; do
    cp -r "$1/skills/$name" "$2"
    ask_no_cpu "$2/$name"
    [[ -z ${CLOCK_FILE:-} ]] || give_clock "$2/$name"
    [[ -z ${right_runtime:-} ]] || allow_much_memory "$2/$name"
  done
}

# take_day_skills: with files that every user of a host may write.
take_day_skills() {
  local name
  give_skills "$ROSCELL_BUILD" "$skills"
  for name in "${!build_of[@]}"; do
    give_skills "${build_of[$name]}" "$skills.$name"
  done
  mkdir -p "$scratch/data"
  touch "${streams[@]/#/$scratch/data/}"
  chmod -R a+w "$scratch/data"
}

# start_guest: the program on the third host, as a person would start it.
guest=
start_guest() {
  (
    variables=$(to right env) || exit
    eval "$variables"
    echo "$EPOCHREALTIME" > "$scratch/guest.since"
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

# start_host NAME: its node, on a host whose boot has the id in NAME.boot, and where
# it has been before, in the cell again. Where the coordinator is, is in $head_at. The
# third host runs skills as $right_runtime says, as the user $right_user. Nodes that
# have a build folder of their own are of that version.
head_at=10.231.7.1
right_user=()
declare -A build_of
start_host() {
  start_node_of "$1"
  [[ $1 == head ]] || await_member "$1"
  # Its person starts it again where the host was off.
  [[ $1 != right || -z $guest ]] || kill -0 "$guest" 2> /dev/null || start_guest
}

# start_node_of NAME: until it is ready.
start_node_of() {
  local name=$1 how=(--coordinator --cell hall) user=() runtime=$runtime
  local build=${build_of[$1]:-}
  local ROSCELL=${build:-$ROSCELL_BUILD}/bin/roscell skills=$skills${build:+.$1}
  [[ -f $scratch/$name.boot ]] \
    || cat /proc/sys/kernel/random/uuid > "$scratch/$name.boot"
  [[ $name == head ]] || how=(--join "$head_at:11811" --label spare=yes)
  if [[ $name == right ]]; then
    user=("${right_user[@]}")
    runtime=${right_runtime:-$runtime}
  fi
  inside=(ip netns exec "$(host_of "$name")" bash -c
    'mount --bind "$0" /proc/sys/kernel/random/boot_id && exec "$@"'
    "$scratch/$name.boot")
  [[ -z ${CLOCK_FILE:-} ]] \
    || inside+=(bash -c 'mount --bind "$0" "$CLOCK_FILE" && exec "$@"'
      "$scratch/$name.clock")
  inside+=("${user[@]}")
  start_node "$name" --interface eth0 --label "place=$name" \
    --site-token "$scratch/site.token" "${how[@]}"
  inside=()
  possible=$EPOCHREALTIME
}

# await_member NAME: until it is in the cell, anew if it was before.
declare -A epoch
await_member() {
  await head ".event == \"node_joined\" and .subject == \"$1\"
    and .data.epoch > ${epoch[$1]:-0}" > "$scratch/joined.json"
  epoch[$1]=$(jq .data.epoch "$scratch/joined.json")
}

# start_stream NAME: pictures from a camera to a reader, two a second.
start_stream() {
  jq -n --arg name "$1" --arg photos "$PWD/test/data/apriltag_photos" \
    --arg camera "${camera_on[$1]}" --arg reader "${reader_on[$1]}" \
    --arg poses "$scratch/data/$1" --argjson after "$move_after_s" '
    def ros2($topic; $type):
      {protocol: "ros2", endpoint: "/\($name)/\($topic)",
       data_type: "sensor_msgs/msg/\($type)"};
    ros2("camera_info"; "CameraInfo") as $info
    | (if $name != "guest" then ros2("image"; "Image")
       else ros2("passed_on"; "Image") + {external: true} end) as $image
    | {type: "task_request", task: $name, pipeline: [
        {id: "camera", operation: "image_source", model: "folder",
         labels: {place: $camera}, parameters: {rate_hz: 2},
         input: {protocol: "file", endpoint: $photos, data_type: "image/jpeg"},
         output: [ros2("image"; "Image"), $info]}
        | if $camera != "" then .
          else .labels = {spare: "yes"}
            | .on_node_loss = {policy: "move", after_s: $after} end,
        {id: "reader", operation: "pose_estimation", model: "apriltag3",
         labels: {place: $reader}, input: [$image, $info],
         output: {protocol: "file", endpoint: $poses,
                  data_type: "application/json"}}]}' \
    | to head request - > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
}

instance() {
  get head "/v1/tasks/$1" \
    | jq -r --arg step "$2" '.tasks[0].instances[]
        | select(.spec.step == $step) | .spec.instance'
}

# await_change: until the cell says something, for a second at most.
await_change() {
  timeout 1 "$ROSCELL" events --to "$scratch/head/node.sock" -o json \
    2> /dev/null | head -n 1 > /dev/null
}
