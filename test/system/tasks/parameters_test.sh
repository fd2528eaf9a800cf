# Parameters that are changed while a skill runs: what comes out changes, no frame is
# lost or doubled, the program is the same, and what is started again has them.

. test/system/scenes/pick.sh

start_alone() {
  use_skills
  start_node head --coordinator --cell line --interface lo --cpu-floor 1
}

# start_line: the task runs on the member.
start_line() {
  use_skills
  start_node head --coordinator --cell line --interface lo --cpu-floor 1
  start_arm
  await_joined head arm
}

start_arm() {
  start_node arm --join "$(discovery_of head)" --interface lo --cpu-floor 1 \
    --label place=arm
}

# run_say [PLACE]: task "say" puts "a " before the lines that it is given.
run_say() {
  mkdir -p "$scratch/data"
  touch "$scratch/data/in.txt"
  cat > "$scratch/say.yaml" << EOF
task: say
update: {healthy_for_s: 1}
pipeline:
  - {id: one, operation: echo, model: plain, parameters: {prefix: "a "},
     ${1:+labels: {place: $1\},}
     restart: {policy: always, delay_s: 0.1},
     input: $scratch/data/in.txt, output: $scratch/data/out.txt}
EOF
  to head run "$scratch/say.yaml" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
}

# of_step TASK STEP JQ: what is known of its instance.
of_step() {
  get head "/v1/instances" | jq -r --arg task "$1" --arg step "$2" ".instances[]
    | select(.spec.task == \$task and .spec.step == \$step) | $3"
}

of_say() {
  of_step say one "$1"
}

# line_comes WORD LINE: what is given comes out as that line, once.
line_comes() {
  echo "$1" >> "$scratch/data/in.txt"
  timeout "$deadline_s" grep -m 1 -x "$2" > "$scratch/matches" \
    < <(exec tail --pid=$$ -n +1 -F "$scratch/data/out.txt" 2> /dev/null) \
    || fail "no '$2': $(tail -n 3 "$scratch/data/out.txt")"
  expect "lines '$2'" "$(grep -cx "$2" "$scratch/data/out.txt")" 1
}

# set_of INSTANCE KEY=VALUE...: by any node; what it says is in $scratch/out.
set_of() {
  to "${by:-head}" set "$@" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
}

test_parameters_change_under_load_and_no_frame_is_lost_or_doubled() {
  local count=3000 program i
  start_alone
  run_say
  line_comes first "a first"
  program=$(of_say .figures.use.pid)
  # One writer, who keeps the file open: an end of line that is not there yet when
  # another one closes it is none.
  (for ((i = 1; i <= count; ++i)); do
    echo "line $i"
    ((i % 10)) || sleep 0.01
  done) >> "$scratch/data/in.txt" &
  for i in b c d e f; do
    sleep 0.3
    set_of say/one "prefix=$i "
    expect "what it says" "$(cat "$scratch/out")" \
      "prefix: \"$(printf %b "\\x$(printf %x $(($(printf %d "'$i") - 1)))") \" -> \"$i \""
  done
  wait $!
  line_comes last "f last"
  sed -n 's/^. line //p' "$scratch/data/out.txt" > "$scratch/numbers"
  seq "$count" | cmp - "$scratch/numbers" || fail "lines are lost or doubled"
  # Each prefix was in force for a while, one after the other.
  expect "the prefixes" \
    "$(grep ' line ' "$scratch/data/out.txt" | cut -c 1 | uniq | tr -d '\n')" abcdef
  expect "the program" "$(of_say .figures.use.pid)" "$program"
  expect "revision" "$(get head /v1/tasks/say | jq '.tasks[0].revision // 1')" 1
}

