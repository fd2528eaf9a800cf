# What somebody does with a task from the command line: check, run, heal,
# restart, stop; and steps that hang together by what they read and write.

start_alone() {
  start_node head --coordinator --cell line --interface lo --cpu-floor 1
}

# Two steps, one reading the file that the other writes, in short forms.
chain_task() {
  mkdir -p "$scratch/data"
  touch "$scratch/data/in.txt"
  cat << EOF
task: chain
pipeline:
  - {id: one, operation: echo, model: plain, parameters: {prefix: "1 "},
     input: $scratch/data/in.txt, output: $scratch/data/between.txt}
  - {id: two, operation: echo, model: plain, parameters: {prefix: "2 "},
     restart: {policy: never},
     input: {from: one}, output: $scratch/data/out.txt}
EOF
}

# await_line FILE TEXT: waits until a line of the file is that.
await_line() {
  local line
  while read -r -t "$deadline_s" line; do
    [[ $line != "$2" ]] || return 0
  done < <(exec tail --pid=$$ -n +1 -F "$1" 2> /dev/null)
  fail "no line '$2' in $1"
}

# instance_of TASK STEP
instance_of() {
  get head "/v1/tasks/$1" \
    | jq -r --arg step "$2" '.tasks[0].instances[]
        | select(.spec.step == $step) | .spec.instance'
}

test_a_task_in_short_forms_is_checked_run_and_stopped() {
  start_alone
  chain_task > "$scratch/chain.yaml"
  to head check "$scratch/chain.yaml" > "$scratch/written.json" 2> /dev/null \
    || fail "check refused the task"
  expect "written out" \
    "$(jq -r '.pipeline[1].input.endpoint' "$scratch/written.json")" \
    "$scratch/data/between.txt"
  to head run "$scratch/chain.yaml" > "$scratch/out" || fail "run refused it"
  grep -q 'task chain runs' "$scratch/out" || fail "run says: $(cat "$scratch/out")"
  echo hello >> "$scratch/data/in.txt"
  await_line "$scratch/data/out.txt" '2 1 hello'
  to head stop chain | has_line 'chain is gone, with 2 instances' \
    || fail "stop does not say so"
  expect "tasks" "$(get head /v1/tasks | jq '.tasks | length')" 0
}

test_steps_that_share_a_file_run_on_one_node() {
  start_alone
  start_node arm --join "$(discovery_of head)" --interface lo --cpu-floor 1
  await_joined head arm
  chain_task > "$scratch/chain.yaml"
  to head run "$scratch/chain.yaml" -o json > "$scratch/reply.json" \
    || fail "run refused it"
  expect "nodes" "$(jq -r '[.instances[].node] | unique | length' \
    "$scratch/reply.json")" 1
}

test_a_failed_step_is_healed_by_the_same_request() {
  start_alone
  chain_task > "$scratch/chain.yaml"
  to head run "$scratch/chain.yaml" > /dev/null || fail "run refused it"
  local old
  old=$(instance_of chain two)
  pkill -KILL -P "$(readlink "$scratch/head/instances/$old/pid" | cut -d' ' -f1)"
  await head ".event == \"instance_changed\" and .subject == \"$old\"
              and .data.state == \"failed\"" > /dev/null
  to head run "$scratch/chain.yaml" > "$scratch/out" || fail "it was not healed"
  grep -q 'started again: two' "$scratch/out" || fail "healing is not told"
  expect "state" "$(get head /v1/tasks/chain | jq -r '.tasks[0].state')" running
  [[ $(instance_of chain two) != "$old" ]] || fail "it is the old instance"
}

test_an_instance_is_restarted_and_the_others_stay() {
  start_alone
  chain_task > "$scratch/chain.yaml"
  to head run "$scratch/chain.yaml" > /dev/null || fail "run refused it"
  local one two
  one=$(instance_of chain one) two=$(instance_of chain two)
  to head restart "$two" > /dev/null || fail "restart was refused"
  expect "the other one" "$(instance_of chain one)" "$one"
  [[ $(instance_of chain two) != "$two" ]] || fail "it is the old instance"
  to head restart chain > /dev/null || fail "restart of the task was refused"
  [[ $(instance_of chain one) != "$one" ]] || fail "one was not restarted"
  echo again >> "$scratch/data/in.txt"
  await_line "$scratch/data/out.txt" '2 1 again'
}

