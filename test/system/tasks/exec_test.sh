# Commands that operators run beside instances that are processes, from any node
# and at a terminal.

. test/system/scenes/terminal.sh
. test/system/scenes/commands.sh

start_alone() {
  use_skills
  start_node head --coordinator --cell line --interface lo --label place=head \
    "$@"
  echo_task t > "$scratch/task.json"
  chmod -R a+rwX "$scratch/data"
  run_on head t
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  program=$(readlink "$scratch/head/instances/$instance/pid" | cut -d' ' -f3)
}

# start_line: a coordinator, the node of the instance, and one more, each on a
# host.
start_line() {
  use_skills
  bridge_hosts 3
  make_site_token
  start_on 1 head --coordinator --cell line --label place=head
  start_on 2 arm --join "$(discovery_of head)" --label place=arm
  start_on 3 belt --join "$(discovery_of head)" --label place=belt
  await_joined head arm
  await_joined head belt
  run_on arm t
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
}

test_a_command_runs_as_its_instance_does() {
  start_alone
  commands_work
  expect "the folder" "$(say pwd)" "$(readlink "/proc/$program/cwd")"
  expect "the cgroup" "$(say cat /proc/self/cgroup)" \
    "$(cat "/proc/$program/cgroup")"
  expect "the capabilities" "$(say grep Cap /proc/self/status)" \
    "$(grep Cap "/proc/$program/status")"
  expect "the variables" \
    "$(say env -0 | tr '\0' '\n' | grep -v '^ROSCELL_EXEC=' | sort)" \
    "$(tr '\0' '\n' < "/proc/$program/environ" | grep -v '^NOTIFY_SOCKET=' \
      | sort)"
  commands_are_told
  goes_on t after
}

test_a_command_is_the_user_that_its_skill_is() {
  chmod 0755 "$scratch"
  start_alone --grant echo=user:nobody
  expect "who it is" "$(say id -u)" 65534
  expect "what it may" "$(say grep CapEff /proc/self/status)" \
    "$(grep CapEff "/proc/$program/status")"
  expect "a stream by its name" \
    "$(say sh -c 'echo here > /dev/stderr' 2>&1)" here
}

test_what_goes_through_a_command_comes_back() {
  start_alone
  bytes_come_back
}

test_an_instance_goes_on_while_commands_run() {
  local n busy
  start_alone
  echo "1" > "$scratch/data/t.in"
  begin_long
  head -c 5000000 /dev/zero > "$scratch/zeros"
  "$ROSCELL" exec --to "$scratch/head/node.sock" "$instance" -- cat \
    < "$scratch/zeros" > "$scratch/zeros.back" &
  busy=$!
  for n in {2..40}; do
    echo "$n" >> "$scratch/data/t.in"
  done
  wait "$busy" || fail "it does not work"
  cmp "$scratch/zeros" "$scratch/zeros.back" || fail "they differ"
  kill "$client"
  long_ends 143
  echo "41" >> "$scratch/data/t.in"
  timeout "$deadline_s" grep -m 1 -x 41 > "$scratch/matches" \
    < <(exec tail --pid=$$ -n +1 -F "$scratch/data/t.out" 2> /dev/null) \
    || fail "$(tail -n 3 "$scratch/data/t.out")"
  expect "what came out" "$(cat "$scratch/data/t.out")" "$(seq 41)"
  goes_on t after
}

test_a_command_at_a_terminal_has_it() {
  start_alone
  a_terminal_serves_a_command
}

test_a_terminal_is_restored_whatever_ends_a_command() {
  local way
  start_alone
  open_terminal 80 24
  for way in TERM:143 HUP:129; do
    run_here "$ROSCELL exec --to $scratch/head/node.sock $instance -- \
sh -c 'echo read\y; cat'"
    await_screen '^ready$'
    signal_program "${way%:*}"
    ended_with "${way#*:}"
  done
  run_here "$ROSCELL exec --to $scratch/head/node.sock $instance -- \
sh -c 'echo read\y; cat'"
  await_screen '^ready$'
  kill -KILL "${pid[head]}"
  ended_with 3
}

test_a_command_ends_with_its_client_its_instance_and_its_node() {
  start_alone
  begin_long
  kill -TERM "$client"
  long_ends 143
  begin_long
  kill -KILL "$client"
  long_ends 137
  expect "why" "$(await head '.event == "exec_ended"
    and (.data.reason // "" | startswith("nobody has asked"))' \
    | jq -r .data.exit_code)" 137
  begin_long
  to head stop t > "$scratch/said" || fail "$(cat "$scratch/said")"
  long_ends 137 'the command was ended: the instance has ended'
  run_on head u
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  begin_long
  stop_node head KILL
  long_ends 3 'the command is out of reach'
}

test_a_command_runs_beside_an_instance_of_any_node() {
  local here
  start_line
  for asked in belt head arm; do
    here=$(echo word | beside "$instance" -- sh -c 'read x; echo "$x here"')
    expect "asked of $asked" "$here" "word here"
  done
  asked=belt
  expect "whom it is from" "$(await arm '.event == "exec_begun"
    and (.data.from | endswith("node belt"))' | jq -r .data.from)" \
    "root at node belt"
  begin_long
  stop_node head KILL
  long_ends 3 'the command is out of reach'
  asked=arm
  goes_on t after
}

test_a_command_is_ended_when_the_network_is_cut() {
  start_line
  asked=belt
  begin_long
  split_bridge 2
  long_ends 3 'the command is out of reach'
}

test_a_command_that_cannot_be_run_says_why() {
  local n
  start_alone
  refused_with() {
    local pattern=$1 code=0
    shift
    beside -n "$@" > "$scratch/out" 2> "$scratch/err" || code=$?
    [[ $code -ne 0 ]] || fail "it runs: $*"
    has_line "$pattern" "$scratch/err" || fail "$(cat "$scratch/err")"
  }
  refused_with "no instance and no task 'nobody' is known" nobody -- ls
  refused_with "PROGRAM" "$instance"
  refused_with "there is no command to run" "$instance" -- ""
  refused_with "may have 131072" "$instance" -- echo \
    "$(printf '%060000d' 1)" "$(printf '%060000d' 1)" "$(printf '%060000d' 1)"
  expect "by its step" "$(beside -n t/say -- echo yes)" yes
  for n in 1 2 3 4 5 6 7 8; do
    "$ROSCELL" exec --to "$scratch/head/node.sock" "$instance" -- cat \
      > "$scratch/out.$n" < <(exec tail --pid=$$ -f /dev/null) &
    echo $! >> "$scratch/pids"
  done
  timeout "$deadline_s" grep -m 9 '"exec_begun"' > "$scratch/matches" \
    < <(exec "$ROSCELL" events --to "$scratch/head/node.sock" --since 0 \
      -o json) || fail "$(cat "$scratch/matches")"
  refused_with "runs 8 commands beside its instances already" \
    "$instance" -- ls
  to head stop t > "$scratch/said" || fail "$(cat "$scratch/said")"
  refused_with "known" "$instance" -- ls
}
