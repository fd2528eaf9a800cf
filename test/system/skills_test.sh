# Skills as they lie on nodes, and CPU that others use.

# own_skills NAME: a folder of skills for one node, a copy of all.
own_skills() {
  cp -r "$scratch/skills" "$scratch/$1.skills"
}

# start_two: a cell of two nodes, each with its own folder of skills.
start_two() {
  skills=$scratch/head.skills start_node head --coordinator --cell line \
    --interface lo --label place=head
  skills=$scratch/arm.skills start_node arm --interface lo \
    --join "$(discovery_of head)" --label place=arm
  await_joined head arm
}

test_a_node_whose_build_no_other_has_runs_it_where_its_label_is_asked_for() {
  own_skills head
  own_skills arm
  touch "$scratch/arm.skills/echo/extra"
  start_two
  local node
  for node in arm head; do
    echo_task "on-$node" "$node" > "$scratch/task.json"
    to head request "$scratch/task.json" > "$scratch/reply.json" \
      || fail "refused: $(cat "$scratch/reply.json")"
    expect "the node" "$(jq -r '.instances[0].node' "$scratch/reply.json")" \
      "$node"
  done
  expect "builds" "$(get head /v1/skills | jq '.skills | length')" 2
  expect "versions" \
    "$(get head /v1/skills | jq '[.skills[].skill.version] | unique | length')" 1
}

test_a_skill_without_its_program_is_refused_and_shown_with_the_reason() {
  own_skills head
  own_skills arm
  rm "$scratch/arm.skills/echo/bin/echo"
  start_two
  expect "who has it" \
    "$(get head /v1/skills | jq -c '[.skills[].nodes[]]')" '["head"]'
  to head skills > "$scratch/table"
  grep -q "refused on arm: .*/echo/skill.json /entry_point/0: .*missing" \
    "$scratch/table" || fail "not shown: $(cat "$scratch/table")"
  echo_task hello arm > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json"
  expect "code" "$(jq -r .error.code "$scratch/reply.json")" \
    no_feasible_allocation
}

# edit_echo FOLDER PREFIX: its program is another one, which puts PREFIX before
# each line.
edit_echo() {
  mv -n "$1/bin/echo" "$1/bin/plain"
  printf '#!/bin/sh\nROSCELL_PARAMETERS='\''{"prefix": "%s"}'\'' exec "${0%%/*}/plain"\n' \
    "$2" > "$scratch/program"
  chmod +x "$scratch/program"
  mv "$scratch/program" "$1/bin/echo"
}

# builds_on NODE: the hashes of the builds that its coordinator knows there.
builds_on() {
  get head /v1/skills \
    | jq -r --arg node "$1" '.skills[] | select(.nodes | index($node)) | .skill.hash'
}

# instance_at NODE FIELD: of the one instance in its cell.
instance_at() {
  get "$1" /v1/instances | jq -r ".instances[0].$2"
}

test_an_edited_skill_is_a_new_build_at_once_and_what_runs_of_it_runs_on() {
  local before shim prefix
  own_skills head
  skills=$scratch/head.skills start_node head --coordinator --interface lo
  echo_task hello > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  lines_come hello before
  for prefix in first second; do
    before=$(builds_on head)
    shim=$(instance_at head container)
    edit_echo "$scratch/head.skills/echo" "$prefix "
    await head ".event == \"skill_removed\" and .data.hash == \"$before\"" \
      > /dev/null
    [[ $(builds_on head) =~ ^[0-9a-f]{64}$ && $(builds_on head) != "$before" ]] \
      || fail "builds: $(builds_on head)"
    expect "what runs" "$(instance_at head 'spec.skill')" "$before"
    lines_come hello "meanwhile of $prefix" \
      "$([[ $prefix == first ]] || echo "first ")"
    expect "its program" "$(instance_at head container)" "$shim"
    to head restart hello > "$scratch/restarted" 2>&1 \
      || fail "no restart: $(cat "$scratch/restarted")"
    expect "what is restarted" "$(instance_at head 'spec.skill')" \
      "$(builds_on head)"
    lines_come hello "after $prefix" "$prefix "
  done
}