# mistake WHAT JQ EXPECTED: changes the task and looks for words on stderr.
mistake() {
  jq "$2" "$scratch/task.json" > "$scratch/wrong.json"
  to head run "$scratch/wrong.json" > "$scratch/out" 2> "$scratch/stderr"
  expect "exit code: $1" $? 1
  grep -qF "$3" "$scratch/stderr" \
    || fail "$1: '$3' is not in: $(cat "$scratch/stderr")"
  to head check "$scratch/wrong.json" > "$scratch/out" 2> "$scratch/stderr"
  expect "exit code of check: $1" $? 1
  grep -qF "$3" "$scratch/stderr" \
    || fail "check: $1: '$3' is not in: $(cat "$scratch/stderr")"
}

test_mistakes_are_shown_where_they_are() {
  start_alone
  echo_task a > "$scratch/task.json"
  mistake "a misspelt member" '.pipeline[0].parameter = {}' \
    'there is no member "parameter" here; did you mean "parameters"?'
  mistake "a foreign word" '.steps = .pipeline' 'did you mean "pipeline"?'
  mistake "a misspelt parameter" '.pipeline[0].parameters = {prefx: "x"}' \
    'there is no parameter "prefx"; did you mean "prefix"?'
  mistake "a parameter of the wrong type" '.pipeline[0].parameters = {prefix: 7}' \
    'expected a text, got the number 7'
  mistake "a number out of range" '.pipeline[0].parameters = {queue_length: 0}' \
    'expected an integer from 1 to 65536'
  mistake "an unknown step" '.pipeline[0].input = {from: "ecko"}' \
    'there is no step "ecko"'
  mistake "one output of two steps" \
    '.pipeline += [.pipeline[0] + {id: "again"}]' 'is written by step "say"'
  mistake "an unknown operation" '.pipeline[0].operation = "sing"' \
    "no skill of this cell does 'sing'"
  grep -q '\^~*$' "$scratch/stderr" || fail "no mark is under the place"
  expect "tasks" "$(get head /v1/tasks | jq '.tasks | length')" 0
}

test_why_a_task_is_where_it_is_and_how_it_came_there_is_told_afterwards() {
  local text
  start_alone
  start_node arm --join "$(discovery_of head)" --interface lo --cpu-floor 1
  await_joined head arm
  chain_task > "$scratch/chain.yaml"
  to head run "$scratch/chain.yaml" > /dev/null 2>&1 || fail "run refused it"
  text=$(to arm why chain)
  has_line 'was placed so' <<< "$text" || fail "$text"
  has_line 'balance' <<< "$text" || fail "$text"
  text=$(to head trace chain)
  has_line "task_request 'chain'.*done after" <<< "$text" || fail "$text"
  has_line 'deploy' <<< "$text" || fail "$text"
  has_line 'member *\(arm\|head\)\|node-agent *\(arm\|head\)' <<< "$text" || fail "$text"
  text=$(to head inspect cell-coordinator)
  has_line 'cell-coordinator [0-9]*: [0-9]* messages' <<< "$text" || fail "$text"
  expect "its state" \
    "$(get head /v1/actors/cell-coordinator | jq -r '.actors[0].state | type')" object
  to arm inspect cell-coordinator 2> "$scratch/err" && fail "a member has a coordinator"
  has_line "no actor 'cell-coordinator'" < "$scratch/err" || fail "$(cat "$scratch/err")"
  to head stop chain > /dev/null
  text=$(to head trace chain)
  has_line 'task_termination' <<< "$text" || fail "$text"
  expect "its requests" \
    "$(get head /v1/tasks/chain/trace | jq -c '[.requests[].request]')" \
    '["task_request","task_termination"]'
  sed 's/^task: chain/task: moon/; s/id: one,/id: one, labels: {place: moon},/' \
    "$scratch/chain.yaml" > "$scratch/moon.yaml"
  to head run "$scratch/moon.yaml" > /dev/null 2>&1 && fail "moon was not refused"
  text=$(to arm why moon 2>&1)
  has_line 'was refused' <<< "$text" || fail "$text"
  has_line 'no_feasible_allocation' <<< "$text" || fail "$text"
  to head why nobody 2> "$scratch/err" && fail "nobody was explained"
  has_line 'no decision about a task' < "$scratch/err" || fail "$(cat "$scratch/err")"
}

