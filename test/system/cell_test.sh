# One cell of real processes on loopback.

start_cell() {
  start_node head --coordinator --cell line --interface lo --label place=head
  server=$(discovery_of head)
  for name in "$@"; do
    start_node "$name" --interface lo --join "$server" --label "place=$name"
    await_joined head "$name"
  done
}

test_members_join_by_the_address_of_the_discovery_server() {
  start_cell arm belt
  expect "active rows" \
    "$(get head /v1/cell | jq '[.nodes[] | select(.state == "active")] | length')" 3
  expect "the member's own view" \
    "$(get arm /v1/node | jq -r '.state + " " + .cell')" "member line"
}

# docs/measurements.md says what each is for.
test_an_idle_node_has_at_most_12_threads() {
  local most=12 threads _
  start_cell
  # Those that the start needed end within a second or two.
  for _ in {1..10}; do
    threads=$(cat "/proc/${pid[head]}/task/"*/comm)
    (($(wc -l <<< "$threads") > most)) || return 0
    timeout 1 tail -f /dev/null
  done
  fail "too many threads: $(sort <<< "$threads" | uniq -c | tr '\n' ' ')"
}

test_a_task_runs_and_one_request_removes_it() {
  start_cell arm
  echo_task hello arm > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  expect "the node" "$(jq -r '.instances[0].node' "$scratch/reply.json")" arm
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  expect "the task" "$(get head /v1/tasks | jq -r '.tasks[0].state')" running
  # The skill follows its input file, and really writes what it gets.
  mkfifo "$scratch/seen"
  timeout "$deadline_s" tail -n +1 -F "$scratch/data/hello.out" \
    > "$scratch/seen" 2>/dev/null &
  echo "a line" >> "$scratch/data/hello.in"
  read -r -t "$deadline_s" line < "$scratch/seen" || fail "nothing was written"
  expect "what was written" "$line" "a line"
  child=$(readlink "$scratch/arm/instances/$instance/pid" | cut -d' ' -f3)
  echo '{"type":"task_termination","task":"hello"}' \
    | to head request > "$scratch/end.json" || fail "$(cat "$scratch/end.json")"
  expect "what was removed" "$(jq -r '.instances[0]' "$scratch/end.json")" \
    "$instance"
  [[ ! -d /proc/$child ]] || fail "the skill's process is still there"
  [[ ! -e $scratch/arm/instances/$instance ]] || fail "its folder is still there"
  expect "tasks" "$(get head /v1/tasks | jq '.tasks | length')" 0
  expect "instances" "$(get head /v1/instances | jq '.instances | length')" 0
}

test_the_same_task_again_runs_already_and_another_body_is_refused() {
  start_cell
  echo_task twice > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/first.json"
  to head request "$scratch/task.json" > "$scratch/second.json"
  expect "how it is found" "$(jq -r .found "$scratch/second.json")" running
  expect "the reply but for that" "$(jq -S 'del(.found)' "$scratch/second.json")" \
    "$(jq -S . "$scratch/first.json")"
  jq '.pipeline[0].parameters = {"prefix": "x"}' "$scratch/task.json" \
    | to head request > "$scratch/third.json"
  expect "exit code" $? 1
  expect "code" "$(jq -r .error.code "$scratch/third.json")" task_exists
}

test_a_killed_member_is_noticed_by_its_connection() {
  start_cell arm
  stop_node arm KILL
  await head '.event == "node_lost" and .subject == "arm"' > "$scratch/lost.json"
  expect "the reason" "$(jq -r .data.reason "$scratch/lost.json" \
    | grep -c 'no heartbeat')" 0
  expect "the row" "$(row_state head arm)" lost
}

test_a_stopped_member_is_lost_within_its_lease_and_comes_back_as_the_same() {
  start_cell arm
  uuid=$(get head /v1/cell | jq -r '.nodes[] | select(.identity.name == "arm") | .identity.uuid')
  kill -STOP "${pid[arm]}"
  await head '.event == "node_lost" and .subject == "arm"' > "$scratch/lost.json"
  grep -q "no heartbeat" "$scratch/lost.json" || fail "the reason says nothing of heartbeats"
  kill -CONT "${pid[arm]}"
  await_joined head arm "$(jq .sequence "$scratch/lost.json")"
  expect "the UUID" "$(get head /v1/cell \
    | jq -r '.nodes[] | select(.identity.name == "arm") | .identity.uuid')" "$uuid"
}

