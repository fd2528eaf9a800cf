# The life of instances and tasks: started again, ended, safe, moved from nodes
# that are lost, drained, with real programs under real shims.

slow=(test_a_lost_step_has_ended_before_it_starts_elsewhere)

. test/system/scenes/worker.sh

start_pair() {
  make_worker
  start_node head --coordinator --cell line --interface lo --label place=head
  server=$(discovery_of head)
  start_node arm --interface lo --join "$server" --label place=arm
  await_joined head arm
}

# in_state STATE [SINCE]: waits until an instance is told to be so.
in_state() {
  await head ".event == \"instance_changed\" and .data.state == \"$1\"
              and .data.node != null" "${2:-0}"
}

test_what_crashes_runs_again_and_its_ends_are_told() {
  local text instance
  start_pair
  work_task t '{"id": "a", "restart": {"delay_s": 3}, "labels": {"place": "arm"}}' \
    | to head request > "$scratch/reply.json"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  order crash a
  in_state backing_off > "$scratch/off.json"
  expect "the reason" "$(jq -r .data.reason "$scratch/off.json")" \
    "it ended with exit code 7"
  expect "the task" "$(get head /v1/tasks/t | jq -r '.tasks[0].state')" degraded
  in_state running "$(jq .sequence "$scratch/off.json")" > /dev/null
  expect "the task" "$(get head /v1/tasks/t | jq -r '.tasks[0].state')" running
  expect "the instance" \
    "$(get arm "/v1/instances/$instance" | jq -r '.instances[0].ends[0].exit_code')" 7
  text=$(to arm instances "$instance")
  has_line 'its last ends' <<< "$text" || fail "$text"
  has_line 'a crashes' <<< "$text" || fail "$text"
  text=$(to head tasks t --history)
  has_line 'backing_off on arm' <<< "$text" || fail "$text"
}

test_an_orphan_starts_again_what_crashes_also_after_its_own_restart() {
  local instance before
  start_pair
  work_task t '{"id": "a", "restart": {"delay_s": 6}, "labels": {"place": "arm"}}' \
    | to head request > "$scratch/reply.json"
  stop_node head KILL
  await arm '.event == "coordinator_lost"' > /dev/null
  order crash a
  await arm '.event == "instance_changed" and .data.state == "backing_off"' \
    > /dev/null
  stop_node arm KILL
  start_node arm --interface lo --join "$server" --label place=arm
  await arm '.event == "instance_changed" and .data.state == "running"' \
    > "$scratch/running.json"
  expect "starts" "$(wc -l < "$scratch/orders/starts")" 2
  expect "restarts" "$(jq .data.restarts "$scratch/running.json")" 1
}

test_a_task_that_has_finished_says_so_and_how() {
  start_pair
  (await head '.event == "task_accepted"' > /dev/null; order done a) &
  local orderer=$!
  work_task t '{"id": "a"}' | to head request --wait-finished \
    > "$scratch/reply.json" 2> "$scratch/said"
  expect "exit code" $? 0
  has_line "task 't' finished after" "$scratch/said" \
    || fail "$(cat "$scratch/said")"
  expect "the state" "$(get head /v1/tasks/t | jq -r '.tasks[0].state')" finished
  wait $orderer
  order crash b
  work_task u '{"id": "b", "restart": {"policy": "never"}}' \
    | to head request --wait-finished > "$scratch/reply.json" 2> "$scratch/said"
  # It may end before it is ready, or after.
  expect "exit code" "$(($? == 7 || $? == 1))" 1
}

test_a_skill_that_is_not_safe_is_waited_for_over_restarts() {
  start_pair
  work_task t '{"id": "a", "parameters": {"careful": true},
                "labels": {"place": "arm"}}' \
    | to head request > "$scratch/reply.json"
  to head stop t > "$scratch/stopped" 2> "$scratch/said" &
  echo $! >> "$scratch/pids"
  local stopping=$!
  await head '.event == "instance_awaited"' > /dev/null
  text=$(to head tasks)
  has_line 't/a waits to be stop-safe' <<< "$text" || fail "$text"
  stop_node arm KILL
  start_node arm --interface lo --join "$server" --label place=arm
  await arm '.event == "instance_adopted"' > /dev/null
  [[ $(get arm /v1/node | jq -r '.instances[0].state') == running ]] \
    || fail "it was ended"
  order safe a
  await arm '.event == "instance_changed" and .data.state == "stopped"' > /dev/null
  kill $stopping 2> /dev/null
  return 0
}