test_what_crashes_after_its_folder_was_edited_runs_no_other_build() {
  own_skills head
  skills=$scratch/head.skills start_node head --coordinator --interface lo
  echo_task hello | jq '.pipeline[0].restart = {delay_s: 0.1}' > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  lines_come hello before
  edit_echo "$scratch/head.skills/echo" "edited "
  await head '.event == "skill_added"' > /dev/null
  pkill -KILL -P "$(readlink "$scratch/head/instances/$(instance_at head spec.instance)/pid" \
    | cut -d' ' -f1)" || fail "it does not run"
  await head '.event == "instance_changed"
              and (.data.reason | contains("is not build"))' > /dev/null
  to head restart hello > "$scratch/restarted" 2>&1 \
    || fail "no restart: $(cat "$scratch/restarted")"
  lines_come hello after "edited "
}

test_a_skill_that_is_copied_onto_a_member_is_placed_there_at_once() {
  own_skills head
  mkdir "$scratch/arm.skills"
  start_two
  echo_task there arm > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json"
  expect "code" "$(jq -r .error.code "$scratch/reply.json")" \
    no_feasible_allocation
  # In the node's own folder for skills, which it makes at its start.
  cp -r "$scratch/skills/echo" "$scratch/arm/skills/"
  await head '.event == "skill_added" and .data.node == "arm"' > /dev/null
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  expect "the node" "$(jq -r '.instances[0].node' "$scratch/reply.json")" arm
  lines_come there placed
  rm -r "$scratch/arm/skills/echo"
  await head '.event == "skill_removed" and .data.node == "arm"' > /dev/null
  expect "who has it" "$(builds_on arm)" ""
  lines_come there "still there"
}

# send_hangup NAME: the node reads its file again, and says in $scratch/said what
# came of it.
send_hangup() {
  local since=0
  [[ ! -e $scratch/said ]] || since=$(jq .sequence "$scratch/said")
  kill -HUP "${pid[$1]}"
  await "$1" '.event | startswith("configuration_re")' "$since" > "$scratch/answer"
  mv "$scratch/answer" "$scratch/said"
}

test_sighup_reads_the_file_and_skills_and_a_broken_file_changes_nothing() {
  local conf=$scratch/node.conf
  own_skills head
  mkdir "$scratch/more"
  printf 'label = place=here\n' > "$conf"
  skills=$scratch/head.skills start_node head --coordinator --interface lo \
    --config "$conf"
  echo_task hello here > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  lines_come hello before
  printf 'label = place=there\nlog-bytes = 2MiB\n' > "$conf"
  send_hangup head
  expect "what has changed" "$(jq -c .data "$scratch/said")" \
    '{"changed":["label","log-bytes"],"needs_restart":["log-bytes"]}'
  has_line "needs a restart: log-bytes" "$scratch/head.log" \
    || fail "$(tail -n 3 "$scratch/head.log")"
  echo_task again there > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  printf 'label = place=nowhere\nlabel = nothing\n' > "$conf"
  send_hangup head
  expect "what is refused" "$(jq -r .event "$scratch/said")" configuration_refused
  jq -r .data.reason "$scratch/said" | has_line -F "$conf:2: --label: 'nothing'" \
    || fail "$(cat "$scratch/said")"
  printf 'labels = place=nowhere\n' > "$conf"
  send_hangup head
  jq -r .data.reason "$scratch/said" | has_line -F "$conf:1: there is no option" \
    || fail "$(cat "$scratch/said")"
  expect "its label" "$(get head /v1/node | jq -r .resources.labels.place)" there
  lines_come hello after
  lines_come again after
}

