# Sets of tasks: one task for each node of a kind, from one file. Lines are counted at
# the far end of each.

start_head() {
  start_node head --coordinator --cell line --interface lo --cpu-floor 1
}

# start_robot NAME [LABEL]: of the kind robot, unless it is said otherwise.
start_robot() {
  start_node "$1" --join "$(discovery_of head)" --interface lo --cpu-floor 1 \
    --label "${2:-kind=robot}"
  await_joined head "$1"
}

# patrol PREFIX: a set whose tasks follow a file each, and put a word before its
# lines.
patrol() {
  mkdir -p "$scratch/data"
  cat << YAML
task: patrol
variables: {word: "$1"}
for_each: {node: {labels: {kind: robot}}}
update: {healthy_for_s: 1}
pipeline:
  - {id: say, operation: echo, model: plain, parameters: {prefix: "\${word} \${node} "},
     restart: {policy: never},
     input: "$scratch/data/\${node}.in", output: "${2:-$scratch/data}/\${node}.out"}
YAML
}

# apply_patrol CODE PREFIX: what it says is in $scratch/out.
apply_patrol() {
  patrol "${@:2}" > "$scratch/patrol.yaml"
  to head apply "$scratch/patrol.yaml" > "$scratch/out" 2>&1
  [[ $? -eq $1 ]] || fail "apply says: $(cat "$scratch/out")"
}

have_inputs() {
  local name
  mkdir -p "$scratch/data"
  for name in "$@"; do
    touch "$scratch/data/$name.in"
  done
}

runs_on() {
  get head /v1/tasks/patrol | jq -r '.sets[0] | "\(.running) of \(.nodes)"'
}

# await_running COUNT [SINCE]: until the set runs on so many nodes.
await_running() {
  await head ".event == \"set_changed\" and .data.running == $1 and .data.pending == 0" \
    "${2:-0}" > /dev/null
}

newest_event() {
  "$ROSCELL" events --to "$scratch/head/node.sock" --since 0 --no-follow -o json \
    | tail -n 1 | jq .sequence
}

test_robots_get_a_task_each_from_one_file() {
  local name
  start_head
  start_robot r1
  start_robot r2
  start_robot desk kind=desk
  have_inputs r1 r2 r3
  patrol a > "$scratch/patrol.yaml"
  to head apply --dry-run "$scratch/patrol.yaml" > "$scratch/out" 2>&1
  expect "exit code of what differs" $? 1
  has_line 'patrol *r1 *patrol-r1 *starts' < "$scratch/out" || fail "$(cat "$scratch/out")"
  apply_patrol 0 a
  for name in r1 r2; do
    lines_come "$name" first "a $name "
  done
  expect "set" "$(runs_on)" "2 of 2"
  to head tasks | has_line 'patrol *kind=robot *2 of 2' || fail "$(to head tasks)"
  # One that comes later gets its task, too.
  start_robot r3
  await_running 3
  for name in r1 r2 r3; do
    lines_come "$name" second "a $name "
  done
  expect "lines of r1" "$(wc -l < "$scratch/data/r1.out")" 10
  # The same again changes nothing.
  apply_patrol 0 a
  has_line "is as it is to be" < "$scratch/out" || fail "$(cat "$scratch/out")"
  to head stop patrol > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  expect "what is left" "$(get head /v1/tasks | jq -c '[.tasks, .sets // []]')" '[[],[]]'
}

test_a_robot_that_loses_its_label_loses_its_task() {
  local since
  start_head
  echo 'label = kind=robot' > "$scratch/r1.conf"
  start_node r1 --join "$(discovery_of head)" --interface lo --cpu-floor 1 \
    --config "$scratch/r1.conf"
  await_joined head r1
  have_inputs r1
  apply_patrol 0 a
  lines_come r1 first "a r1 "
  echo 'label = kind=desk' > "$scratch/r1.conf"
  since=$(newest_event)
  kill -HUP "${pid[r1]}"
  await head '.event == "task_terminated" and .subject == "patrol-r1"' "$since" > /dev/null
  expect "set without robots" "$(runs_on)" "0 of 0"
  echo 'label = kind=robot' > "$scratch/r1.conf"
  since=$(newest_event)
  kill -HUP "${pid[r1]}"
  await_running 1 "$since"
  lines_come r1 second "a r1 "
  expect "set" "$(runs_on)" "1 of 1"
}