# asked_in_vain NAME TO COMMAND...: that the command ends with 3 within 15 s, and
# what it says, in NAME.err.
asked_in_vain() {
  local name=$1 begin code=0
  begin=$(date +%s%3N)
  to "${@:2}" > "$scratch/$name.out" 2> "$scratch/$name.err" || code=$?
  echo "$code $(($(date +%s%3N) - begin))" > "$scratch/$name.ended"
}

test_a_stopped_coordinator_costs_a_command_15_s_at_most_and_is_named() {
  start_cell arm
  echo_task late arm > "$scratch/late.json"
  address=$(get head /v1/cell | jq -r .address)
  kill -STOP "${pid[head]}"
  commands=(request plan drain form tasks member)
  asked_in_vain request head request "$scratch/late.json" &
  waits=($!)
  asked_in_vain plan head plan "$scratch/late.json" &
  waits+=($!)
  asked_in_vain drain head drain arm &
  waits+=($!)
  asked_in_vain form head form belt &
  waits+=($!)
  asked_in_vain tasks head tasks &
  waits+=($!)
  asked_in_vain member arm request "$scratch/late.json" &
  waits+=($!)
  ROSCELL_TIMEOUT=600ms asked_in_vain tab head nodes
  wait "${waits[@]}"
  for name in "${commands[@]}"; do
    read -r code took < "$scratch/$name.ended"
    expect "exit code of $name" "$code" 3
    [[ $took -le 15000 ]] || fail "$name took $took ms"
  done
  for name in request plan drain form tasks; do
    has_line "$scratch/head/node.sock.* is silent" < "$scratch/$name.err" \
      || fail "$name says: $(cat "$scratch/$name.err")"
  done
  jq -r .error.message "$scratch/member.out" \
    | has_line "coordinator of cell 'line' at $address" \
    || fail "the member says: $(cat "$scratch/member.out")"
  read -r _ took < "$scratch/tab.ended"
  [[ $took -le 3000 ]] || fail "Tab took $took ms"
}

test_an_instance_survives_a_killed_node_and_is_adopted() {
  start_cell arm
  echo_task steady arm | to head request > "$scratch/reply.json"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  child=$(readlink "$scratch/arm/instances/$instance/pid" | cut -d' ' -f3)
  stop_node arm KILL
  await head '.event == "node_lost"' > "$scratch/lost.json"
  [[ -d /proc/$child ]] || fail "the skill died with its node"
  start_node arm --interface lo --join "$server" --label place=arm
  await_joined head arm "$(jq .sequence "$scratch/lost.json")"
  expect "the process" \
    "$(readlink "$scratch/arm/instances/$instance/pid" | cut -d' ' -f3)" "$child"
  expect "the instance" "$(get arm /v1/instances/"$instance" \
    | jq -r '.instances[0].state')" running
  expect "the task" "$(get head /v1/tasks | jq -r '.tasks[0].state')" running
}