# keep_cores_busy: every core is taken until the test is over.
keep_cores_busy() {
  local i
  for ((i = 0; i < $(nproc); ++i)); do
    (while :; do :; done) &
    echo $! >> "$scratch/pids"
  done
  # A sample of the CPU takes a second; until then it was not busy.
  sleep 2
}

test_a_task_finds_its_share_of_busy_cores_unless_the_floor_is_zero() {
  local folder
  own_skills head
  folder=$scratch/head.skills/echo
  jq '.models[].deployments[].resources.cpu = 0.1' "$folder/skill.json" \
    > "$scratch/skill.json" && mv "$scratch/skill.json" "$folder/skill.json"
  keep_cores_busy
  skills=$scratch/head.skills start_node head --coordinator --interface lo \
    --capacity "cpu=$(nproc)"
  skills=$scratch/head.skills start_node strict --coordinator --cell other \
    --interface lo --cpu-floor 0
  echo_task hello > "$scratch/task.json"
  to strict request "$scratch/task.json" > "$scratch/reply.json"
  expect "code" "$(jq -r .error.code "$scratch/reply.json")" \
    no_feasible_allocation
  jq '.type = "task_plan_query"' "$scratch/task.json" \
    | to head request > "$scratch/plan.json" || fail "$(cat "$scratch/plan.json")"
  expect "the reading" "$(jq .cpu_floor "$scratch/plan.json")" true
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
}

test_a_node_that_was_stopped_for_longer_than_the_watchdog_keeps_its_skills() {
  start_node head --coordinator --interface lo
  echo_task hello > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  kill -STOP "${pid[head]}"
  sleep 12
  kill -CONT "${pid[head]}"
  # Whatever it judges, it judges within its next interval.
  sleep 11
  expect "the instance" \
    "$(get head /v1/instances | jq -r '.instances[0].state')" running
}

# bent_scene: pictures of four tags by a camera whose lens bends, and the
# example that rectifies them, with this test's paths, through the jq program $1.
bent_scene() {
  rm -r "$skills"
  use_skills image_source rectify pose_estimation
  "$ROSCELL_BUILD/bin/render_scenes" --tags 4 --frames 2 --width 640 \
    --height 480 --focal 500 --farthest 1.5 "$scratch/bent" \
    --distortion -0.25 0.08 0.001 -0.0005 0 > "$scratch/rendered"
  mkdir "$scratch/poses"
  jq "$1" docs/examples/07_rectify.json \
    | sed "s#/tmp/ladder#$scratch#" \
    > "$scratch/task.json"
}

# run_bent_scene: all of it, until every tag is where it was rendered.
run_bent_scene() {
  start_node head --coordinator --interface lo
  to head check "$scratch/task.json" > "$scratch/checked" 2>&1 \
    || fail "check refused it: $(cat "$scratch/checked")"
  to head plan "$scratch/task.json" > "$scratch/plan" 2>&1 \
    || fail "no plan: $(cat "$scratch/plan")"
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  "$ROSCELL_BUILD/bin/compare_poses" --wait "$deadline_s" --summary \
    "$scratch/bent/scene_1" "$scratch/poses/rectified.jsonl" \
    > "$scratch/compared" 2>&1 || fail "$(cat "$scratch/compared")"
}

test_pictures_of_a_bent_lens_are_rectified_before_their_tags_are_found() {
  bent_scene .
  run_bent_scene
}

test_a_camera_may_send_its_pictures_compressed() {
  bent_scene 'del(.pipeline[1])
    | (.pipeline[].output[]?, .pipeline[].input[]? | objects
       | select(.data_type == "sensor_msgs/msg/Image"))
      |= {protocol, endpoint: "/bent/image_raw/compressed",
          data_type: "sensor_msgs/msg/CompressedImage"}
    | .pipeline[1].parameters.rectified = false'
  run_bent_scene
}

