# Tasks that change while they run: what differs is replaced, what does not goes on,
# and what does not run well is put back. Lines and frames are counted at the far
# end.

. test/system/scenes/pick.sh

start_alone() {
  start_node head --coordinator --cell line --interface lo --cpu-floor 1
}

# chain FIRST SECOND [OUTPUT]: two steps, one reading the file that the other
# writes, each with a word that it puts before its lines. A change settles in two
# seconds.
chain() {
  mkdir -p "$scratch/data"
  touch "$scratch/data/in.txt"
  cat << EOF
task: chain
update: {healthy_for_s: ${settling_s:-2}}
pipeline:
  - {id: one, operation: echo, model: plain, parameters: {prefix: "$1 "},
     ${labels_of_one:-}
     input: $scratch/data/in.txt, output: $scratch/data/between.txt}
  - {id: two, operation: echo, model: plain, parameters: {prefix: "$2 "},
     restart: {policy: never},
     input: {from: one}, output: ${3:-$scratch/data/out.txt}}
EOF
}

run_chain() {
  chain "$@" > "$scratch/chain.yaml"
  to head run "$scratch/chain.yaml" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
}

# apply_chain CODE FIRST SECOND [OUTPUT]: what it says is in $scratch/out.
apply_chain() {
  chain "${@:2}" > "$scratch/chain.yaml"
  to head apply "$scratch/chain.yaml" > "$scratch/out" 2>&1
  [[ $? -eq $1 ]] || fail "apply says: $(cat "$scratch/out")"
}

# line_comes WORD PREFIXES: a line that is given to the chain comes out, once, with
# the words of both steps.
line_comes() {
  echo "$1" >> "$scratch/data/in.txt"
  timeout "$deadline_s" grep -m 1 -x "$2 $1" > "$scratch/matches" \
    < <(exec tail --pid=$$ -n +1 -F "$scratch/data/out.txt" 2> /dev/null) \
    || fail "no '$2 $1': $(tail -n 3 "$scratch/data/out.txt")"
  expect "lines '$2 $1'" "$(grep -cx "$2 $1" "$scratch/data/out.txt")" 1
}

# of_step TASK STEP JQ: what is known of its instance.
of_step() {
  get head "/v1/instances" | jq -r --arg task "$1" --arg step "$2" ".instances[]
    | select(.spec.task == \$task and .spec.step == \$step) | $3"
}

of_task() {
  get head "/v1/tasks/$1" | jq -r ".tasks[0] | $2"
}