test_a_change_of_a_set_that_is_put_back_goes_no_further() {
  local one two
  start_head
  start_robot r1
  start_robot r2
  have_inputs r1 r2
  apply_patrol 0 a
  lines_come r1 first "a r1 "
  two=$(get head /v1/tasks/patrol-r2 | jq -r '.tasks[0].instances[0].spec.instance')
  apply_patrol 1 b /proc/no/such/place
  has_line "r1: its change was put back" < "$scratch/out" || fail "$(cat "$scratch/out")"
  expect "the other robot's instance" \
    "$(get head /v1/tasks/patrol-r2 | jq -r '.tasks[0].instances[0].spec.instance')" "$two"
  lines_come r1 second "a r1 "
  lines_come r2 second "a r2 "
  # The next request is taken up by both, one after the other.
  apply_patrol 0 c
  lines_come r1 third "c r1 "
  lines_come r2 third "c r2 "
}

test_a_coordinator_killed_while_a_set_starts_goes_on() {
  local since
  start_head
  start_robot r1
  start_robot r2
  have_inputs r1 r2
  patrol a > "$scratch/patrol.yaml"
  to head apply --no-wait "$scratch/patrol.yaml" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  stop_node head KILL
  start_head
  await_running 2
  lines_come r1 first "a r1 "
  lines_come r2 first "a r2 "
  # A robot that dies is as any node: its task goes on when it is back.
  stop_node r2 KILL
  await head '.event == "node_lost" and .subject == "r2"' > /dev/null
  expect "set" "$(runs_on)" "1 of 2"
  since=$(newest_event)
  start_node r2 --join "$(discovery_of head)" --interface lo --cpu-floor 1 \
    --label kind=robot
  await_running 2 "$since"
  lines_come r2 second "a r2 "
  lines_come r1 second "a r1 "
}

test_a_set_goes_along_with_its_cell() {
  start_head
  start_robot r1
  have_inputs r1
  apply_patrol 0 a
  "$ROSCELL" cell export --to "$scratch/head/node.sock" "$scratch/line.json" \
    > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  expect "its tasks" "$(jq -c '[.tasks[] | [.task, .for_each.node.labels.kind]]' \
    "$scratch/line.json")" '[["patrol","robot"]]'
  to head stop patrol > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  "$ROSCELL" cell apply --to "$scratch/head/node.sock" "$scratch/line.json" \
    > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  lines_come r1 first "a r1 "
  "$ROSCELL" cell diff --to "$scratch/head/node.sock" "$scratch/line.json" \
    > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
}

test_each_copy_of_a_step_has_its_own_stream() {
  local n
  start_head
  have_inputs c1 c2 c3
  cat > "$scratch/copies.yaml" << YAML
task: lines
pipeline:
  - {id: say, operation: echo, model: plain, copies: 3, parameters: {prefix: "\${copy} "},
     input: "$scratch/data/c\${copy}.in", output: "$scratch/data/c\${copy}.out"}
YAML
  to head run "$scratch/copies.yaml" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  for n in 1 2 3; do
    lines_come "c$n" first "$n "
  done
  sed -i 's/copies: 3/copies: 2/' "$scratch/copies.yaml"
  to head apply "$scratch/copies.yaml" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  for n in 1 2; do
    lines_come "c$n" second "$n "
  done
  expect "steps" "$(get head /v1/tasks/lines \
    | jq -c '[.tasks[0].instances[].spec.step] | sort')" '["say-1","say-2"]'
  # All copies at one output are refused, at their place in the file.
  sed -i 's|/c${copy}.out|/all.out|' "$scratch/copies.yaml"
  to head apply "$scratch/copies.yaml" > "$scratch/out" 2>&1 && fail "it was taken"
  has_line "all 2 copies of step 'say' would write" < "$scratch/out" \
    || fail "$(cat "$scratch/out")"
}