# run_strategy NUMBER HOSTS: that request of the examples on so many hosts, until the
# tags of all four scenes are where they were rendered.
run_strategy() {
  local name=strategy_$1 n pairs=()
  mkdir -p "$scratch/poses/$name"
  sed "s#/tmp/roscell-#$scratch/#" "docs/examples/strategies/$name.json" \
    | to head request > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  expect "hosts of $name" "$2" \
    "$(jq '[.allocations[].node] | unique | length' "$scratch/reply.json")"
  for n in 1 2 3 4; do
    pairs+=("$scratch/scenes/scene_$n" "$scratch/poses/$name/scene_$n.jsonl")
  done
  "$ROSCELL_BUILD/bin/compare_poses" --wait "$deadline_s" --summary "${pairs[@]}" \
    > "$scratch/compared" 2>&1 || fail "$name: $(cat "$scratch/compared")"
  to head stop "$name" > /dev/null
}

test_each_strategy_of_the_examples_finds_the_tags_of_its_four_scenes() {
  local name
  rm -r "$skills"
  use_skills image_source pose_estimation
  "$ROSCELL_BUILD/bin/render_scenes" --tags 1 1 1 1 --frames 2 --width 320 \
    --height 240 --focal 266 --farthest 1.2 "$scratch/scenes" > "$scratch/rendered"
  start_node head --coordinator --cell line --interface lo
  for name in one two three four; do
    start_node "$name" --interface lo --join "$(discovery_of head)" \
      --label "host=$name"
    await_joined head "$name"
  done
  run_strategy 1 1
  run_strategy 2 1
  run_strategy 3 4
}

# camera_task PARAMETERS: a camera that shows photos without a calibration file.
camera_task() {
  jq -n --arg photos "$PWD/test/data/apriltag_photos" --argjson how "$1" '
    def ros2($topic; $type):
      {protocol: "ros2", endpoint: "/cam/\($topic)",
       data_type: "sensor_msgs/msg/\($type)"};
    {type: "task_request", task: "cam", pipeline: [
      {id: "camera", operation: "image_source", model: "folder",
       parameters: $how,
       input: {protocol: "file", endpoint: $photos, data_type: "image/jpeg"},
       output: [ros2("image"; "Image"), ros2("camera_info"; "CameraInfo")]}]}'
}

# camera_is VERDICT TEXT: what the doctor finds of it.
camera_is() {
  "$ROSCELL" doctor --only cameras -o json --to "$scratch/head/node.sock" \
    --data-dir "$scratch/head" > "$scratch/found" 2>&1
  # Whether its pictures find room is the kernel's matter.
  expect "of the camera" "$(jq -r '.[] | .verdict + " " + .seen
    | select(contains("camera_info"))' "$scratch/found")" "$1 /cam/camera_info $2"
}

test_doctor_tells_of_a_camera_that_is_not_calibrated() {
  rm -r "$skills"
  use_skills image_source
  start_node head --coordinator --interface lo
  camera_task '{}' | to head request > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  camera_is warning "is all zero: its camera is not calibrated"
  # Who reads it cannot measure in its pictures.
  mkfifo "$scratch/heard"
  "$ROSCELL" echo /cam/camera_info --to "$scratch/head/node.sock" \
    > "$scratch/heard" &
  echo $! >> "$scratch/pids"
  read -r _ < "$scratch/heard"
  camera_is broken "is all zero: its camera is not calibrated"
  kill $!
  to head stop cam > /dev/null
  camera_task '{"fx": 600, "fy": 600, "cx": 320, "cy": 240}' \
    | to head request > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  camera_is ok "tells a calibration"
}

test_an_installed_node_finds_its_shim() {
  cmake --install "$ROSCELL_BUILD" --prefix "$scratch/usr" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  ask_no_cpu "$scratch/usr/lib/roscell/skills/echo"
  ROSCELL=$scratch/usr/bin/roscell
  start_node head --coordinator --interface lo
  echo_task hello > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
}
