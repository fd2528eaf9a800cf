# Commands that operators run in containers of real engines: Docker, Podman, and a
# Podman of a user who is not root.

variants=(docker podman rootless)
. test/system/scenes/engine.sh
. test/system/scenes/terminal.sh
. test/system/scenes/commands.sh

before_all() {
  start_engine
}

after_all() {
  stop_engine
}

start_alone() {
  use_engine
  start_node head --coordinator --cell line --interface lo --label place=head
  run_on head t
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  container=$(get head "/v1/instances/$instance" \
    | jq -r '.instances[0].container')
}

test_a_command_runs_in_the_container_of_its_instance() {
  local program
  start_alone
  commands_work
  program=$(engine inspect "$container" --format '{{.State.Pid}}')
  for space in mnt pid; do
    expect "its namespace" "$(say readlink "/proc/self/ns/$space")" \
      "$(readlink "/proc/$program/ns/$space")"
  done
  program=$(pgrep -P "$program" | head -n 1)
  expect "the capabilities" "$(say grep Cap /proc/self/status)" \
    "$(grep Cap "/proc/$program/status")"
  expect "the variables" "$(say env | grep '^ROSCELL_PARAMETERS=')" \
    "$(tr '\0' '\n' < "/proc/$program/environ" \
      | grep '^ROSCELL_PARAMETERS=')"
  commands_are_told
  goes_on t after
}

test_what_goes_through_a_container_comes_back() {
  start_alone
  bytes_come_back
}

test_a_command_in_a_container_has_a_terminal() {
  start_alone
  open_terminal 80 24
  run_here "$ROSCELL exec --to $scratch/head/node.sock $instance -- bash --norc"
  await_screen '^bash.*[$#]$'
  type_keys 'tty -s && stty size' Enter
  await_screen '^24 80$'
  type_keys "bash -c \"trap 'clear; stty size' WINCH; while sleep 0.1; \
do :; done\"" Enter
  tmux resize-window -t it -x 100 -y 30
  await_screen '^30 100$'
  tmux resize-window -t it -x 80 -y 24
  await_screen '^24 80$'
  type_keys C-c "sleep $long_s" Enter
  await_screen "sleep $long_s"
  type_keys C-c 'echo it is $?' Enter
  await_screen '^it is 130$'
  type_keys 'exit 5' Enter
  ended_with 5
}

test_a_command_in_a_container_ends_with_its_client_its_instance_and_its_node() {
  start_alone
  begin_long
  kill -TERM "$client"
  long_ends 143
  begin_long
  kill -KILL "$client"
  long_ends 137
  goes_on t after
  begin_long
  to head stop t > "$scratch/said" || fail "$(cat "$scratch/said")"
  long_ends 137 'the command was ended: the instance has ended'
  run_on head u
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  begin_long
  stop_node head KILL
  long_ends 3 'the command is out of reach'
}