test_a_topic_that_nobody_writes_is_refused_unless_it_is_external() {
  cp -r "$ROSCELL_BUILD/skills/pose_estimation" "$skills"
  ask_no_cpu "$skills/pose_estimation"
  start_alone
  cat > "$scratch/poses.yaml" << EOF
task: poses
pipeline:
  - {id: poses, operation: pose_estimation, model: apriltag3,
     input: [/cam/image, /cam/camera_info], output: $scratch/poses.jsonl}
EOF
  to head run "$scratch/poses.yaml" 2> "$scratch/stderr"
  expect "exit code" $? 1
  grep -q 'nobody in this cell writes the topic "/cam/image"' \
    "$scratch/stderr" || fail "it says: $(cat "$scratch/stderr")"
  sed -i 's|model: apriltag3,|model: apriltag3, external: true,|' \
    "$scratch/poses.yaml"
  to head run "$scratch/poses.yaml" > /dev/null 2> "$scratch/stderr" \
    || fail "external was refused"
  grep -q 'nobody writes the external topic "/cam/image" yet' "$scratch/stderr" \
    || fail "it is not said: $(cat "$scratch/stderr")"
}

test_a_device_of_an_endpoint_must_be_there() {
  start_alone
  echo_task a | jq '.pipeline[0].input.endpoint = "/dev/lidar7"' \
    > "$scratch/task.json"
  to head run "$scratch/task.json" 2> "$scratch/stderr"
  expect "exit code" $? 1
  grep -q "needs the device '/dev/lidar7'" "$scratch/stderr" \
    || fail "it says: $(cat "$scratch/stderr")"
}

# greeting_file: a task of each node by a variable.
greeting_file() {
  mkdir -p "$scratch/data"
  echo one > "$scratch/data/in.txt"
  cat << EOF
type: task_request
variables: {robot: null, greeting: hello, follow: true}
task: greet-\${robot}
pipeline:
  - {id: say, operation: echo, model: plain, labels: {node: "\${robot}"},
     parameters: {prefix: "\${greeting}, \${robot}: ", follow: "\${follow}"},
     input: $scratch/data/in.txt, output: "$scratch/data/\${robot}.txt"}
EOF
}

test_one_file_serves_each_node_by_its_variables() {
  start_alone
  start_node arm --join "$(discovery_of head)" --interface lo --cpu-floor 1
  await_joined head arm
  greeting_file > "$scratch/greet.yaml"
  to head run "$scratch/greet.yaml" > "$scratch/out" 2>&1 && fail "it has no robot"
  has_line ':2:13: the variable "robot" has no value' "$scratch/out" \
    || fail "it says: $(cat "$scratch/out")"
  to head run --set robot=arm --set follow=no "$scratch/greet.yaml" \
    > "$scratch/out" 2>&1 && fail "'no' is neither true nor false"
  has_line '"follow" is true or false' "$scratch/out" || fail "$(cat "$scratch/out")"
  expect "tasks" "$(get head /v1/tasks | jq '.tasks | length')" 0
  to head run --set robot=arm "$scratch/greet.yaml" > "$scratch/out" \
    || fail "run refused it"
  echo 'robot: head' > "$scratch/head.yaml"
  to head request --values "$scratch/head.yaml" --set greeting=moin \
    "$scratch/greet.yaml" > "$scratch/out" || fail "$(cat "$scratch/out")"
  await_line "$scratch/data/arm.txt" 'hello, arm: one'
  await_line "$scratch/data/head.txt" 'moin, head: one'
  to head plan --set robot=arm "$scratch/greet.yaml" -o json > "$scratch/out" \
    || fail "$(cat "$scratch/out")"
  expect "the node" "$(jq -r '.allocations[0].node' "$scratch/out")" arm
}