test_force_ends_what_is_not_safe() {
  start_pair
  work_task t '{"id": "a", "parameters": {"careful": true}}' \
    | to head request > /dev/null
  to head stop t --force > "$scratch/said"
  has_line 'task t is gone' "$scratch/said" || fail "$(cat "$scratch/said")"
}

test_a_node_is_drained_and_shuts_down_empty() {
  local step
  start_pair
  work_task t '{"id": "a"}' '{"id": "b"}' | to head request > /dev/null
  to head drain head --until-empty 2> "$scratch/said"
  expect "instances left" "$(get head /v1/node \
    | jq '[.instances[] | select(.state == "running")] | length')" 0
  expect "on arm" "$(get arm /v1/node \
    | jq '[.instances[] | select(.state == "running")] | length')" 2
  to head undrain head 2> /dev/null
  stop_node arm KILL
  start_node arm --interface lo --join "$server" --drain-timeout 30
  await_joined head arm "$(await head '.event == "node_lost"' | jq .sequence)"
  stop_node arm
  # A step that cares for its safety has ended before it starts elsewhere.
  for step in a b; do
    await head ".event == \"instance_moved\" and .data.step == \"$step\"" \
      > /dev/null
  done
  expect "on head" "$(get head /v1/node \
    | jq '[.instances[] | select(.state == "running")] | length')" 2
  expect "what was left" "$(ls "$scratch/arm/instances" | wc -l)" 0
}

# drop_on HOST HOOK FIELD: what comes from, or goes to, the others is lost.
drop_on() {
  ip netns exec "${hosts[$(($1 - 1))]}" nft -f - << RULES || skip "no nftables"
table inet cut {
  chain everything {
    type filter hook $2 priority 0
    $3 "eth0" drop
  }
}
RULES
}

# comes_back_idle NAME: a node that was lost is a member again, and runs nothing.
comes_back_idle() {
  await_joined head "$1" \
    "$(await head ".event == \"node_lost\" and .subject == \"$1\"" \
      | jq .sequence)"
  expect "what $1 runs" "$(get "$1" /v1/node \
    | jq '[.instances[] | select(.state != "stopped")] | length')" 0
}

test_a_lost_step_has_ended_before_it_starts_elsewhere() {
  local n ended started
  bridge_hosts 6
  make_site_token
  make_worker
  forget_safety
  start_on 1 head --coordinator --cell line
  server=$(discovery_of head)
  for n in 2 3 4 5; do
    start_on "$n" "node$n" --join "$server" --label "is$n=yes"
    await_joined head "node$n"
    work_task "t$n" "$(jq -nc --arg n "$n" '{id: "s\($n)",
      labels: {"is\($n)": "yes"},
      on_node_loss: {policy: "move", after_s: 24}}')" \
      | to head request > /dev/null
    watch_end "s$n"
  done
  # All that can take their places.
  start_on 6 spare --join "$server" --label is2=yes --label is3=yes \
    --label is4=yes --label is5=yes
  await_joined head spare
  kill -KILL "${pid[node2]}"
  kill -STOP "${pid[node3]}"
  drop_on 4 input iifname
  drop_on 5 output oifname
  await head '.event == "node_lost" and .subject == "node2"' > /dev/null
  text=$(to head tasks t2)
  has_line "moves unless node 'node2' is back within 24 s" <<< "$text" \
    || fail "$text"
  for n in 2 3 4 5; do
    await head ".event == \"instance_moved\" and .data.task == \"t$n\"" \
      > /dev/null
    ended=$(cat "$scratch/end.s$n")
    [[ -n $ended ]] || fail "s$n is not seen to end"
    started=$(last_start "s$n")
    echo "    s$n ended $(jq -n "$started - $ended") s before it started again"
    expect "s$n ended first" "$(jq -n "$ended < $started")" true
  done
  # Those that can come back end what they have of it.
  kill -CONT "${pid[node3]}"
  ip netns exec "${hosts[3]}" nft delete table inet cut
  ip netns exec "${hosts[4]}" nft delete table inet cut
  for n in 3 4 5; do
    comes_back_idle "node$n"
  done
}

