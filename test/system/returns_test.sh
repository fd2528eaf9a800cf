# Work that returns: what a host has interrupted goes on, what has ended has ended, a
# request says how it finds its task, and a job that has ended runs once more when it is
# asked for again.

. test/system/scenes/worker.sh

server=:0

# start_line: two nodes; the steps of `work` may be found moving.
start_line() {
  make_worker
  forget_safety
  start_head
  server=$(discovery_of head)
  start_arm
  await_joined head arm
}

# start_head: where it has been before, its members find it again.
start_head() {
  local discovery_port=${server##*:}
  start_node head --coordinator --cell line --interface lo --label place=head
}

# start_arm [NAME]: in a boot with the id in $scratch/arm.boot, if there is one.
start_arm() {
  if [[ -f $scratch/arm.boot ]]; then
    inside=(unshare -m bash -c
      'mount --bind "$0" /proc/sys/kernel/random/boot_id && exec "$@"'
      "$scratch/arm.boot")
  fi
  start_node "${1:-arm}" --interface lo --join "$server" --label place=arm
  inside=()
}

# programs_of NAME: shims and programs on that node.
programs_of() {
  readlink "$scratch/$1"/instances/*/pid | cut -d' ' -f 1,3
}

# shut_down NAME: as systemd does it: the node ends first, which leaves what it runs,
# then all else is told to.
shut_down() {
  local programs number
  mapfile -t programs < <(programs_of "$1" | tr ' ' '\n')
  stop_node "$1"
  kill -TERM "${programs[@]}" 2> /dev/null || true
  for number in "${programs[@]}"; do
    timeout "$deadline_s" tail --pid="$number" -f /dev/null \
      || fail "process $number did not end"
  done
}

# cut_power NAME: all of it ends at once, and the next boot has another id.
cut_power() {
  [[ $(id -u) -eq 0 ]] || skip "another boot id needs root"
  local programs
  mapfile -t programs < <(programs_of "$1" | tr ' ' '\n')
  kill -KILL "${pid[$1]}" "${programs[@]}"
  timeout "$deadline_s" tail --pid="${pid[$1]}" -f /dev/null
  cat /proc/sys/kernel/random/uuid > "$scratch/$1.boot"
}

starts_of() {
  grep -c " $1 " "$scratch/orders/starts" || true
}

instance_of() {
  get head "/v1/tasks/$1" | jq -r --arg step "$2" \
    '.tasks[0].instances[] | select(.spec.step == $step) | .spec.instance'
}

task_state() {
  get head "/v1/tasks/$1" | jq -r '.tasks[0].state'
}

# step_runs STEP [SINCE]: until the coordinator hears that.
step_runs() {
  await head ".event == \"instance_changed\" and .data.state == \"running\"
    and .data.step == \"$1\" and .data.node != null" "${2:-0}"
}

test_an_orderly_shutdown_is_no_end_of_work() {
  local text since
  start_line
  work_task t '{"id": "a", "labels": {"place": "arm"}}' \
    '{"id": "b", "labels": {"place": "arm"}, "restart": {"policy": "never"}}' \
    '{"id": "c", "labels": {"place": "arm"}}' | to head request > "$scratch/reply"
  order done c
  await head '.event == "instance_changed" and .data.state == "stopped"' > /dev/null
  shut_down arm
  await head '.event == "node_left"' > "$scratch/left.json"
  expect "the task" "$(task_state t)" degraded
  since=$(jq .sequence "$scratch/left.json")
  start_arm
  step_runs a "$since" > /dev/null
  expect "starts of what is to go on" "$(starts_of a)" 2
  expect "starts of what runs once" "$(starts_of b)" 1
  expect "starts of what had ended" "$(starts_of c)" 1
  expect "the task" "$(task_state t)" degraded
  text=$(to head tasks t)
  has_line "roscell restart $(instance_of t b)" <<< "$text" || fail "$text"
  await arm '.event == "instance_interrupted" and .data.step == "a"' > /dev/null
  to head restart "$(instance_of t b)" > "$scratch/restart" 2>&1 \
    || fail "$(cat "$scratch/restart")"
  expect "starts of what runs once" "$(starts_of b)" 2
  expect "the task" "$(task_state t)" running
}

test_after_a_power_cut_a_step_starts_alone_where_it_may() {
  start_line
  work_task t '{"id": "a", "labels": {"place": "arm"}, "on_boot": "start"}' \
    '{"id": "b", "labels": {"place": "arm"}}' | to head request > "$scratch/reply"
  stop_node head KILL
  cut_power arm
  start_arm
  await arm '.event == "instance_changed" and .data.state == "running"
    and .data.step == "a"' > /dev/null
  expect "starts of what waits for its cell" "$(starts_of b)" 1
  start_head
  step_runs b > /dev/null
  expect "starts of what starts alone" "$(starts_of a)" 2
  expect "starts of what waits for its cell" "$(starts_of b)" 2
  expect "the task" "$(task_state t)" running
}

test_two_hosts_with_one_boot_id_do_not_mind() {
  [[ $(id -u) -eq 0 ]] || skip "another boot id needs root"
  cat /proc/sys/kernel/random/uuid > "$scratch/arm.boot"
  start_line
  work_task t '{"id": "a", "labels": {"place": "arm"}}' \
    | to head request > "$scratch/reply"
  cut_power arm
  # That of the coordinator's host, as a copy of a virtual machine may have it.
  cat /proc/sys/kernel/random/boot_id > "$scratch/arm.boot"
  await head '.event == "node_lost"' > "$scratch/lost.json"
  start_arm
  step_runs a "$(jq .sequence "$scratch/lost.json")" > /dev/null
  expect "starts" "$(starts_of a)" 2
  await arm '.event == "instance_interrupted" and .data.step == "a"' > /dev/null
}

test_what_was_stopped_while_its_host_was_off_does_not_come_back() {
  start_line
  work_task t '{"id": "a", "labels": {"place": "arm"}}' \
    | to head request > "$scratch/reply"
  cut_power arm
  await head '.event == "node_lost"' > "$scratch/lost.json"
  to head stop t > /dev/null
  start_arm
  await_joined head arm "$(jq .sequence "$scratch/lost.json")"
  await arm '.event == "instance_changed" and .data.state == "stopped"' > /dev/null
  expect "starts" "$(starts_of a)" 1
}

test_a_job_runs_once_under_one_id_and_again_under_a_new_one() {
  start_line
  order done a
  work_task t '{"id": "a", "labels": {"place": "arm"}}' > "$scratch/job.json"
  for run in 1 2; do
    to head run --wait-finished "$scratch/job.json" > "$scratch/run.$run" \
      2> "$scratch/said" || fail "run $run: $(cat "$scratch/said")"
    expect "starts" "$(starts_of a)" "$run"
  done
  has_line 'runs once more, run 2' "$scratch/run.2" || fail "$(cat "$scratch/run.2")"
  jq '.request_id = "of today"' "$scratch/job.json" > "$scratch/bad.json"
  to head run "$scratch/bad.json" > "$scratch/out" 2>&1
  expect "exit code of an id with a blank" $? 1
  jq '.request_id = "today"' "$scratch/job.json" > "$scratch/today.json"
  to head run --wait-finished "$scratch/today.json" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  expect "starts" "$(starts_of a)" 3
  stop_node head KILL
  start_head
  await_joined head arm
  to head run --wait-finished "$scratch/today.json" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  expect "starts" "$(starts_of a)" 3
  has_line 'has finished' "$scratch/out" || fail "$(cat "$scratch/out")"
  rm "$scratch/orders/done.a"
  order crash a
  work_task u '{"id": "a", "restart": {"policy": "never"}}' > "$scratch/job.json"
  to head run --wait-finished "$scratch/job.json" > "$scratch/out" 2>&1
  # It may end before it is ready, or after.
  expect "exit code of a job that fails" "$(($? == 7 || $? == 1))" 1
}

test_run_says_how_it_finds_the_task() {
  start_line
  work_task t '{"id": "a", "labels": {"place": "arm"}}' > "$scratch/t.json"
  to head run "$scratch/t.json" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  to head run "$scratch/t.json" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  has_line 'task t runs already' "$scratch/out" || fail "$(cat "$scratch/out")"
  stop_node arm KILL
  await head '.event == "node_lost"' > "$scratch/lost.json"
  to head run --timeout 1 "$scratch/t.json" > "$scratch/out" 2> "$scratch/err"
  expect "exit code" $? 1
  has_line 'task t is degraded' "$scratch/out" || fail "$(cat "$scratch/out")"
  has_line "step 'a' on arm: waits for node 'arm'" "$scratch/err" \
    || fail "$(cat "$scratch/err")"
  to head run "$scratch/t.json" > "$scratch/out" 2>&1 &
  local waiting=$!
  start_arm
  wait "$waiting" || fail "$(cat "$scratch/out")"
  expect "starts" "$(starts_of a)" 1
}

test_a_node_that_is_renamed_keeps_its_steps() {
  start_line
  work_task t '{"id": "a", "labels": {"place": "arm"}}' \
    | to head request > "$scratch/reply"
  stop_node arm
  ln -s arm "$scratch/limb"
  start_arm limb
  await head '.event == "node_renamed"' > "$scratch/renamed.json"
  expect "who it was" "$(jq -r .data.from "$scratch/renamed.json")" arm
  await_joined head limb
  expect "the task" "$(task_state t)" running
  expect "starts" "$(starts_of a)" 1
  expect "where it is" "$(get head /v1/tasks/t \
    | jq -r '.tasks[0].instances[0].node')" limb
  stop_node head KILL
  start_head
  await_joined head limb
  expect "the task" "$(task_state t)" running
  expect "starts" "$(starts_of a)" 1
}