test_a_step_that_differs_is_replaced_and_the_other_goes_on() {
  local one two
  start_alone
  run_chain 1 2
  line_comes first "2 1"
  one=$(of_step chain one '"\(.spec.instance) \(.figures.use.pid)"')
  two=$(of_step chain two .spec.instance)
  apply_chain 0 1 b
  has_line 'chain *two *restarts *head *head *parameters.prefix: 2  -> b' \
    < "$scratch/out" || fail "$(cat "$scratch/out")"
  has_line "is changed, revision 2: 1 step of 2" < "$scratch/out" \
    || fail "$(cat "$scratch/out")"
  line_comes second "b 1"
  expect "the one that stays" \
    "$(of_step chain one '"\(.spec.instance) \(.figures.use.pid)"')" "$one"
  [[ $(of_step chain two .spec.instance) != "$two" ]] || fail "it is the old one"
  expect "state" "$(of_task chain '"\(.state) \(.revision // 1)"')" "running 2"
  # The same again does nothing.
  apply_chain 0 1 b
  has_line "is as it is to be" < "$scratch/out" || fail "$(cat "$scratch/out")"
  expect "revision" "$(of_task chain ".revision // 1")" 2
}

test_what_does_not_come_up_puts_back_all_that_was_replaced() {
  start_alone
  run_chain 1 2
  line_comes first "2 1"
  apply_chain 1 a b /proc/no/such/place
  has_line "task 'chain' is as it was before" < "$scratch/out" \
    || fail "$(cat "$scratch/out")"
  line_comes second "2 1"
  expect "state" "$(of_task chain '"\(.state) \(.revision // 1)"')" "running 1"
  to head describe chain | has_line 'Update:.*put back' || fail "$(to head describe chain)"
  # And the next change goes well.
  apply_chain 0 a b
  line_comes third "b a"
}

# begin_change FIRST SECOND: until the second step is replaced and settles.
begin_change() {
  chain "$@" > "$scratch/chain.yaml"
  to head apply --no-wait "$scratch/chain.yaml" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  await head '.event == "step_replaced" and .data.step == "two"' > /dev/null
}

test_a_coordinator_killed_during_a_change_puts_it_back() {
  start_alone
  run_chain 1 2
  line_comes first "2 1"
  settling_s=60 begin_change 1 b
  line_comes second "b 1"
  stop_node head KILL
  start_node head --coordinator --cell line --interface lo --cpu-floor 1
  await head '.event == "instance_restarted" and .data.step == "two"' > /dev/null
  line_comes third "2 1"
  expect "state" "$(of_task chain '"\(.state) \(.revision // 1)"')" "running 1"
  expect "why" "$(of_task chain .update_problem)" \
    "the coordinator ended while the task was updated"
  apply_chain 0 1 b
  line_comes fourth "b 1"
}

test_a_node_killed_during_a_change_runs_what_it_ran() {
  start_alone
  start_node arm --join "$(discovery_of head)" --interface lo --cpu-floor 1 \
    --label place=arm
  await_joined head arm
  labels_of_one="labels: {place: arm},"
  run_chain 1 2
  line_comes first "2 1"
  settling_s=6 begin_change 1 b
  stop_node arm KILL
  await head '.event == "task_update_reverted"' > /dev/null
  start_node arm --join "$(discovery_of head)" --interface lo --cpu-floor 1 \
    --label place=arm
  await head '.event == "instance_restarted" and .data.step == "two"' > /dev/null
  line_comes second "2 1"
  expect "revision" "$(of_task chain ".revision // 1")" 1
  # A member can be asked as well.
  chain 1 b > "$scratch/chain.yaml"
  to arm apply "$scratch/chain.yaml" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  line_comes third "b 1"
  to arm rollback chain > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  line_comes fourth "2 1"
}

test_what_would_be_done_is_shown_and_files_may_hold_many_tasks() {
  start_alone
  mkdir -p "$scratch/data"
  touch "$scratch/data/a.in" "$scratch/data/b.in"
  local name
  for name in a b; do
    cat << EOF
---
kind: task
task: $name
labels: {line: "3"}
pipeline:
  - {id: say, operation: echo, model: plain,
     input: $scratch/data/$name.in, output: $scratch/data/$name.out}
EOF
  done > "$scratch/both.yaml"
  to head apply --dry-run "$scratch/both.yaml" > "$scratch/out" 2>&1
  expect "exit code of what differs" $? 1
  has_line 'b *say *starts *- *head' < "$scratch/out" || fail "$(cat "$scratch/out")"
  expect "tasks" "$(get head /v1/tasks | jq '.tasks | length')" 0
  to head apply - < "$scratch/both.yaml" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  lines_come a one
  lines_come b one
  to head apply --dry-run "$scratch/both.yaml" > "$scratch/out" 2>&1
  expect "exit code of what does not differ" $? 0
  has_line 'nothing differs' < "$scratch/out" || fail "$(cat "$scratch/out")"
  # A mistake in the last one changes nothing of the first.
  sed 's/^task: b/task: a/' "$scratch/both.yaml" > "$scratch/twice.yaml"
  to head apply --dry-run "$scratch/twice.yaml" > "$scratch/out" 2>&1
  expect "exit code of a mistake" $? 2
  has_line "twice.yaml:10:.*'a' is in .* already" < "$scratch/out" \
    || fail "$(cat "$scratch/out")"
  # What has the label and is in no file goes.
  head -n 7 "$scratch/both.yaml" > "$scratch/one.yaml"
  to head apply --prune line=3 "$scratch/one.yaml" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  expect "tasks" "$(get head /v1/tasks | jq -r '[.tasks[].task] | join(" ")')" a
  lines_come a two
}

test_a_task_goes_back_to_what_it_was() {
  start_alone
  run_chain 1 2
  apply_chain 0 1 b
  apply_chain 0 a b
  to head tasks chain --revisions > "$scratch/out" || fail "$(cat "$scratch/out")"
  has_line '^ *2 .* two ' < "$scratch/out" || fail "$(cat "$scratch/out")"
  has_line '3 (now) .* one ' < "$scratch/out" || fail "$(cat "$scratch/out")"
  to head rollback chain > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  line_comes first "b 1"
  to head rollback chain --revision 1 > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  line_comes second "2 1"
  expect "revision" "$(of_task chain ".revision // 1")" 5
  to head rollback chain --revision 9 > "$scratch/out" 2>&1
  expect "exit code of one that is not kept" $? 1
  has_line 'revision 9 .* is not kept; 1 to 5 are' < "$scratch/out" \
    || fail "$(cat "$scratch/out")"
}

test_a_running_task_is_replaced_where_that_is_asked_for() {
  start_alone
  run_chain 1 2
  chain a b > "$scratch/chain.yaml"
  to head run "$scratch/chain.yaml" > "$scratch/out" 2>&1
  expect "exit code without --replace" $? 1
  to head run --replace "$scratch/chain.yaml" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  line_comes first "b a"
  # An ended one runs once more with another request.
  chain a c | sed 's/^task: .*/task: short/; s/prefix: "a "/&, follow: false/
    s/prefix: "c "/&, follow: false/; s/out.txt/short.txt/; s/between/middle/' \
    > "$scratch/short.yaml"
  to head run --wait-finished "$scratch/short.yaml" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  to head apply "$scratch/short.yaml" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  has_line 'has ended, and is as it was to be' < "$scratch/out" \
    || fail "$(cat "$scratch/out")"
  sed -i 's/"c "/"d "/' "$scratch/short.yaml"
  to head apply "$scratch/short.yaml" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  await head '.event == "task_finished" and .subject == "short" and .data != null' > /dev/null
  expect "run" "$(of_task short .run)" 2
}

test_frames_of_steps_that_do_not_differ_are_neither_lost_nor_doubled() {
  local camera witness old fresh
  use_skills_of_camera
  start_alone
  make_scenes
  pick_task 2 > "$scratch/pick.json"
  to head run "$scratch/pick.json" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  more_lines "$scratch/seen" 5
  more_lines "$scratch/poses" 5
  camera=$(of_step pick camera .figures.use.pid)
  witness=$(of_step pick witness .figures.use.pid)
  old=$(of_step pick pose .spec.instance)
  pick_task 3 > "$scratch/pick.json"
  to head apply "$scratch/pick.json" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  fresh=$(of_step pick pose .spec.instance)
  more_lines "$scratch/poses" 5
  more_lines "$scratch/seen" 5
  expect "camera's process" "$(of_step pick camera .figures.use.pid)" "$camera"
  expect "witness's process" "$(of_step pick witness .figures.use.pid)" "$witness"
  expect "frames that the witness has dropped" \
    "$(of_step pick witness .figures.dropped)" 0
  # One writer of /pick/poses at a time: the old one has ended before the new one
  # is even started.
  local ended started
  ended=$(await head ".subject == \"$old\" and .data.state == \"stopped\"" \
    | jq .sequence)
  started=$(await head ".subject == \"$fresh\" and .data.state == \"starting\"" \
    | jq .sequence)
  [[ $ended -lt $started ]] || fail "ended at $ended, started at $started"
  # Each frame of the camera is one line of the witness.
  to head stop pick > /dev/null || fail "stop was refused"
  jq -r .stamp "$scratch/seen" | sort -n > "$scratch/stamps"
  expect "doubled frames" "$(uniq -d "$scratch/stamps" | wc -l)" 0
  awk 'NR > 1 && $1 - last > 0.19 { print last, $1 } { last = $1 }' \
    "$scratch/stamps" > "$scratch/gaps"
  expect "gaps between frames of the witness" "$(cat "$scratch/gaps")" ""
}
