# Instances that are processes are held to what they have asked for, and what they
# really take is told.

. test/system/scenes/limited.sh

# start_limited [OPTION...]: a node that can hold instances to their memory.
start_limited() {
  make_limited
  start_node head --coordinator --cell line --interface lo "$@"
  limits=$(get head /v1/node | jq -r .limits)
  [[ $limits == cgroup* && $limits != *"not memory"* && $limits == *memory* ]] \
    || skip "$limits"
}

# run_limited TASK: its instance is in $instance.
run_limited() {
  limited_task "$1" | to head request > "$scratch/reply.json" \
    || fail "$(cat "$scratch/reply.json")"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
}

# cgroups_of INSTANCE: its folders, as its node has noted them.
cgroups_of() {
  readlink "$scratch/head/instances/$1/cgroup" | tr ':' '\n'
}

await_failed() {
  await head ".event == \"instance_changed\" and .data.state == \"failed\"
    and .subject == \"$instance\"" "${1:-0}"
}

row() {
  get head "/v1/instances/$instance" | jq -r ".instances[0]$1"
}

test_out_of_memory_is_told_as_such() {
  start_limited
  run_limited t
  touch "$scratch/orders/eat"
  expect "the event" "$(await_failed | jq -r .data.reason)" \
    "out of memory: it may use 64 MiB, and took 64 MiB"
  expect "the row" "$(row .out_of_memory)" true
  to head instances > "$scratch/said"
  has_line "out of memory: it may use 64 MiB, and took 64 MiB" "$scratch/said" \
    || fail "$(cat "$scratch/said")"
  to head tasks t > "$scratch/said"
  has_line "out of memory" "$scratch/said" || fail "$(cat "$scratch/said")"
}

test_a_program_that_eats_before_it_is_ready_says_why_its_task_fails() {
  start_limited
  make_hungry
  stop_node head
  start_node head --coordinator --cell line --interface lo
  limited_task t hungry | to head request > "$scratch/reply.json" 2>&1
  expect "exit code" $? 1
  has_line "out of memory: it may use 64 MiB" "$scratch/reply.json" \
    || fail "$(cat "$scratch/reply.json")"
}

test_a_program_that_somebody_kills_was_not_out_of_memory() {
  start_limited
  run_limited t
  kill -KILL "$(readlink "$scratch/head/instances/$instance/pid" | cut -d' ' -f3)"
  expect "the reason" "$(await_failed | jq -r .data.reason)" \
    "it ended by signal 9"
  run_limited u
  kill -KILL "$(readlink "$scratch/head/instances/$instance/pid" | cut -d' ' -f1)"
  expect "the reason" "$(await_failed | jq -r .data.reason)" \
    "its supervision was ended from outside, and its program with it"
}

test_what_an_instance_takes_is_told() {
  local used
  start_limited
  run_limited t
  touch "$scratch/orders/hold"
  await_word held
  used=$(row .figures.use.memory_mib)
  awk -v x="$used" 'BEGIN { exit !(x > 40 && x < 64) }' || fail "it takes $used"
  expect "its limit" "$(row .figures.use.memory_limit_mib)" 64
  to head instances > "$scratch/said"
  has_line -E '[45][0-9](\.[0-9])? MiB of 64 MiB' "$scratch/said" \
    || fail "$(cat "$scratch/said")"
  get head /metrics > "$scratch/metrics"
  has_line -E '^roscell_instance_memory_bytes\{.*\} [4-6][0-9]{7}' \
    "$scratch/metrics" || fail "$(grep memory_bytes "$scratch/metrics")"
  has_line -E '^roscell_instance_cpu_seconds_total\{' "$scratch/metrics" \
    || fail "$(grep cpu_seconds "$scratch/metrics")"
}