test_a_program_that_is_killed_comes_back_with_what_was_set() {
  local program since
  start_line
  run_say arm
  line_comes first "a first"
  program=$(of_say .figures.use.pid)
  by=arm set_of say/one "prefix=b "
  line_comes second "b second"
  kill -KILL "$program"
  await head '.event == "instance_changed" and .data.state == "running"
    and .data.restarts == 1' > /dev/null
  line_comes third "b third"
  # So does one whose node was killed before it.
  program=$(of_say .figures.use.pid)
  stop_node arm KILL
  start_arm
  await arm '.event == "instance_adopted"' > /dev/null
  await_joined head arm
  line_comes fourth "b fourth"
  since=$("$ROSCELL" events --to "$scratch/head/node.sock" --since 0 --no-follow \
    -o json | tail -n 1 | jq .sequence)
  kill -KILL "$program"
  await head '.event == "instance_changed" and .data.state == "running"
    and .data.restarts == 1' "$since" > /dev/null
  line_comes fifth "b fifth"
  # And what is started anew.
  to head restart say > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  line_comes sixth "b sixth"
}

test_a_coordinator_that_is_killed_knows_what_was_set() {
  local program
  start_line
  run_say arm
  line_comes first "a first"
  program=$(of_say .figures.use.pid)
  set_of say/one "prefix=b "
  stop_node head KILL
  start_node head --coordinator --cell line --interface lo --cpu-floor 1
  await_joined head arm
  line_comes second "b second"
  expect "the program" "$(of_say .figures.use.pid)" "$program"
  expect "what the task says" "$(of_say .spec.parameters.prefix)" "b "
  # What the file says is another thing, and is shown and put back.
  to head apply --dry-run "$scratch/say.yaml" > "$scratch/out" 2>&1
  expect "exit code of what differs" $? 1
  has_line 'parameters.prefix: b  -> a' < "$scratch/out" || fail "$(cat "$scratch/out")"
  to head apply "$scratch/say.yaml" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  line_comes third "a third"
}

test_what_cannot_be_set_says_why_and_changes_nothing() {
  start_alone
  run_say
  line_comes first "a first"
  to head set say/one > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  has_line '^prefix *"a " *a text' < "$scratch/out" || fail "$(cat "$scratch/out")"
  local pair code words
  while IFS='|' read -r pair code words; do
    to head set say/one "$pair" > "$scratch/out" 2>&1
    expect "exit code of '$pair'" $? "$code"
    has_line "$words" < "$scratch/out" || fail "$pair: $(cat "$scratch/out")"
  done << EOF
prefx=b|1|did you mean "prefix"
queue_length=9|1|cannot be changed while the skill runs; what can is prefix
prefix|2|is no KEY=VALUE
prefix=$(head -c 62000 /dev/zero | tr '\0' x)|1|longer than a program can be told while it runs
EOF
  to head set nobody/one prefix=b > "$scratch/out" 2>&1
  expect "exit code for nobody" $? 1
  line_comes second "a second"
  # What hangs is not waited for, and has its former parameters when it goes on.
  local program
  program=$(of_say .figures.use.pid)
  kill -STOP "$program"
  to head set say/one "prefix=b " > "$scratch/out" 2>&1
  expect "exit code of what hangs" $? 1
  has_line 'has not answered for 5 s' < "$scratch/out" || fail "$(cat "$scratch/out")"
  kill -CONT "$program"
  timeout "$deadline_s" grep -m 1 'works with these parameters: {"prefix":"a "}' \
    > "$scratch/matches" \
    < <(to head logs --follow say) \
    || fail "it was not put back"
  line_comes third "a third"
}