test_a_pattern_ends_the_tasks_of_such_names_and_no_others() {
  local name
  start_alone
  greeting_file > "$scratch/greet.yaml"
  for name in one two; do
    sed "s/greet-.*/greet-$name/" "$scratch/greet.yaml" > "$scratch/$name.yaml"
    to head run --set robot=head "$scratch/$name.yaml" > "$scratch/out" \
      || fail "run refused it"
  done
  chain_task > "$scratch/chain.yaml"
  to head run "$scratch/chain.yaml" > "$scratch/out" || fail "run refused it"
  to head stop 'x*' > "$scratch/out" 2>&1 && fail "nothing is named so"
  # Who sits at a terminal is asked.
  for name in n ''; do
    echo "$name" | script -qec "$ROSCELL stop 'greet-*' --to $scratch/head/node.sock" \
      /dev/null > "$scratch/out" && fail "ended all the same: $(cat "$scratch/out")"
    has_line 'end them?' "$scratch/out" || fail "nobody is asked: $(cat "$scratch/out")"
  done
  expect "tasks" "$(get head /v1/tasks | jq '.tasks | length')" 3
  to head stop 'greet-*' > "$scratch/out" 2> "$scratch/notes" < /dev/null \
    || fail "$(cat "$scratch/notes")"
  has_line 'these tasks are ended: greet-one, greet-two' "$scratch/notes" \
    || fail "it does not say which: $(cat "$scratch/notes")"
  expect "tasks" "$(get head /v1/tasks | jq -c '[.tasks[].task]')" '["chain"]'
  # What is gone already is answered as it was then.
  to head stop greet-one chain -o json > "$scratch/out" || fail "$(cat "$scratch/out")"
  expect "instances of both" "$(jq -c '[.[].instances | length]' "$scratch/out")" \
    '[1,2]'
  expect "tasks" "$(get head /v1/tasks | jq '.tasks | length')" 0
}

test_a_task_whose_time_is_over_is_ended_and_runs_once_more() {
  local row reason='timeout_s of 3 is over'
  start_alone
  { chain_task; echo 'timeout_s: 3'; } > "$scratch/chain.yaml"
  echo hello >> "$scratch/data/in.txt"
  to head run --wait-finished "$scratch/chain.yaml" > "$scratch/out" 2>&1
  expect "exit code" $? 1
  has_line "$reason" "$scratch/out" || fail "it says: $(cat "$scratch/out")"
  has_line -x '2 1 hello' "$scratch/data/out.txt" || fail "no frame came"
  expect "what runs" "$(get head /v1/instances \
    | jq -c '[.instances[] | select(.state != "failed")]')" '[]'
  # The coordinator is killed while the time of the next run is running out.
  to head run "$scratch/chain.yaml" > "$scratch/out" || fail "$(cat "$scratch/out")"
  await_line "$scratch/data/out.txt" '2 1 hello'
  stop_node head KILL
  start_alone
  [[ $(get head /v1/tasks/chain | jq -r '.tasks[0].state') == failed ]] \
    || await head '.event == "task_failed" and .subject == "chain"' > /dev/null
  row=$(get head /v1/tasks/chain | jq -c '.tasks[0]')
  expect "its state" "$(jq -r .state <<< "$row")" failed
  has_line "$reason" <<< "$row" || fail "it says: $row"
  expect "who follows the file" "$(pgrep -cf "$scratch/data/in.txt")" 0
  # Started again it has its whole time, and its frames come.
  to head restart chain > "$scratch/out" || fail "$(cat "$scratch/out")"
  echo again >> "$scratch/data/in.txt"
  await_line "$scratch/data/out.txt" '2 1 again'
}