test_limits_and_figures_hold_over_a_restart_of_the_node() {
  local folders
  start_limited
  run_limited t
  touch "$scratch/orders/hold"
  await_word held
  folders=$(cgroups_of "$instance")
  stop_node head KILL
  start_node head --coordinator --cell line --interface lo
  expect "its cgroups" "$(cgroups_of "$instance")" "$folders"
  expect "its limit" "$(row .figures.use.memory_limit_mib)" 64
  expect "its state" "$(row .state)" running
  touch "$scratch/orders/eat"
  expect "the reason" "$(await_failed | jq -r .data.reason)" \
    "out of memory: it may use 64 MiB, and took 64 MiB"
  while read -r folder; do
    [[ ! -e $folder ]] || fail "$folder is still there"
  done <<< "$folders"
}

test_what_is_out_of_memory_while_its_node_is_away_is_told_later() {
  start_limited
  run_limited t
  stop_node head KILL
  touch "$scratch/orders/eat"
  timeout "$deadline_s" tail -f /dev/null \
    --pid="$(readlink "$scratch/head/instances/$instance/pid" | cut -d' ' -f1)"
  start_node head --coordinator --cell line --interface lo
  expect "the reason" "$(await_failed | jq -r .data.reason)" \
    "out of memory: it may use 64 MiB, and took 64 MiB while the node was away"
}

test_nothing_of_an_instance_outlives_it() {
  local folder folders
  start_limited
  run_limited t
  folders=$(cgroups_of "$instance")
  touch "$scratch/orders/bomb"
  await_word bombed
  jq -n '{type: "task_termination", task: "t"}' | to head request \
    > "$scratch/end.json" || fail "$(cat "$scratch/end.json")"
  grep -lsz "ROSCELL_INSTANCE=$instance" /proc/[0-9]*/environ > "$scratch/left"
  [[ ! -s $scratch/left ]] || fail "there are: $(wc -l < "$scratch/left")"
  while read -r folder; do
    [[ ! -e $folder ]] || fail "$folder is still there"
  done <<< "$folders"
}

test_cgroups_that_nobody_knows_go_at_the_next_start() {
  local folder known
  start_limited
  run_limited t
  stop_node head KILL
  for folder in $(cgroups_of "$instance"); do
    mkdir "$folder/../forgotten"
  done
  start_node head --coordinator --cell line --interface lo
  # A node is ready before what runs its instances has begun, and that clears
  # up before it starts anything.
  known=$instance
  run_limited u
  for folder in $(cgroups_of "$known"); do
    [[ ! -e $folder/../forgotten ]] || fail "$folder/../forgotten is there"
    [[ -e $folder ]] || fail "$folder is gone"
  done
}

test_without_cgroups_that_is_said_and_who_takes_too_much_is_named() {
  make_limited
  start_node head --coordinator --cell line --interface lo --cgroup none
  expect "the limits" "$(get head /v1/node | jq -r .limits)" \
    "none: it was told so"
  has_line "limits of instances: none" "$scratch/head.log" \
    || fail "$(cat "$scratch/head.log")"
  to head status | has_line -E '^limits +none' || fail "$(to head status)"
  run_limited t
  touch "$scratch/orders/hold"
  await_word held
  awk -v x="$(row .figures.use.memory_mib)" 'BEGIN { exit !(x > 40) }' \
    || fail "it takes $(row .figures.use)"
  expect "its limit" "$(row .figures.use.memory_limit_mib)" null
  to head doctor --only limits > "$scratch/said" 2>&1
  has_line "have no limits" "$scratch/said" || fail "$(cat "$scratch/said")"
}

test_a_folder_that_is_no_cgroup_is_none_and_that_is_said() {
  make_limited
  start_node head --coordinator --cell line --interface lo \
    --cgroup /sys/fs/cgroup/not/there
  get head /v1/node | jq -r .limits | has_line "^none: .*cannot be used" \
    || fail "$(get head /v1/node | jq -r .limits)"
  run_limited t
  timeout "$deadline_s" "$ROSCELL" node --data-dir "$scratch/x" --cgroup relative 2> "$scratch/said"
  expect "exit code" $? 2
}