test_poses_are_looked_for_otherwise_and_no_picture_is_lost() {
  local program witness
  use_skills_of_camera
  start_alone
  make_scenes
  pick_task 2 > "$scratch/pick.json"
  to head run "$scratch/pick.json" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  more_lines "$scratch/poses" 5
  program=$(of_step pick pose .figures.use.pid)
  set_of pick/pose decimation=3 refine=false
  more_lines "$scratch/poses" 5
  set_of pick/pose decimation=1.5
  # For as long as a skill takes to say what it has dropped.
  more_lines "$scratch/poses" 60
  more_lines "$scratch/seen" 1
  expect "the program" "$(of_step pick pose .figures.use.pid)" "$program"
  expect "pictures that were dropped" "$(of_step pick pose .figures.dropped)" 0
  # Every picture that the witness has seen is one line, from the first of these on.
  to head stop pick > /dev/null || fail "stop was refused"
  local name
  for name in poses seen; do
    jq -r .stamp "$scratch/$name" | sort -n > "$scratch/$name.stamps"
    expect "doubled pictures of $name" "$(uniq -d "$scratch/$name.stamps" | wc -l)" 0
    awk 'NR > 1 && $1 - last > 0.19 { print last, $1 } { last = $1 }' \
      "$scratch/$name.stamps" > "$scratch/gaps"
    expect "gaps between pictures of $name" "$(cat "$scratch/gaps")" ""
  done
  # They are not the same poses: other pixels were looked at.
  jq -c '[.stamp, [.tags[]? | .corners_px]]' "$scratch/poses" | sort > "$scratch/a"
  jq -c '[.stamp, [.tags[]? | .corners_px]]' "$scratch/seen" | sort > "$scratch/b"
  [[ $(comm -23 "$scratch/a" "$scratch/b" | wc -l) -ge 5 ]] || fail "nothing differs"
}

# set_by_ros2 NAME VALUE: as `ros2 param set` would, from the cell's own network. What
# the service answers is in $scratch/said.
set_by_ros2() {
  (
    eval "$(to head env)"
    exec "$ROSCELL_BUILD/bin/parameter_client" \
      "$(of_step pick pose .spec.instance | tr - _)" "$@"
  ) > "$scratch/said" 2>> "$scratch/client.log"
}

test_ros2_sets_parameters_where_the_cell_lets_it_and_the_task_knows_them() {
  local program
  use_skills_of_camera
  start_node head --coordinator --cell line --interface lo --cpu-floor 1 \
    --ros2-set-parameters
  has_line 'warning whoever is in the network .* may set parameters' \
    < "$scratch/head.log" || fail "no warning: $(cat "$scratch/head.log")"
  make_scenes
  pick_task 2 > "$scratch/pick.json"
  to head run "$scratch/pick.json" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  more_lines "$scratch/poses" 5
  program=$(of_step pick pose .figures.use.pid)
  set_by_ros2 decimation 3 || fail "$(cat "$scratch/said" "$scratch/client.log")"
  expect "what the task says" "$(of_step pick pose .spec.parameters.decimation)" 3
  await head '.event == "request_received" and .data.request == "parameter_change"
    and (.data.from | test("a client of ROS 2"))' > /dev/null
  await head '.event == "parameters_changed" and .data.parameters.decimation == 3' \
    > /dev/null
  more_lines "$scratch/poses" 5
  while IFS='|' read -r name value words; do
    ! set_by_ros2 "$name" "$value" || fail "$name=$value was set"
    has_line "$words" < "$scratch/said" || fail "$name: $(cat "$scratch/said")"
  done << EOF
decimation|99|failed: .* a number from 1 to 16
queue_length|9|failed: it cannot be changed while the skill runs
decimashun|3|failed: there is no such parameter
EOF
  # The program that is killed comes back with what was set, and its file shows it.
  kill -KILL "$program"
  more_lines "$scratch/poses" 5
  expect "after its death" "$(of_step pick pose .spec.parameters.decimation)" 3
  to head apply --dry-run "$scratch/pick.json" > "$scratch/out" 2>&1
  has_line 'parameters.decimation: 3 -> 2' < "$scratch/out" || fail "$(cat "$scratch/out")"
  # Nothing of it is let in once the coordinator says so.
  stop_node head
  start_node head --coordinator --cell line --interface lo --cpu-floor 1
  to head restart pick > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  more_lines "$scratch/poses" 5
  ! set_by_ros2 decimation 4 || fail "it was set"
  has_line 'failed: not allowed by DDS, which proves nobody' < "$scratch/said" \
    || fail "$(cat "$scratch/said")"
  expect "in the end" "$(of_step pick pose .spec.parameters.decimation)" 3
}