test_a_restarted_coordinator_keeps_its_tasks_and_restarts_no_instance() {
  start_cell arm
  echo_task lasting arm | to head request > "$scratch/reply.json"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  child=$(readlink "$scratch/arm/instances/$instance/pid" | cut -d' ' -f3)
  discovery_port=${server##*:}
  stop_node head KILL
  await arm '.event == "coordinator_lost"' > /dev/null
  start_node head --coordinator --cell line --interface lo --label place=head
  await_joined head arm
  expect "the process" \
    "$(readlink "$scratch/arm/instances/$instance/pid" | cut -d' ' -f3)" "$child"
  expect "the task" "$(get head /v1/tasks | jq -r '.tasks[0].task')" lasting
}

test_a_task_terminated_while_its_node_is_away_ends_when_the_node_returns() {
  start_cell arm
  echo_task gone arm | to head request > "$scratch/reply.json"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  child=$(readlink "$scratch/arm/instances/$instance/pid" | cut -d' ' -f3)
  stop_node arm KILL
  await head '.event == "node_lost"' > "$scratch/lost.json"
  echo '{"type":"task_termination","task":"gone"}' | to head request \
    > "$scratch/end.json" || fail "$(cat "$scratch/end.json")"
  expect "who is away" "$(jq -r '.pending_nodes[0]' "$scratch/end.json")" arm
  start_node arm --interface lo --join "$server" --label place=arm
  await_joined head arm "$(jq .sequence "$scratch/lost.json")"
  timeout "$deadline_s" tail --pid="$child" -f /dev/null \
    || fail "the instance of the ended task runs on"
}

test_logs_are_read_through_the_coordinator() {
  start_cell arm
  echo_task chatty arm | to head request > "$scratch/reply.json"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  to head logs "$instance" > "$scratch/log.txt" || fail "$(cat "$scratch/log.txt")"
}

test_a_task_is_drawn_and_described() {
  start_cell arm
  echo_task told arm > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  to head graph told | has_line "on arm, running" || fail "no step is drawn"
  to head graph told -o dot | has_line "^digraph" || fail "it is no graph"
  to head describe told-say > "$scratch/about" || fail "it is not described"
  grep -q "^Node: *arm$" "$scratch/about" || fail "$(cat "$scratch/about")"
  to head describe node arms 2> "$scratch/why" \
    && fail "an unknown node is described"
  grep -q "did you mean 'arm'" "$scratch/why" || fail "$(cat "$scratch/why")"
  expect "a chosen column" \
    "$(to head instances --no-headers --columns NODE,STATE)" "arm  running"
  to head instances --columns PORT 2> "$scratch/why"
  expect "exit code of an unknown column" $? 2
  to head logs told > "$scratch/log.txt" || fail "the task has no log"
  to head logs tolt 2> "$scratch/why" && fail "an unknown task has a log"
  grep -q "did you mean 'told'" "$scratch/why" || fail "$(cat "$scratch/why")"
}

test_the_last_events_are_shown_without_waiting_for_more() {
  start_cell arm
  expect "the last ones" "$(timeout 10 "$ROSCELL" events -n 1000 --no-follow \
    -o jsonl --to "$scratch/head/node.sock" | jq -r .event | grep -c node_joined)" 1
  expect "the last one" "$(timeout 10 "$ROSCELL" events -n 1 --no-follow \
    -o jsonl --to "$scratch/head/node.sock" | wc -l)" 1
}

test_a_node_leaves_in_order_on_sigterm() {
  start_cell arm
  stop_node arm TERM
  await head '.event == "node_left" and .subject == "arm"' > /dev/null
  expect "rows" "$(get head /v1/cell | jq '.nodes | length')" 1
}

test_a_node_goes_on_when_its_terminal_ends() {
  start_cell arm
  kill -HUP "${pid[head]}" "${pid[arm]}"
  echo_task greet arm | to head request > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  stop_node arm TERM
  await head '.event == "node_left" and .subject == "arm"' > /dev/null
}

test_a_coordinator_that_deploys_ends_within_5_s_of_sigterm() {
  local asked begin took
  # The skill never says that it is ready.
  printf '#!/bin/sh\nexec sleep 1000\n' > "$skills/echo/bin/echo"
  start_node head --coordinator --cell line --interface lo
  { echo_task slow | to head request > "$scratch/reply.json"; } \
    2> "$scratch/reply.err" &
  asked=$!
  await head '.event == "allocation_chosen"' > /dev/null
  begin=$(date +%s%3N)
  stop_node head TERM
  took=$(($(date +%s%3N) - begin))
  [[ $took -le 5000 ]] || fail "it took $took ms"
  wait "$asked"
  expect "what the client is told" \
    "$(jq -r .error.code "$scratch/reply.json")" unreachable
}

test_a_member_with_a_full_disk_comes_back_and_does_what_it_is_told() {
  [[ $(id -u) -eq 0 ]] || skip "a file system of its own needs root"
  mkdir "$scratch/arm"
  mount -t tmpfs -o size=16m,mode=0700 none "$scratch/arm" 2> /dev/null \
    || skip "a file system cannot be mounted here"
  trap 'clean_up; umount -l "$scratch/arm"' EXIT
  start_cell arm
  echo_task busy arm | to head request > "$scratch/reply.json"
  stop_node arm KILL
  await head '.event == "node_lost" and .subject == "arm"' > "$scratch/lost.json"
  # The log of a killed node has room in itself; it goes into the file.
  python3 -c 'import sqlite3, sys; sqlite3.connect(sys.argv[1]).execute(
    "PRAGMA wal_checkpoint(TRUNCATE)")' "$scratch/arm/state.db"
  dd if=/dev/zero of="$scratch/arm/fill" bs=4k 2> /dev/null
  start_node arm --interface lo --join "$server" --label place=arm
  await_joined head arm "$(jq .sequence "$scratch/lost.json")"
  await arm '.event == "store_failed"' > /dev/null
  echo '{"type":"task_termination","task":"busy"}' | to head request \
    > "$scratch/end.json"
  expect "what is said" "$(jq -r .type "$scratch/end.json")" task_terminated
  expect "its instances" "$(get arm /v1/instances | jq '.instances | length')" 0
  rm "$scratch/arm/fill"
  await arm '.event == "store_caught_up"' > /dev/null
}