# move_task TASK: a step "s" that may move among the nodes that can.
move_task() {
  work_task "$1" '{"id": "s", "labels": {"can": "yes"},
    "on_node_loss": {"policy": "move", "after_s": 24}}'
}

# One after the other the nodes that have the step are cut off from all others.
test_a_step_whose_new_node_is_lost_too_has_ended_before_it_starts_again() {
  local n ended started
  bridge_hosts 4
  make_site_token
  make_worker
  forget_safety
  start_on 1 head --coordinator --cell line
  server=$(discovery_of head)
  for n in 2 3 4; do
    start_on "$n" "node$n" --join "$server" --label can=yes
    await_joined head "node$n"
    if [[ $n == 2 ]]; then
      move_task t | to head request > /dev/null
    else
      # The place of the step is there, and its next one, no other.
      drop_on $((n - 1)) input iifname
      await head ".event == \"instance_moved\" and .data.task == \"t\"
        and .data.to == \"node$n\"" > /dev/null
      ended=$(cat "$scratch/end.s") started=$(last_start s)
      echo "    it ended $(jq -n "$started - $ended") s before it started on node$n"
      expect "it ended first" "$(jq -n "$ended < $started")" true
    fi
    watch_end s
  done
  expect "starts" "$(wc -l < "$scratch/orders/starts")" 3
  for n in 2 3; do
    ip netns exec "${hosts[$((n - 1))]}" nft delete table inet cut
    comes_back_idle "node$n"
  done
  expect "starts in the end" "$(wc -l < "$scratch/orders/starts")" 3
}

# A task is ended while its node is away, and the coordinator is killed.
test_a_task_is_not_begun_while_one_of_its_name_may_run_on_a_lost_node() {
  local lost
  discovery_port=11811 http_port=8420
  bridge_hosts 3
  make_site_token
  make_worker
  forget_safety
  start_on 1 head --coordinator --cell line
  server=$(discovery_of head)
  start_on 2 node2 --join "$server" --label can=yes
  await_joined head node2
  move_task t > "$scratch/t.json"
  to head request < "$scratch/t.json" > /dev/null
  watch_end s
  start_on 3 node3 --join "$server" --label can=yes
  await_joined head node3
  drop_on 2 input iifname
  lost=$(await head '.event == "node_lost" and .subject == "node2"' | jq .sequence)
  to head stop t > /dev/null
  stop_node head KILL
  start_on 1 head --coordinator --cell line
  await_joined head node3 "$lost"
  to head run "$scratch/t.json" > "$scratch/said" 2>&1 \
    && fail "it was begun: $(cat "$scratch/said")"
  has_line "may still run on 'node2'" "$scratch/said" || fail "$(cat "$scratch/said")"
  expect "starts" "$(wc -l < "$scratch/orders/starts")" 1
  ip netns exec "${hosts[1]}" nft delete table inet cut
  await_joined head node2 "$lost"
  to head run "$scratch/t.json" > "$scratch/said" 2>&1 || fail "$(cat "$scratch/said")"
  expect "it ended first" "$(jq -n "$(cat "$scratch/end.s") < $(last_start s)")" true
  expect "starts in the end" "$(wc -l < "$scratch/orders/starts")" 2
}

# make_heavy: the program takes so many MiB of memory by its description.
make_heavy() {
  local text
  text=$(jq ".models[0].deployments[0].resources.memory_mib = $1" \
    "$skills/work/skill.json")
  echo "$text" > "$skills/work/skill.json"
}

# start_cell_of_arm: only the member `arm` has memory for what is heavy.
start_cell_of_arm() {
  start_head_without_room
  server=$(discovery_of head)
  start_node arm --interface lo --join "$server" --capacity memory_mib=1000
  await_joined head arm
}

