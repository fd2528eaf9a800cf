# What was said yesterday is there today: logs of what is gone, and what it costs to
# write them.

. test/system/scenes/worker.sh

start_two() {
  make_worker
  forget_safety
  start_node head --coordinator --cell line --interface lo --label place=head
  server=$(discovery_of head)
  start_node arm --interface lo --join "$server" --label place=arm
  await_joined head arm
}

# run_two TASK: a step on each node; the instance on arm is in $instance.
run_two() {
  work_task "$1" '{"id": "a", "labels": {"place": "arm"}}' \
    '{"id": "b", "labels": {"place": "head"}}' \
    | to head request > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  instance=$(jq -r '.instances[] | select(.step == "a") | .instance' \
    "$scratch/reply.json")
}

# logs NAME ARGUMENTS...: what it prints is in $text, what it notes in $note.
logs() {
  local name=$1
  shift
  text=$(to "$name" logs "$@" 2> "$scratch/note")
  code=$?
  note=$(cat "$scratch/note")
}

test_logs_of_a_stopped_task_are_there() {
  local code text note
  start_two
  run_two t
  logs head t
  expect "the log of a task that runs" "$text" $'a | a works\nb | b works'
  expect "the note" "$note" ""
  to head stop t > /dev/null || fail "it does not end"
  logs head t
  expect "the exit code" "$code" 0
  expect "the log of a stopped task" "$text" $'a | a works\nb | b works'
  has_line "^$instance on node arm: stopped .* ago, exit code 0 (removed)" \
    <<< "$note" || fail "$note"
  logs arm "$instance"
  expect "the log at the node that has it" "$text" "a works"
  logs head "${instance%????}" -t --tail 1
  [[ $text == 20*'a works' ]] || fail "$text"
  logs head --previous
  [[ $(wc -l <<< "$text") == 3 ]] || fail "$text"
  has_line "^$instance .* arm .* stopped (0): removed " <<< "$text" || fail "$text"
  expect "as JSON" "$(to head logs --previous -o json \
    | jq -r '[.logs[].step] | sort | join(",")')" a,b
  logs head nobody
  expect "the exit code for an unknown task" "$code" 1
  logs head
  expect "the exit code without a name" "$code" 2
}

test_kept_logs_outlive_their_node_and_give_way_to_none_of_the_same_name() {
  local code text note
  start_two
  run_two t
  to head stop t > /dev/null
  local before=$instance
  stop_node arm KILL
  stop_node head
  start_node head --coordinator --cell line --interface lo --label place=head
  server=$(discovery_of head)
  # Those of a node that is away are missing, and that is said.
  logs head --previous
  has_line '^without those of arm' <<< "$text" || fail "$text"
  start_node arm --interface lo --join "$server" --label place=arm
  await_joined head arm
  logs head "$before"
  expect "after a restart" "$text" "a works"
  # Of one name the task that runs is meant, the earlier one when it is asked for.
  run_two t
  order crash a
  await head ".event == \"instance_changed\" and .subject == \"$instance\"
    and .data.state == \"running\" and .data.restarts == 1" > /dev/null
  logs head "$instance"
  expect "the log over a new start" "$text" \
    $'a works\na crashes\n[shim: started again]\na works'
  logs head t --previous
  expect "the earlier one" "$text" $'a | a works\nb | b works'
  has_line "^$before on node arm" <<< "$note" || fail "$note"
}

# make_crasher: a program that is ready and fails.
make_crasher() {
  skills=$scratch/skills
  mkdir -p "$skills/crash/bin"
  cat > "$skills/crash/bin/crash" << 'PROGRAM'
#!/usr/bin/env python3
import os, socket, sys
mouth = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
mouth.sendto(b'READY=1', os.environ['NOTIFY_SOCKET'])
print('it crashes', flush=True)
sys.exit(1)
PROGRAM
  chmod +x "$skills/crash/bin/crash"
  jq -n '{operation: "crash", engine: "primitive", entry_point: ["bin/crash"],
    input: {data_types: ["text/plain"], protocols: ["file"]},
    output: {data_types: ["text/plain"], protocols: ["file"]},
    models: [{name: "plain", deployments: [{name: "any",
      base_image: "debian:bookworm-slim", architectures: ["amd64", "arm64"],
      resources: {cpu: 0, memory_mib: 0, disk_mib: 1}}]}]}' \
    > "$skills/crash/skill.json"
}

# written: bytes that the node and all that it has reaped have written to the disk.
written() {
  awk '$1 == "write_bytes:" {print $2}' "/proc/${pid[head]}/io"
}

# await_restarts COUNT: of the one instance; it may be started again meanwhile.
await_restarts() {
  await head ".event == \"instance_changed\" and .data.restarts >= $1" > /dev/null
}

restarts() {
  get head /v1/instances | jq '.instances[0].restarts'
}

test_a_loop_of_restarts_is_counted_and_each_writes_at_most_20_kb() {
  local bytes count kept
  make_crasher
  start_node head --coordinator --cell line --interface lo
  jq -n --arg dir "$scratch" '{type: "task_request", task: "t", pipeline: [
    {id: "a", operation: "crash", model: "plain",
     restart: {policy: "always", delay_s: 0.1, max_delay_s: 0.1},
     input: {protocol: "file", endpoint: ($dir + "/in"), data_type: "text/plain"},
     output: {protocol: "file", endpoint: ($dir + "/out"),
              data_type: "text/plain"}}]}' \
    | to head request > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  await_restarts 5
  bytes=$(written)
  count=$(restarts)
  await_restarts $((count + 40))
  bytes=$(($(written) - bytes))
  count=$(($(restarts) - count))
  # The same ten a minute are kept; of the others the last one is told.
  kept=$(get head '/v1/events?since=0&follow=0' | sed -n 's/^data: //p' \
    | jq -s 'map(select(.event == "instance_changed" and .passing != true)) | length')
  ((kept >= 10 && kept <= 13)) || fail "$kept changes are kept"
  has_line '"passing":true' \
    <<< "$(get head '/v1/events?since=0&follow=0')" || fail "the present is not told"
  ((bytes > 0)) || skip "the file system of $scratch counts no writes"
  echo "$((bytes / count)) bytes a restart, in $count"
  ((bytes / count <= 20000)) \
    || fail "a restart has written $((bytes / count)) bytes"
}