start_head_without_room() {
  start_node head --coordinator --cell line --interface lo \
    --capacity memory_mib=100
}

test_what_runs_makes_way_for_a_task_of_higher_priority() {
  local text
  make_worker
  make_heavy 600
  start_cell_of_arm
  work_task low '{"id": "a", "priority": 2}' > "$scratch/low.json"
  work_task high '{"id": "b", "priority": 8}' > "$scratch/high.json"
  to head run "$scratch/low.json" > /dev/null
  watch_end a
  to head run "$scratch/high.json" > /dev/null 2> "$scratch/said"
  has_line "hint: \`--preempt\` shows" "$scratch/said" \
    || fail "$(cat "$scratch/said")"
  to head run "$scratch/high.json" --preempt > /dev/null 2> "$scratch/said"
  expect "exit code" $? 1
  has_line "'low/a' on 'arm' (priority 2)" "$scratch/said" \
    || fail "$(cat "$scratch/said")"
  expect "the task" "$(get head /v1/tasks/low | jq -r '.tasks[0].state')" running
  to head run "$scratch/high.json" --preempt --yes > "$scratch/said" 2>&1 \
    || fail "$(cat "$scratch/said")"
  has_line 'preempted: low/a on arm' "$scratch/said" || fail "$(cat "$scratch/said")"
  expect "it ended first" \
    "$(jq -n "$(cat "$scratch/end.a") < $(last_start b)")" true
  text=$(to head tasks low)
  has_line "it is preempted by task 'high'" <<< "$text" || fail "$text"
  to head stop high > /dev/null
  to head run "$scratch/low.json" > "$scratch/said" || fail "$(cat "$scratch/said")"
  has_line 'runs once more, run 2' "$scratch/said" || fail "$(cat "$scratch/said")"
}

test_what_is_preempted_has_not_finished_though_the_coordinator_is_killed() {
  local said
  make_worker
  make_heavy 600
  start_cell_of_arm
  work_task low '{"id": "a", "priority": 2, "parameters": {"careful": true}}' \
    > "$scratch/low.json"
  work_task high '{"id": "b", "priority": 8}' > "$scratch/high.json"
  to head run "$scratch/low.json" > /dev/null
  to head run "$scratch/high.json" --preempt --yes > "$scratch/said" 2>&1 &
  said=$!
  await head '.event == "instance_awaited" and .data.task == "low"' > /dev/null
  stop_node head KILL
  wait "$said"
  start_head_without_room
  await_joined head arm
  # It is stop-safe only now, and its program ends with 0.
  order safe a
  await head '.event == "instance_restarted" and .data.task == "low"' > /dev/null
  expect "the task" "$(get head /v1/tasks/low | jq -r '.tasks[0].state')" running
  expect "starts" "$(wc -l < "$scratch/orders/starts")" 2
  expect "words of success" "$(to head tasks low --history | grep -c finished)" 0
  expect "the other task" "$(get head /v1/tasks | jq '.tasks | length')" 1
}

test_a_cell_is_brought_nearer_to_its_optimum() {
  local task
  make_worker
  forget_safety
  make_heavy 300
  start_cell_of_arm
  for task in t u; do
    work_task $task '{"id": "a"}' | to head request > /dev/null
  done
  start_node hand --interface lo --join "$server" --capacity memory_mib=1000
  await_joined head hand
  to head rebalance --dry-run > "$scratch/said" || fail "$(cat "$scratch/said")"
  has_line 'no placement is better' "$scratch/said" || fail "$(cat "$scratch/said")"
  expect "moves" "$(to head rebalance --dry-run -o json | jq '.moves | length')" 1
  expect "on hand" "$(get hand /v1/node | jq '.instances | length')" 0
  to head rebalance > "$scratch/said" 2>&1 || fail "$(cat "$scratch/said")"
  has_line 'all moves are made' "$scratch/said" || fail "$(cat "$scratch/said")"
  expect "on hand" "$(get hand /v1/node \
    | jq '[.instances[] | select(.state == "running")] | length')" 1
  to head rebalance --dry-run > "$scratch/said"
  has_line 'no move is worth it' "$scratch/said" || fail "$(cat "$scratch/said")"
}
